// SPDX-License-Identifier: MIT
#pragma once

/// @file  Even points on a mesh of any resolution, each with its area. Set-up only.

#include <palpate/detection/detail/point_grid.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

namespace palpate {

/// Points on a surface and the area that each stands for; #points = #areas.
template <Real S>
struct SurfaceSamples {
  std::vector<Vec3<S>> points;  ///< [m]
  std::vector<S> areas;         ///< sums to the surface's area [m^2]
  std::vector<Vec3<S>>
      vector_areas;  ///< outward normal times area, summed over its part [m^2]; empty: unknown
};

inline constexpr std::size_t max_tool_points = 10000000;

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
      } else if (length2(a, b) > longest * longest) {
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
        if (length2(a, bc) <= length2(ab, c))
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

/// The vector area of each sample: every triangle's is shared among the samples around it that lie near its
/// plane and look its way, by the weights nearest to a kernel's that have the sum 1 and the triangle's middle
/// as their mean. So the sums of a_i and a_i x_i^T stay those of the mesh (closed: 0, and its volume): walls
/// go on cancelling, and a round tool is as thick as its mesh, which neither is when the nearest sample takes
/// all. `normals`: of the samples. No equation: moving least squares of degree one.
template <Real S>
[[nodiscard]] inline std::vector<Vec3<S>> share_vector_areas(const MeshData<S>& fine,
                                                             const std::vector<Vec3<S>>& samples,
                                                             const std::vector<Vec3<S>>& normals, S spacing) {
  using W = Wide<S>;
  const S radius = S(1.25L) * spacing;  // the nearest samples on every side
  PointGrid<S> near(samples, radius), nearest(samples, S(8) * spacing);
  for (const Vec3<S>& p : samples) near.insert(p), nearest.insert(p);
  std::vector<Vec3<W>> sums(samples.size(), Vec3<W>::Zero());
  struct Part {
    std::uint32_t sample;
    W kernel;
    Vec3<W> x;  // from the triangle's middle, in spacings
  };
  std::vector<Part> parts;
  for (const auto& t : fine.triangles) {
    const Vec3<W> p = fine.vertices[t[0]].template cast<W>(), q = fine.vertices[t[1]].template cast<W>(),
                  r = fine.vertices[t[2]].template cast<W>();
    const Vec3<W> area = (q - p).cross(r - p) / 2, n = unit_or<W>(area, Vec3<W>::UnitX());
    const Vec3<W> middle = (p + q + r) / 3;
    parts.clear();
    near.for_each_near(middle.template cast<S>(), [&](std::uint32_t i, S) {
      const Vec3<W> x = (samples[i].template cast<W>() - middle) / static_cast<W>(spacing);
      const W off = n.dot(x), far = x.norm() * static_cast<W>(spacing / radius);
      // Off its plane by 30 degrees, or with a normal more than 75 degrees away: round an edge, or behind.
      if (!(far < W(1)) || !(std::abs(off) <= (std::max)(x.norm() / 2, W(0.1L))) ||
          !(n.dot(normals[i].template cast<W>()) > W(0.25L)))
        return;
      const W kernel = (1 - far * far) * (1 - far * far);
      parts.push_back({i, kernel * kernel, x});
    });
    if (parts.empty()) {
      const std::uint32_t i = nearest.nearest(middle.template cast<S>());
      if (i != nearest.none) parts.push_back({i, W(1), Vec3<W>::Zero()});
    }
    W sum = 0;
    Vec3<W> first = Vec3<W>::Zero();
    Mat3<W> second = Mat3<W>::Zero();
    for (const Part& part : parts) {
      sum += part.kernel;
      first += part.kernel * part.x;
      second += part.kernel * part.x * part.x.transpose();
    }
    const Vec3<W> mean = first / sum;
    // What makes it regular: on a curved face a step off the plane that changes no weight by more than 1; the
    // trace, so that one sample, or several in a line, still take the whole.
    const W off = n.dot(mean);
    Mat3<W> spread = second / sum - mean * mean.transpose();
    spread += off * off / 4 * n * n.transpose();
    spread += (spread.trace() + W(1e-6L)) * W(1e-6L) * Mat3<W>::Identity();
    const Vec3<W> slope = spread.inverse() * mean;
    for (const Part& part : parts)
      sums[part.sample] += part.kernel / sum * (1 - slope.dot(part.x - mean)) * area;
  }
  std::vector<Vec3<S>> shared;
  for (const Vec3<W>& a : sums) shared.push_back(a.template cast<S>());
  return shared;
}

}  // namespace detail

/// Points on the mesh about `spacing` [m] apart: no two nearer than 3/4 of it, neighbours at most about 3/2.
/// Edges longer than that are halved, then vertices that stand too close are dropped and their area goes to
/// the nearest one kept, their vector area to those around. Sharp corners are kept first, then sharp edges,
/// because they touch first; then the mesh's own vertices. Reports a spacing that is not positive or asks for
/// more than 10 million points. No equation.
template <Real S>
[[nodiscard]] inline SurfaceSamples<S> resample(const TriangleMesh<S>& mesh, S spacing) {
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
  // |sum of area vectors| / sum of areas: 1 where flat, 0.71 on a cube's edge, 0.58 at its corner;
  // 0.9 and 0.64 lie between them.
  const auto sharpness = [&](std::uint32_t v) {
    const S flat = vector_areas[v].norm() / areas[v];
    return flat < S(0.64L) ? 0 : flat < S(0.9L) ? 1 : 2;
  };
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t l, std::uint32_t r) { return sharpness(l) < sharpness(r); });
  detail::PointGrid<S> kept(fine.vertices, spacing * S(3) / S(4));
  SurfaceSamples<S> samples;
  std::vector<Vec3<S>> normals;
  for (const std::uint32_t v : order) {
    if (kept.nearest(fine.vertices[v]) != kept.none) continue;
    kept.insert(fine.vertices[v]);
    samples.points.push_back(fine.vertices[v]);
    normals.push_back(unit_or<S>(vector_areas[v], Vec3<S>::Zero()));
  }
  using W = detail::Wide<S>;
  std::vector<W> sums(samples.points.size(), W(0));
  for (std::uint32_t v = 0; v < count; ++v) sums[kept.nearest(fine.vertices[v])] += static_cast<W>(areas[v]);
  for (const W a : sums) samples.areas.push_back(static_cast<S>(a));
  samples.vector_areas = detail::share_vector_areas(fine, samples.points, normals, spacing);
  return samples;
}

}  // namespace palpate
