// SPDX-License-Identifier: MIT
#pragma once

/// @file  Which points of the tool are near each other: the graph behind contact regions (section II).

#include <palpate/detection/tool_points.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

  ProximityGraph(const ToolPoints<S>& tool, S distance);

  /// The points nearer to point i than r, in order, without i.
  [[nodiscard]] std::span<const std::uint32_t> neighbours(std::uint32_t i) const noexcept {
    return {neighbours_.data() + start_[i], neighbours_.data() + start_[i + 1]};
  }

 private:
  std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> start_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/detection/setup/proximity_graph_impl.hpp>
#endif
