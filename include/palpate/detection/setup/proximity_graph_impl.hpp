// SPDX-License-Identifier: MIT
#pragma once

/// @file Definition of proximity_graph.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/detection/detail/point_grid.hpp>
#include <palpate/detection/detail/proximity_graph.hpp>

#include <algorithm>

namespace palpate {

template <Real S>
ProximityGraph<S>::ProximityGraph(const ToolPoints<S>& tool, S distance) {
  require_positive(distance, "ProximityGraph", "distance r [m] must be > 0");
  detail::PointGrid<S> grid(tool.points(), distance);
  for (const Vec3<S>& p : tool.points()) grid.insert(p);
  start_.reserve(tool.size() + 1);
  start_.push_back(0);
  for (std::uint32_t i = 0; i < tool.size(); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(neighbours_.size());
    grid.for_each_near(tool.point(i), [&](std::uint32_t j, S) {
      if (j != i) neighbours_.push_back(j);
    });
    if (neighbours_.size() > max_mean_neighbours * tool.size()) {
      fail("ProximityGraph",
           "distance r [m] joins more than 64 points to each on average; take a smaller r or points "
           "further apart",
           static_cast<double>(distance));
    }
    std::sort(neighbours_.begin() + first, neighbours_.end());
    start_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
  }
}

}  // namespace palpate
