// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of mesh_report.hpp. Set-up only.

#include <palpate/geometry/detail/half_edges.hpp>
#include <palpate/geometry/detail/mesh_parts.hpp>
#include <palpate/geometry/mesh_report.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace palpate {

[[nodiscard]] PALPATE_COMPILED_INLINE MeshMessage describe(const MeshReport& report, MeshDefect d) noexcept {
  const MeshReport::Entry& e = report[d];
  MeshMessage m;
  if (e.count == 0) return m;
  constexpr std::size_t size = sizeof m.text;
  switch (d) {
    case MeshDefect::empty:
      std::snprintf(m.text, size, "has no triangles");
      break;
    case MeshDefect::too_large:
      std::snprintf(m.text, size, "%zu triangles or vertices, at most 1e9", e.first);
      break;
    case MeshDefect::bad_index:
      std::snprintf(m.text, size,
                    "%zu triangles name a vertex that does not exist, first triangle %zu, vertex %zu of %zu",
                    e.count, e.first, e.a, e.b);
      break;
    case MeshDefect::bad_vertex:
      std::snprintf(m.text, size, "%zu vertices are not finite or beyond 1e6 m, first vertex %zu", e.count,
                    e.first);
      break;
    case MeshDefect::repeated_index:
      std::snprintf(m.text, size, "%zu triangles name a vertex twice, first triangle %zu; drop them", e.count,
                    e.first);
      break;
    case MeshDefect::duplicate_vertex:
      std::snprintf(m.text, size,
                    "%zu vertices stand where another does, first vertices %zu and %zu; weld them", e.count,
                    e.a, e.b);
      break;
    case MeshDefect::zero_area:
      std::snprintf(m.text, size, "%zu triangles have no area, first triangle %zu; collapse or flip an edge",
                    e.count, e.first);
      break;
    case MeshDefect::unused_vertex:
      std::snprintf(m.text, size, "%zu vertices belong to no triangle, first vertex %zu; drop them", e.count,
                    e.first);
      break;
    case MeshDefect::open_edge:
      std::snprintf(
          m.text, size,
          "not closed: %zu boundary edges, first between vertices %zu and %zu of triangle %zu; fill the hole",
          e.count, e.a, e.b, e.first);
      break;
    case MeshDefect::non_manifold_edge:
      std::snprintf(m.text, size,
                    "%zu edges have more than two triangles, first between vertices %zu and %zu of triangle "
                    "%zu; split the parts",
                    e.count, e.a, e.b, e.first);
      break;
    case MeshDefect::inconsistent_orientation:
      std::snprintf(m.text, size,
                    "%zu edges join triangles of opposite orientation, first between vertices %zu and %zu of "
                    "triangle %zu; turn "
                    "one",
                    e.count, e.a, e.b, e.first);
      break;
    case MeshDefect::non_manifold_vertex:
      std::snprintf(m.text, size,
                    "%zu vertices join parts that touch there only, first vertex %zu; split the vertex",
                    e.count, e.first);
      break;
    case MeshDefect::inside_out:
      std::snprintf(m.text, size,
                    "%zu closed parts are inside out, overlap another or hold no volume, first with triangle "
                    "%zu; turn its "
                    "triangles",
                    e.count, e.first);
      break;
  }
  return m;
}

namespace detail {

template <Real S>
inline void inspect_vertices(const MeshData<S>& mesh, MeshReport& report) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return mesh.vertices[i].data(); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t l, std::uint32_t r) {
    for (int i = 0; i < 3; ++i)
      if (key(l)[i] != key(r)[i]) return key(l)[i] < key(r)[i];
    return l < r;
  });
  MeshReport::Entry duplicates;
  for (std::size_t i = 0, first = 0; i + 1 < order.size(); ++i) {
    if (!std::equal(key(order[i]), key(order[i]) + 3, key(order[i + 1]))) {
      first = i + 1;
      continue;
    }
    // The lowest-numbered pair is named.
    if (duplicates.count++ == 0 || order[i + 1] < duplicates.b)
      duplicates.a = order[first], duplicates.b = order[i + 1];
  }
  duplicates.first = duplicates.b;
  report.defects[static_cast<std::size_t>(MeshDefect::duplicate_vertex)] = duplicates;

  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = true;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) report.add(MeshDefect::unused_vertex, v);
}

inline void inspect_edges(std::span<const Triangle> triangles, std::span<const HalfEdge> edges,
                          MeshReport& report) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].edge == edges[i].edge) ++end;
    const auto from = [&](const HalfEdge& e) { return triangles[e.id / 3][e.id % 3]; };
    const auto add = [&](MeshDefect d) { report.add(d, edges[i].id / 3, edges[i].low(), edges[i].high()); };
    if (end - i == 1)
      add(MeshDefect::open_edge);
    else if (end - i > 2)
      add(MeshDefect::non_manifold_edge);
    else if (from(edges[i]) == from(edges[i + 1]))
      add(MeshDefect::inconsistent_orientation);
    i = end;
  }
}

/// Each vertex's triangles form one fan. Precondition: every half-edge has a twin of the other direction.
inline void inspect_fans(std::span<const Triangle> triangles, std::span<const std::uint32_t> twin,
                         std::size_t vertices, MeshReport& report) {
  std::vector<std::uint32_t> corners(vertices, 0), start(vertices, no_twin);
  for (std::uint32_t h = 0; h < twin.size(); ++h) {
    const std::uint32_t v = triangles[h / 3][h % 3];
    ++corners[v];
    start[v] = h;
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    std::uint32_t h = start[v], count = 0;
    do {
      h = twin[previous_half_edge(h)];
      ++count;
    } while (h != start[v] && count < corners[v]);
    if (count != corners[v]) report.add(MeshDefect::non_manifold_vertex, v);
  }
}

}  // namespace detail

template <Real S>
[[nodiscard]] MeshReport inspect(const MeshData<S>& mesh) {
  MeshReport report;
  const std::size_t vertices = mesh.vertices.size(), triangles = mesh.triangles.size();
  if (triangles == 0) report.add(MeshDefect::empty, 0);
  if (triangles > 1000000000u || vertices > 1000000000u)
    report.add(MeshDefect::too_large, (std::max)(triangles, vertices));
  if (!report.valid()) return report;
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::uint32_t worst = *std::max_element(mesh.triangles[t].begin(), mesh.triangles[t].end());
    if (worst >= vertices) report.add(MeshDefect::bad_index, t, worst, vertices);
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    if (!is_finite(mesh.vertices[v]) || mesh.vertices[v].cwiseAbs().maxCoeff() > S(1e6L))
      report.add(MeshDefect::bad_vertex, v);
  }
  if (!report.valid()) return report;

  using W = detail::Wide<S>;
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [i, j, k] = mesh.triangles[t];
    if (i == j || j == k || k == i) {
      report.add(MeshDefect::repeated_index, t);
      continue;
    }
    const Vec3<W> a = mesh.vertices[i].template cast<W>(), b = mesh.vertices[j].template cast<W>(),
                  c = mesh.vertices[k].template cast<W>();
    const W size = (std::max)({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    const W longest =
        std::sqrt((std::max)({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    // Twice the area = height x longest edge.
    if (!((b - a).cross(c - a).norm() >
          W(4) * static_cast<W>(std::numeric_limits<S>::epsilon()) * size * longest))
      report.add(MeshDefect::zero_area, t);
  }
  detail::inspect_vertices(mesh, report);
  const std::vector<detail::HalfEdge> edges = detail::sorted_half_edges(mesh.triangles);
  detail::inspect_edges(mesh.triangles, edges, report);
  if (!report.valid()) return report;
  const std::vector<std::uint32_t> twin = detail::twins(edges);
  detail::inspect_fans(mesh.triangles, twin, vertices, report);
  if (!report.valid()) return report;
  for (const std::uint32_t t : detail::wrong_parts(mesh, twin)) report.add(MeshDefect::inside_out, t);
  return report;
}

}  // namespace palpate
