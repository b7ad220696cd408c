// SPDX-License-Identifier: MIT
#pragma once

/// @file  Fewer points for a surface, their areas with them. Set-up only.

#include <palpate/core/vector.hpp>
#include <palpate/detection/detail/point_grid.hpp>
#include <palpate/detection/surface_samples.hpp>
#include <palpate/geometry/detail/mesh_parts.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

/// The vector area of each sample: every element's is shared among the samples around it that lie near its
/// plane and look its way, by the weights nearest to a kernel's that have the sum 1 and the element's middle
/// as their mean. So the sums of a_i and a_i x_i^T stay those of the surface (closed: 0, and its volume):
/// walls go on cancelling, and a round tool is as thick as its elements, which neither is when the nearest
/// sample takes all. `normals`: of the samples. `for_each_element(visit)` calls visit(middle [m], vector area
/// [m^2]). No equation: moving least squares of degree one.
template <Real S, class ForEach>
[[nodiscard]] inline std::vector<Vec3<S>> share_vector_areas(const ForEach& for_each_element,
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
    Vec3<W> x;  // from the element's middle, in spacings
  };
  std::vector<Part> parts;
  for_each_element([&](const Vec3<W>& middle, const Vec3<W>& area) {
    const Vec3<W> n = unit_or<W>(area, Vec3<W>::UnitX());
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
      nearest.for_each_nearest(middle.template cast<S>(), [&](std::uint32_t i) {
        parts.push_back({i, W(1), Vec3<W>::Zero()});
      });
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
  });
  std::vector<Vec3<S>> shared;
  for (const Vec3<W>& a : sums) shared.push_back(a.template cast<S>());
  return shared;
}

/// Which of the points stay when no two may be nearer than 3/4 of `spacing` [m]: sharp corners are kept
/// first, then sharp edges, because they touch first, and each kind in the given order.
template <Real S>
[[nodiscard]] inline std::vector<std::uint32_t> apart(std::span<const Vec3<S>> points,
                                                      std::span<const S> areas,
                                                      std::span<const Vec3<S>> vector_areas,
                                                      std::vector<std::uint32_t> order, S spacing) {
  // |sum of area vectors| / sum of areas: 1 where flat, 0.71 on a cube's edge, 0.58 at its corner;
  // 0.9 and 0.64 lie between them.
  const auto sharpness = [&](std::uint32_t v) {
    if (vector_areas.empty()) return 2;
    const S flat = vector_areas[v].norm() / areas[v];
    return flat < S(0.64L) ? 0 : flat < S(0.9L) ? 1 : 2;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t l, std::uint32_t r) { return sharpness(l) < sharpness(r); });
  PointGrid<S> kept(points, spacing * S(3) / S(4));
  std::vector<std::uint32_t> stay;
  for (const std::uint32_t v : order) {
    if (kept.nearest(points[v]) != kept.none) continue;
    kept.insert(points[v]);
    stay.push_back(v);
  }
  return stay;
}

/// Those points, with the areas of all: a point's area goes to the nearest one kept, or in equal parts to
/// those as near; vector areas to those around, as share_vector_areas() has it, if any are given.
template <Real S, class ForEach>
[[nodiscard]] inline SurfaceSamples<S> thinned(std::span<const Vec3<S>> points, std::span<const S> areas,
                                               std::span<const Vec3<S>> vector_areas,
                                               const std::vector<std::uint32_t>& order, S spacing,
                                               const ForEach& for_each_element) {
  using W = Wide<S>;
  PointGrid<S> kept(points, spacing * S(3) / S(4));
  SurfaceSamples<S> samples;
  std::vector<Vec3<S>> normals;
  for (const std::uint32_t v : apart<S>(points, areas, vector_areas, order, spacing)) {
    kept.insert(points[v]);
    samples.points.push_back(points[v]);
    if (!vector_areas.empty()) normals.push_back(unit_or<S>(vector_areas[v], Vec3<S>::Zero()));
  }
  std::vector<W> sums(samples.points.size(), W(0));
  for (std::size_t v = 0; v < points.size(); ++v) {
    W nearest = 0;
    kept.for_each_nearest(points[v], [&](std::uint32_t) { nearest += 1; });
    kept.for_each_nearest(points[v], [&](std::uint32_t i) { sums[i] += static_cast<W>(areas[v]) / nearest; });
  }
  for (const W a : sums) samples.areas.push_back(static_cast<S>(a));
  if (!vector_areas.empty())
    samples.vector_areas = share_vector_areas<S>(for_each_element, samples.points, normals, spacing);
  return samples;
}

}  // namespace palpate::detail
