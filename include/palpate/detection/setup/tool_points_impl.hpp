// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of tool_points.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/detection/detail/position_order.hpp>
#include <palpate/detection/tool_points.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace palpate {

template <Real S>
ToolPoints<S>::ToolPoints(const SurfaceSamples<S>& samples, const Params& params)
    : ToolPoints(samples.points, samples.areas, params) {
  constexpr const char* where = "ToolPoints";
  if (samples.vector_areas.empty()) return;
  if (samples.vector_areas.size() != size())
    fail(where, "needs one vector area for each point, points minus vector areas must be 0",
         static_cast<double>(size()) - static_cast<double>(samples.vector_areas.size()));
  for (const std::uint32_t i : original_) {
    const Vec3<S>& a = samples.vector_areas[i];
    for (int k = 0; k < 3; ++k) {
      if (!is_finite(a[k]))
        fail_at(where, "vector area [m^2] must be finite", "point", i, static_cast<double>(a[k]));
    }
    vector_areas_.push_back(a);
  }
}

template <Real S>
ToolPoints<S>::ToolPoints(const std::vector<Vec3<S>>& points, const std::vector<S>& areas,
                          const Params& params)
    : contact_area_(params.contact_area), centre_of_mass_(params.centre_of_mass) {
  constexpr const char* where = "ToolPoints";
  require_positive(contact_area_, where, "contact_area [m^2] must be > 0");
  for (int i = 0; i < 3; ++i) require_finite(centre_of_mass_[i], where, "centre_of_mass [m] must be finite");
  if (points.empty()) fail(where, "needs at least one point");
  if (points.size() > max_tool_points)
    fail(where, "takes at most 10 million points", static_cast<double>(points.size()));
  if (areas.size() != points.size())
    fail(where, "needs one area for each point, points minus areas must be 0",
         static_cast<double>(points.size()) - static_cast<double>(areas.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (!is_finite(points[i][k]) || !(std::abs(points[i][k]) <= S(1e6L)))
        fail_at(where, "coordinates [m] must be finite and below 1e6", "point", i,
                static_cast<double>(points[i][k]));
    }
    if (!is_finite(areas[i]) || !(areas[i] > S(0)))
      fail_at(where, "area [m^2] must be > 0", "point", i, static_cast<double>(areas[i]));
  }
  original_.resize(points.size());
  std::iota(original_.begin(), original_.end(), 0u);
  build(points, detail::PositionOrder<S>(points, areas), 0, static_cast<std::uint32_t>(points.size()));
  points_.reserve(points.size());
  areas_.reserve(points.size());
  for (const std::uint32_t i : original_) {
    points_.push_back(points[i]);
    areas_.push_back(areas[i]);
  }
  // Leaves are full but for the last, so leaf k begins at point k leaf_size.
  batches_.resize((points_.size() + leaf_size - 1) / leaf_size);
  for (std::size_t i = 0; i < batches_.size() * leaf_size; ++i) {
    const Vec3<S>& p = points_[(std::min)(i, points_.size() - 1)];
    PointBatch<S>& leaf = batches_[i / leaf_size];
    leaf.x[i % leaf_size] = p.x();
    leaf.y[i % leaf_size] = p.y();
    leaf.z[i % leaf_size] = p.z();
  }
}

template <Real S>
ToolPoints<S>::ToolPoints(const TriangleMesh<S>& mesh, const Params& params)
    : ToolPoints(SurfaceSamples<S>{mesh.vertices(), mesh.vertex_areas(), mesh.vertex_vector_areas()},
                 params) {}

template <Real S>
ToolPoints<S>::ToolPoints(const TriangleMesh<S>& mesh, const Params& params, S spacing)
    : ToolPoints(resample(mesh, spacing), params) {}

template <Real S>
void ToolPoints<S>::build(const std::vector<Vec3<S>>& points, const detail::PositionOrder<S>& order,
                          std::uint32_t begin, std::uint32_t end) {
  const std::size_t index = nodes_.size();
  Vec3<S> low = points[original_[begin]], high = low;
  for (std::uint32_t i = begin; i < end; ++i) {
    low = low.cwiseMin(points[original_[i]]);
    high = high.cwiseMax(points[original_[i]]);
  }
  const Vec3<S> centre = low + (high - low) / S(2);
  S radius = S(0);
  for (std::uint32_t i = begin; i < end; ++i)
    radius = (std::max)(radius, (points[original_[i]] - centre).norm());
  nodes_.push_back({centre, radius * (S(1) + S(8) * std::numeric_limits<S>::epsilon()), begin, end, 0});
  if (end - begin > leaf_size) {
    const std::size_t axis = order.longest_axis(std::span(original_).subspan(begin, end - begin));
    // Whole leaves to the left, so that leaves are full.
    const std::uint32_t middle = begin + ((end - begin + 2 * leaf_size - 1) / (2 * leaf_size)) * leaf_size;
    std::nth_element(original_.begin() + begin, original_.begin() + middle, original_.begin() + end,
                     [&](std::uint32_t l, std::uint32_t r) { return order.less(l, r, axis); });
    build(points, order, begin, middle);
    build(points, order, middle, end);
  } else {
    std::sort(original_.begin() + begin, original_.begin() + end,
              [&](std::uint32_t l, std::uint32_t r) { return order.less(l, r, 0); });
  }
  nodes_[index].skip = static_cast<std::uint32_t>(nodes_.size());
}

}  // namespace palpate
