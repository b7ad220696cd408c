// SPDX-License-Identifier: MIT
#pragma once

/// @file  Which points of the tool are near each other: the graph behind contact regions (section II).

#include <palpate/detection/tool_points.hpp>

namespace palpate {

/// Joins the points of a tool that are strictly nearer than r; r to rounding is not. The tool is rigid, so
/// this is made once.
///
/// | symbol | name       | unit | range                                                       |
/// |--------|------------|------|-------------------------------------------------------------|
/// | r      | `distance` | m    | > 0; at most 64 neighbours for each point on average         |
///
/// The constructor reports a distance out of range. Section II of [luo2005].
template <Real S>
class ProximityGraph {
 public:
  static constexpr std::size_t max_mean_neighbours = 64;

  ProximityGraph(const ToolPoints<S>& tool, S distance) {
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

  /// The points nearer to point i than r, in order, without i.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t i) const noexcept {
    return {neighbours_.data() + start_[i], neighbours_.data() + start_[i + 1]};
  }

 private:
  std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> start_;
};

}  // namespace palpate
