// SPDX-License-Identifier: MIT

#include "mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#if __has_include(<assimp/Importer.hpp>)
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>
#define TOUCH_READS_MESHES 1
#else
#define TOUCH_READS_MESHES 0
#endif

namespace touch {

namespace {

using Mesh = palpate::MeshData<double>;
using V = palpate::Vec3<double>;

/// Vertices that fall into one cell of a grid of the given spacing, 0: of bitwise one place, become the first of them.
/// Two that are close but on both sides of a cell's border are joined through the eight cells that a ball around a
/// vertex can meet.
std::size_t weld(Mesh& mesh, double spacing) {
  using Key = std::array<double, 3>;
  std::map<Key, std::uint32_t> first;
  std::vector<std::uint32_t> kept(mesh.vertices.size());
  std::vector<V> vertices;
  const auto cell = [&](const V& x, int corner) {
    Key key;
    for (int i = 0; i < 3; ++i) {
      const double shift = (corner >> i & 1) != 0 ? 0.5 : -0.5;
      key[static_cast<std::size_t>(i)] = spacing > 0 ? std::floor(x[i] / (2 * spacing) + shift * 0.5) : x[i] + 0.0;
    }
    return key;
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const V& x = mesh.vertices[v];
    std::uint32_t found = static_cast<std::uint32_t>(vertices.size());
    for (int corner = 0; corner < (spacing > 0 ? 8 : 1); ++corner) {
      const auto at = first.find(cell(x, corner));
      if (at != first.end() && (spacing == 0 || (vertices[at->second] - x).norm() <= spacing)) found = (std::min)(found, at->second);
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

double double_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const V& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
}

std::size_t drop_flat(Mesh& mesh) {
  return std::erase_if(mesh.triangles, [&](const auto& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || !(double_area(mesh, t) > 0);
  });
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

/// Across every edge of two triangles they run opposite ways, and each part that hangs together has a positive volume.
/// Counts the triangles that were turned.
std::size_t orient(Mesh& mesh) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Edge, std::vector<std::size_t>> sides;
  const auto edge = [](std::uint32_t a, std::uint32_t b) { return Edge((std::min)(a, b), (std::max)(a, b)); };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) sides[edge(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3])].push_back(i);
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
  const std::size_t flat = drop_flat(mesh);
  const std::size_t unused = drop_unused(mesh);
  const std::size_t turned = orient(mesh);
  std::printf("repaired       %zu vertices welded, %zu triangles without an area and %zu unused vertices dropped, %zu triangles turned\n",
              joined, flat, unused, turned);
}

}  // namespace

bool is_mesh_file(const std::string& name) {
  for (const char* end : {".obj", ".ply", ".stl"}) {
    if (name.size() < 4) continue;
    std::string last = name.substr(name.size() - 4);
    std::transform(last.begin(), last.end(), last.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (last == end) return true;
  }
  return false;
}

#if TOUCH_READS_MESHES

Mesh read_mesh(const MeshFile& file) {
  Assimp::Importer importer;
  const aiScene* const scene = importer.ReadFile(file.name, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) palpate::fail(file.name.c_str(), importer.GetErrorString());
  Mesh mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const V x = file.scale * V(part.mVertices[v].x, part.mVertices[v].y, part.mVertices[v].z);
      mesh.vertices.push_back(file.up == 'y' ? x : file.up == 'z' ? V(x.x(), x.z(), -x.y()) : V(-x.y(), x.x(), x.z()));
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices == 3) mesh.triangles.push_back({first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
    }
  }
  if (mesh.triangles.empty()) palpate::fail(file.name.c_str(), "has no triangles");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (!palpate::is_finite(mesh.vertices[v])) palpate::fail_at(file.name.c_str(), "must be finite", "vertex", v);
  weld(mesh, 0);
  if (file.repair) repair(mesh);
  return mesh;
}

#else

Mesh read_mesh(const MeshFile& file) {
  palpate::fail(file.name.c_str(), "cannot be read: this was built without Assimp (Debian: libassimp-dev)");
}

#endif

}  // namespace touch
