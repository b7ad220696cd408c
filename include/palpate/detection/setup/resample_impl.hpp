// SPDX-License-Identifier: MIT
#pragma once

/// @file Definition of resample.hpp: edges halved, points dropped. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/detection/detail/thinned.hpp>
#include <palpate/detection/resample.hpp>
#include <palpate/geometry/detail/half_edges.hpp>

#include <numeric>
#include <utility>
#include <vector>

namespace palpate {

namespace detail {

/// Halves every edge above `longest`, and again, keeping the mesh closed; triangles with one, two or three
/// halved edges are cut into two, three or four. Vertices stay, new ones follow in order of refinement.
template <Real S>
[[nodiscard]] inline MeshData<S> refine(MeshData<S> mesh, S longest) {
  const auto length2 = [&](std::uint32_t a, std::uint32_t b) {
    return (mesh.vertices[a] - mesh.vertices[b]).squaredNorm();
  };
  // An edge is halved in each pass, and a cut across a quadrilateral is shorter than the edges it replaces.
  for (int pass = 0; pass < 60; ++pass) {
    const std::vector<HalfEdge> edges = sorted_half_edges(mesh.triangles);
    std::vector<std::uint32_t> middle(edges.size(), no_twin);  // per half-edge
    const std::size_t before = mesh.vertices.size();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::uint32_t a = edges[i].low(), b = edges[i].high();
      if (i > 0 && edges[i].edge == edges[i - 1].edge) {
        middle[edges[i].id] = middle[edges[i - 1].id];
      } else if (length2(a, b) * PointGrid<S>::tie > longest * longest) {
        middle[edges[i].id] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(mesh.vertices[a] + (mesh.vertices[b] - mesh.vertices[a]) / S(2));
      }
    }
    if (mesh.vertices.size() == before) break;
    if (mesh.vertices.size() > max_tool_points)
      fail("ToolPoints", "spacing [m] asks for more than 10 million points",
           static_cast<double>(longest) / 1.5);
    std::vector<Triangle> finer;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      // Turned so that the halved edges come first.
      std::size_t turn = 0;
      const auto half = [&](std::size_t k) { return middle[3 * t + (turn + k) % 3]; };
      const auto corner = [&](std::size_t k) { return mesh.triangles[t][(turn + k) % 3]; };
      while (turn < 3 && !(half(0) != no_twin && (half(2) == no_twin || half(1) != no_twin))) ++turn;
      if (turn == 3) {
        finer.push_back(mesh.triangles[t]);
        continue;
      }
      const std::uint32_t a = corner(0), b = corner(1), c = corner(2), ab = half(0), bc = half(1),
                          ca = half(2);
      if (bc == no_twin) {
        finer.insert(finer.end(), {{a, ab, c}, {ab, b, c}});
      } else if (ca == no_twin) {
        finer.push_back({ab, b, bc});
        if (length2(a, bc) * PointGrid<S>::tie <= length2(ab, c))
          finer.insert(finer.end(), {{a, ab, bc}, {a, bc, c}});
        else
          finer.insert(finer.end(), {{a, ab, c}, {ab, bc, c}});
      } else {
        finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {bc, c, ca}, {ab, bc, ca}});
      }
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace detail

template <Real S>
[[nodiscard]] SurfaceSamples<S> resample(const TriangleMesh<S>& mesh, S spacing) {
  require_positive(spacing, "ToolPoints", "spacing [m] must be > 0");
  if (!(mesh.area() / spacing / spacing <= static_cast<S>(max_tool_points)))
    fail("ToolPoints", "spacing [m] asks for more than 10 million points", static_cast<double>(spacing));
  const MeshData<S> fine = detail::refine(mesh.data(), spacing * S(1.5L));
  const std::size_t count = fine.vertices.size();
  std::vector<S> areas(count, S(0));
  std::vector<Vec3<S>> vector_areas(count, Vec3<S>::Zero());
  for (const auto& t : fine.triangles) {
    const Vec3<S> twice =
        (fine.vertices[t[1]] - fine.vertices[t[0]]).cross(fine.vertices[t[2]] - fine.vertices[t[0]]);
    for (const std::uint32_t v : t) {
      areas[v] += twice.norm() / S(6);
      vector_areas[v] += twice / S(6);
    }
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  return detail::thinned<S>(fine.vertices, areas, vector_areas, order, spacing, [&](const auto& visit) {
    using W = detail::Wide<S>;
    for (const auto& t : fine.triangles) {
      const Vec3<W> p = fine.vertices[t[0]].template cast<W>(), q = fine.vertices[t[1]].template cast<W>(),
                    r = fine.vertices[t[2]].template cast<W>();
      visit(Vec3<W>((p + q + r) / 3), Vec3<W>((q - p).cross(r - p) / 2));
    }
  });
}

}  // namespace palpate
