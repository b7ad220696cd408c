// SPDX-License-Identifier: MIT

#include "mesh_file.hpp"

#include "ply.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <stdexcept>

#if __has_include(<assimp/Importer.hpp>)
#include <assimp/MemoryIOWrapper.h>
#include <assimp/scene.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#define TOUCH_READS_MESHES 1
#else
#define TOUCH_READS_MESHES 0
#endif

namespace touch {

namespace {

using Mesh = palpate::MeshData<double>;
using V = palpate::Vec3<double>;

[[noreturn]] void refuse_file(const MeshFile& file, const std::string& why) {
  throw std::runtime_error(file.name + ": " + why);
}

/// A vector of the file in the scene's axes, and back.
V upright(const V& x, char up) {
  return up == 'y' ? x : up == 'z' ? V(x.x(), x.z(), -x.y()) : V(-x.y(), x.x(), x.z());
}
V as_in_file(const V& x, char up) {
  return up == 'y' ? x : up == 'z' ? V(x.x(), -x.z(), x.y()) : V(x.y(), -x.x(), x.z());
}

/// Vertices that fall into one cell of a grid of the given spacing, 0: of bitwise one place, become the first
/// of them. Two that are close but on both sides of a cell's border are joined through the eight cells that a
/// ball around a vertex can meet.
std::size_t weld(Mesh& mesh, double spacing) {
  using Key = std::array<double, 3>;
  std::map<Key, std::uint32_t> first;
  std::vector<std::uint32_t> kept(mesh.vertices.size());
  std::vector<V> vertices;
  const auto cell = [&](const V& x, int corner) {
    Key key;
    for (int i = 0; i < 3; ++i) {
      const double shift = (corner >> i & 1) != 0 ? 0.5 : -0.5;
      key[static_cast<std::size_t>(i)] =
          spacing > 0 ? std::floor(x[i] / (2 * spacing) + shift * 0.5) : x[i] + 0.0;
    }
    return key;
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const V& x = mesh.vertices[v];
    std::uint32_t found = static_cast<std::uint32_t>(vertices.size());
    for (int corner = 0; corner < (spacing > 0 ? 8 : 1); ++corner) {
      const auto at = first.find(cell(x, corner));
      if (at != first.end() && (spacing == 0 || (vertices[at->second] - x).norm() <= spacing))
        found = (std::min)(found, at->second);
    }
    kept[v] = found;
    if (found < vertices.size()) continue;
    vertices.push_back(x);
    for (int corner = 0; corner < (spacing > 0 ? 8 : 1); ++corner) first.emplace(cell(x, corner), found);
  }
  const std::size_t joined = mesh.vertices.size() - vertices.size();
  for (auto& t : mesh.triangles)
    for (auto& v : t) v = kept[v];
  mesh.vertices = std::move(vertices);
  return joined;
}

std::size_t drop_collapsed(Mesh& mesh) {
  return std::erase_if(mesh.triangles,
                       [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

std::size_t drop_unused(Mesh& mesh) {
  constexpr std::uint32_t unused = 0xffffffff;
  std::vector<std::uint32_t> place(mesh.vertices.size(), unused);
  std::vector<V> vertices;
  for (auto& t : mesh.triangles) {
    for (auto& v : t) {
      if (place[v] == unused) {
        place[v] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(mesh.vertices[v]);
      }
      v = place[v];
    }
  }
  const std::size_t dropped = mesh.vertices.size() - vertices.size();
  mesh.vertices = std::move(vertices);
  return dropped;
}

/// Across every edge of two triangles they run opposite ways, and each part that hangs together has a
/// positive volume. Counts the triangles that were turned.
std::size_t orient(Mesh& mesh) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::vector<std::size_t>> sides;
  const auto edge = [](std::uint32_t a, std::uint32_t b) { return Edge((std::min)(a, b), (std::max)(a, b)); };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      sides[edge(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3])].push_back(i);
  const auto runs = [&](std::size_t i, std::uint32_t a, std::uint32_t b) {
    const auto& t = mesh.triangles[i];
    return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
  };
  std::vector<char> seen(mesh.triangles.size(), 0);
  std::size_t turned = 0;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed]) continue;
    std::vector<std::size_t> part{seed};
    seen[seed] = 1;
    std::size_t turned_here = 0;
    double volume = 0;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const auto t = mesh.triangles[part[next]];
      volume += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        const auto& both = sides[edge(a, b)];
        if (both.size() != 2) continue;
        const std::size_t other = both[0] == part[next] ? both[1] : both[0];
        if (seen[other]) continue;
        seen[other] = 1;
        part.push_back(other);
        if (runs(other, a, b)) std::swap(mesh.triangles[other][1], mesh.triangles[other][2]), ++turned_here;
      }
    }
    if (volume < 0) {
      for (const std::size_t i : part) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
      turned_here = part.size() - turned_here;
    }
    turned += turned_here;
  }
  return turned;
}

void repair(Mesh& mesh) {
  V low = mesh.vertices.front(), high = low;
  for (const V& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  const std::size_t joined = weld(mesh, 1e-6 * (high - low).norm());
  const std::size_t collapsed = drop_collapsed(mesh);
  const std::size_t unused = drop_unused(mesh);
  const std::size_t turned = orient(mesh);
  std::printf(
      "repaired       %zu vertices welded, %zu triangles of less than three corners and %zu unused vertices "
      "dropped, "
      "%zu triangles turned\n",
      joined, collapsed, unused, turned);
}

/// The vertex that stands for the place of a defect; -1: it has none.
std::ptrdiff_t vertex_of(const palpate::MeshReport::Entry& e, palpate::MeshDefect d, const Mesh& mesh) {
  using enum palpate::MeshDefect;
  if (d == empty || d == too_large || d == bad_index || d == bad_vertex) return -1;
  if (d == duplicate_vertex || d == unused_vertex || d == non_manifold_vertex)
    return static_cast<std::ptrdiff_t>(e.first);
  if (d == open_edge || d == non_manifold_edge || d == inconsistent_orientation)
    return static_cast<std::ptrdiff_t>(e.a);
  return mesh.triangles[e.first][0];
}

/// The ending without its dot, lower case.
std::string ending(const std::string& name) {
  std::string last = std::filesystem::path(name).extension().string();
  std::transform(last.begin(), last.end(), last.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return last.empty() ? last : last.substr(1);
}

std::string content_of(const MeshFile& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(file.name, error);
  if (status.type() == fs::file_type::not_found) refuse_file(file, "there is no such file");
  if (error) refuse_file(file, error.message());
  if (fs::is_directory(status)) refuse_file(file, "is a folder");
  if (!fs::is_regular_file(status)) refuse_file(file, "is not a file");
  constexpr std::uintmax_t most = 0x7fffffff;  // Assimp counts in 32 bits
  const std::uintmax_t size = fs::file_size(file.name);
  if (size > most) refuse_file(file, "is larger than 2 GiB");
  std::ifstream in(file.name, std::ios::binary);
  std::string content(static_cast<std::size_t>(size), '\0');
  if (!in.read(content.data(), static_cast<std::streamsize>(size))) refuse_file(file, "cannot be read");
  return content;
}

constexpr std::size_t most_corners = 1000;  // of a polygon: cutting one up takes up to their square

#if TOUCH_READS_MESHES

/// All that Assimp gets to see: the one file, so that no material in it makes it open another.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::string name, std::string_view content) : name_(std::move(name)), content_(content) {}
  [[nodiscard]] bool Exists(const char* name) const override { return name_ == name; }
  [[nodiscard]] char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (!Exists(name)) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()),
                                      content_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  std::string_view content_;
};

/// OBJ and STL. None of them has transformations: the nodes above the meshes do not count.
Polygons parse_with_assimp(const MeshFile& file, std::string_view content) {
  const std::string name = std::filesystem::path(file.name).filename().string();
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(name, content));  // the importer's from here on
  const aiScene* const scene = importer.ReadFile(name, 0);
  if (scene == nullptr) refuse_file(file, importer.GetErrorString());
  Polygons all;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v)
      all.vertices.emplace_back(part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z);
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= part.mNumVertices)
          refuse_file(file, "face " + std::to_string(f) + " names a vertex that does not exist");
        all.corner.push_back(first + face.mIndices[k]);
      }
      all.end.push_back(all.corner.size());
    }
  }
  return all;
}

#else

Polygons parse_with_assimp(const MeshFile& file, std::string_view) {
  refuse_file(file, "cannot be read: this was built without Assimp (Debian: libassimp-dev)");
}

#endif

/// Cuts a polygon into a fan of triangles about the first corner that sees all others, in the plane of its
/// vector area: every convex polygon, and some others. False: no corner does.
bool cut_up(const std::vector<V>& vertices, std::span<const std::uint32_t> polygon, Mesh& mesh) {
  const std::size_t n = polygon.size();
  if (n == 3) return mesh.triangles.push_back({polygon[0], polygon[1], polygon[2]}), true;
  const auto area = [&](std::size_t a, std::size_t b, std::size_t c) -> V {
    const V& o = vertices[polygon[a]];
    return (vertices[polygon[b]] - o).cross(vertices[polygon[c]] - o);
  };
  V normal = V::Zero();
  for (std::size_t k = 1; k + 1 < n; ++k) normal += area(0, k, k + 1);
  for (std::size_t apex = 0; apex < n; ++apex) {
    bool sees_all = true;
    for (std::size_t k = 1; k + 1 < n && sees_all; ++k)
      sees_all = area(apex, (apex + k) % n, (apex + k + 1) % n).dot(normal) > 0;
    if (!sees_all) continue;
    for (std::size_t k = 1; k + 1 < n; ++k)
      mesh.triangles.push_back({polygon[apex], polygon[(apex + k) % n], polygon[(apex + k + 1) % n]});
    return true;
  }
  return false;
}

}  // namespace

bool is_mesh_file(const std::string& name) {
  const std::string last = ending(name);
  return last == "obj" || last == "ply" || last == "stl";
}

Mesh parse_mesh(const MeshFile& file, std::string_view content) {
  if (content.empty()) refuse_file(file, "is empty");
  if (!is_mesh_file(file.name)) refuse_file(file, "must be .obj, .ply or .stl");
  Polygons polygons;
  if (ending(file.name) == "ply") {
    try {
      polygons = parse_ply(content);
    } catch (const std::runtime_error& error) {
      refuse_file(file, error.what());
    }
  } else {
    polygons = parse_with_assimp(file, content);
  }
  Mesh mesh;
  for (const V& x : polygons.vertices) {
    if (!palpate::is_finite(V(file.scale * x))) {
      char text[120];
      std::snprintf(text, sizeof text, "has a vertex that is not finite: (%g, %g, %g), number %zu", x.x(),
                    x.y(), x.z(), mesh.vertices.size());
      refuse_file(file, text);
    }
    mesh.vertices.push_back(upright(file.scale * x, file.up));
  }
  for (std::size_t i = 0, begin = 0; i < polygons.end.size(); begin = polygons.end[i++]) {
    const std::span<const std::uint32_t> polygon(polygons.corner.data() + begin, polygons.end[i] - begin);
    const auto refuse_polygon = [&](const std::string& why) {
      refuse_file(file, "face " + std::to_string(i) + " " + why);
    };
    if (polygon.size() < 3) refuse_polygon("has fewer than three corners");
    if (polygon.size() > most_corners)
      refuse_polygon("has more than " + std::to_string(most_corners) + " corners; cut it into triangles");
    if (!cut_up(mesh.vertices, polygon, mesh))
      refuse_polygon("is not convex, or has no area; cut it into triangles");
  }
  if (mesh.triangles.empty()) refuse_file(file, "has no triangles");
  weld(mesh, 0);
  if (file.repair && !palpate::inspect(mesh).valid()) repair(mesh);  // a hollow body is right as it is
  return mesh;
}

void check_mesh(const MeshFile& file, const Mesh& mesh) {
  const palpate::MeshReport report = palpate::inspect(mesh);
  if (report.valid()) return;
  std::string text = "is not a closed, oriented mesh:";
  for (std::size_t i = 0; i < palpate::mesh_defect_count; ++i) {
    const auto d = static_cast<palpate::MeshDefect>(i);
    if (report[d].count == 0) continue;
    text += std::string("\n  ") + describe(report, d).text;
    if (const std::ptrdiff_t v = vertex_of(report[d], d, mesh); v >= 0) {
      const V x = as_in_file(mesh.vertices[static_cast<std::size_t>(v)], file.up) / file.scale;
      char place[100];
      std::snprintf(place, sizeof place, "; in the file's units near (%.6g, %.6g, %.6g)", x.x(), x.y(),
                    x.z());
      text += place;
    }
  }
  if (!file.repair)
    text +=
        "\n  --repair welds vertices, turns triangles and drops what is unused; holes and the like need a "
        "mesh editor";
  refuse_file(file, text);
}

Mesh read_mesh(const MeshFile& file) {
  Mesh mesh = parse_mesh(file, content_of(file));
  check_mesh(file, mesh);
  return mesh;
}

}  // namespace touch
