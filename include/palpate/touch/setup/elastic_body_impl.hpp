// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of elastic_body.hpp: checks, field, cache. Set-up only.

#include <palpate/response/save.hpp>
#include <palpate/response/setup/smooth_surface.hpp>
#include <palpate/touch/elastic_body.hpp>
#include <palpate/version.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

namespace detail {

inline constexpr const char* elastic_body = "ElasticBody";
inline constexpr double longest_body = 10, shortest_body = 1e-3;  // [m]: chosen; a tool in a hand is between
inline constexpr double refined_triangles = 60000;  // chosen: chords below the samples' own error, 0.1 s
inline constexpr double softest_body = 10;          // [Pa]: chosen; the softest gels have 100
inline constexpr double most_unsound = 0.1;  // of the positions: chosen; fingers of 2 % of a body: 0.1 %

/// What a cache was written for: bytes whose checksum it carries.
class CacheKey {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(&value, sizeof value);
  }
  void add(const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return checksum(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

[[noreturn]] inline void fail_fixed(const char* what, const TriangleMesh<double>& mesh) {
  char text[200];
  std::snprintf(text, sizeof text, "%s; the mesh's box is x %.4g to %.4g, y %.4g to %.4g, z %.4g to %.4g m",
                what, mesh.lower().x(), mesh.upper().x(), mesh.lower().y(), mesh.upper().y(),
                mesh.lower().z(), mesh.upper().z());
  fail(elastic_body, text);
}

inline void require_fixed_part(const TriangleMesh<double>& mesh, const FixedPart& fixed) {
  std::size_t inside = 0;
  const std::size_t all = mesh.vertices().size();
  if (const auto* predicate = std::get_if<FixedPredicate>(&fixed)) {
    if (!*predicate) fail(elastic_body, "fixed must be given: below(y), above(y), a predicate or vertices");
    for (const auto& v : mesh.vertices()) inside += (*predicate)(v);
    if (inside == 0) fail_fixed("fixed holds no vertex of the mesh", mesh);
    if (inside == all) fail_fixed("fixed holds all vertices of the mesh", mesh);
  } else if (std::get<1>(fixed).empty()) {
    fail(elastic_body, "fixed must hold at least one whole triangle, the list of vertices is empty");
  }
}

inline void add_fixed_part(CacheKey& key, const TriangleMesh<double>& mesh, const FixedPart& fixed) {
  key.add(fixed.index());
  if (const auto* list = std::get_if<1>(&fixed))
    return key.add(list->data(), list->size() * sizeof(*list->data()));
  // A predicate is known by the vertices inside and by where its boundary crosses the edges.
  const FixedPredicate& predicate = std::get<0>(fixed);
  std::vector<std::uint8_t> inside;
  for (const auto& v : mesh.vertices()) inside.push_back(predicate(v));
  key.add(inside.data(), inside.size());
  for (const auto& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (!inside[a] || inside[b]) continue;
      Vec3<double> in = mesh.vertices()[a], off = mesh.vertices()[b];
      for (int i = 0; i < 50; ++i) {  // to the last digit
        const Vec3<double> middle = (in + off) / 2;
        (predicate(middle) ? in : off) = middle;
      }
      for (const double x : in) key.add(x);
    }
  }
}

inline void require_sound(const ResponseField& field) {
  const std::vector<Vec3<double>> unsound = field.unsound_positions();
  const std::size_t all = field.load_mesh().solved();
  if (!(double(unsound.size()) > most_unsound * double(all))) return;
  char text[230];
  std::snprintf(
      text, sizeof text,
      "the response is no elastic body's at %zu of %zu positions, first near (%.4g, %.4g, %.4g) m; ask "
      "for more vertices: is a part too thin for these, or fixed at few of them?",
      unsound.size(), all, unsound[0].x(), unsound[0].y(), unsound[0].z());
  fail(elastic_body, text);
}

[[nodiscard]] inline std::vector<std::byte> read_bytes(const std::string& name) {
  std::vector<std::byte> bytes;
  std::FILE* const file = std::fopen(name.c_str(), "rb");
  if (file == nullptr) return bytes;
  std::byte block[65536];
  for (std::size_t n; (n = std::fread(block, 1, sizeof block, file)) > 0;)
    bytes.insert(bytes.end(), block, block + n);
  std::fclose(file);
  return bytes;
}

inline void write_cache(const std::string& name, std::uint64_t key, std::span<const std::byte> bytes) {
  std::FILE* const file = std::fopen(name.c_str(), "wb");
  bool written = file != nullptr && std::fwrite(&key, 1, sizeof key, file) == sizeof key &&
                 std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  if (file != nullptr) written = std::fclose(file) == 0 && written;
  if (written) return;
  char text[200];
  std::snprintf(text, sizeof text, "cache %.150s cannot be written", name.c_str());
  fail(elastic_body, text);
}

/// Splits every triangle into m^2 and puts the new vertices on the smooth surface that the mesh stands for
/// (smooth_surface.hpp), which is the field's own; those on creases stay on the edge, so that the two sides
/// meet. m: the most, up to 4, with which there are at most `refined_triangles`.
[[nodiscard]] inline MeshData<double> refined(const TriangleMesh<double>& mesh) {
  const auto triangles = static_cast<double>(mesh.triangles().size());
  const auto m = static_cast<std::uint32_t>(std::clamp(std::sqrt(refined_triangles / triangles), 1.0, 4.0));
  if (m == 1) return mesh.data();
  const SmoothSurface smooth(mesh.data());
  MeshData<double> out{mesh.vertices(), {}};
  const auto point = [&](std::uint32_t t, const std::array<std::uint32_t, 3>& part) {
    TriangleBvh<double>::Nearest at{};
    at.triangle = t;
    at.position = Vec3<double>::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      at.weight[Eigen::Index(c)] = double(part[c]) / m;
      at.position += at.weight[Eigen::Index(c)] * mesh.vertices()[mesh.triangles()[t][c]];
    }
    Vec3<double> position, normal;
    smooth.evaluate(at, position, normal);
    return std::pair(at.position, position);
  };
  // On every edge m - 1 vertices, from its lower-numbered end on.
  std::vector<std::array<std::uint32_t, 3>> first(mesh.triangles().size());
  for (std::size_t e = 0; e < smooth.edges().size(); ++e) {
    const MeshEdge& edge = smooth.edges()[e];
    const std::uint32_t t = edge.triangle[0], c = edge.corner[0], d = (c + 1) % 3;
    const bool turned = mesh.triangles()[t][c] > mesh.triangles()[t][d];
    const auto begin = static_cast<std::uint32_t>(out.vertices.size());
    for (std::uint32_t k = 1; k < m; ++k) {
      std::array<std::uint32_t, 3> part{};
      part[turned ? c : d] = k, part[turned ? d : c] = m - k;
      const auto [flat, curved] = point(t, part);
      out.vertices.push_back(smooth.is_crease(e) ? flat : curved);
    }
    for (std::size_t side = 0; side < 2; ++side) first[edge.triangle[side]][edge.corner[side]] = begin;
  }
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const auto inside = static_cast<std::uint32_t>(out.vertices.size());
    for (std::uint32_t i = 1; i < m; ++i)
      for (std::uint32_t j = 1; i + j < m; ++j) out.vertices.push_back(point(t, {m - i - j, i, j}).second);
    // The vertex i steps from corner 0 towards 1 and j towards 2.
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      const auto& corner = mesh.triangles()[t];
      const std::array<std::uint32_t, 3> part{m - i - j, i, j};
      for (std::size_t c = 0; c < 3; ++c)
        if (part[c] == m) return corner[c];
      for (std::size_t c = 0; c < 3; ++c) {  // on the edge from corner c to d
        const std::size_t d = (c + 1) % 3;
        if (part[(c + 2) % 3] == 0) return first[t][c] + (corner[c] > corner[d] ? part[c] : part[d]) - 1;
      }
      std::uint32_t before = 0;
      for (std::uint32_t k = 1; k < i; ++k) before += m - 1 - k;
      return inside + before + j - 1;
    };
    for (std::uint32_t i = 0; i < m; ++i)
      for (std::uint32_t j = 0; i + j < m; ++j) {
        out.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < m) out.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return inspect(out).valid() ? out : mesh.data();  // a coarse mesh may fold: then as it is
}

}  // namespace detail

PALPATE_COMPILED_INLINE void ElasticBody::build(MeshData<double> data, const Params& params) {
  const auto report = [&params](double done) {
    if (params.progress) params.progress(done);
  };
  report(0);
  const TriangleMesh<double> mesh(std::move(data));
  const double size = (mesh.upper() - mesh.lower()).maxCoeff();
  if (!(size <= detail::longest_body && size >= detail::shortest_body))
    fail(detail::elastic_body, "the mesh must be in metres: its length [m] must be in [0.001, 10]", size);
  if (!(params.E >= detail::softest_body) || !is_finite(params.E))
    fail(detail::elastic_body, "E [Pa] must be >= 10; is it in kPa or MPa?", params.E);
  if (!(params.nu >= 0 && params.nu <= 0.5)) fail(detail::elastic_body, "nu must be in [0, 1/2]", params.nu);
  detail::require_fixed_part(mesh, params.fixed);

  std::uint64_t key = 0;
  std::shared_ptr<const ResponseField> field;
  if (!params.cache.empty()) {
    detail::CacheKey made_for;
    made_for.add(saved_field_version);
    made_for.add(std::array{PALPATE_VERSION_MAJOR, PALPATE_VERSION_MINOR, PALPATE_VERSION_PATCH});
    made_for.add(params.E), made_for.add(params.nu), made_for.add(params.vertices);
    for (const auto& v : mesh.vertices()) made_for.add(v.data(), 3 * sizeof(double));
    made_for.add(mesh.triangles().data(), mesh.triangles().size() * sizeof(mesh.triangles()[0]));
    detail::add_fixed_part(made_for, mesh, params.fixed);
    key = made_for.value();
    const std::vector<std::byte> bytes = detail::read_bytes(params.cache);
    if (bytes.size() > sizeof key && std::memcmp(bytes.data(), &key, sizeof key) == 0)
      field =
          std::make_shared<const ResponseField>(load_response_field(std::span(bytes).subspan(sizeof key)));
  }
  const bool from_cache = field != nullptr;
  if (!from_cache) {
    const ResponseField::Params field_params{.E = params.E,
                                             .nu = params.nu,
                                             .mesh = {.vertices = params.vertices},
                                             .threads = params.threads,
                                             .progress = params.progress};
    field = std::visit(
        [&](const auto& fixed) {
          return std::make_shared<const ResponseField>(mesh.data(), fixed, field_params);
        },
        params.fixed);
    detail::require_sound(*field);
    if (!params.cache.empty()) detail::write_cache(params.cache, key, save_response_field(*field));
  }
  parts_ = std::make_shared<const Parts>(
      Parts{mesh, std::make_shared<const MeshSurface<double>>(TriangleMesh<double>(detail::refined(mesh))),
            std::move(field), params.threads, from_cache});
  report(1);
}

}  // namespace palpate
