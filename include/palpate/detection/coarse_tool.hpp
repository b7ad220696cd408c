// SPDX-License-Identifier: MIT
#pragma once

/// @file  A tool of no more points than a tick has time for.

#include <palpate/detection/tool_points.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace palpate {

namespace detail {
/// At most `most` of the tool's points, even over it, with the areas of all. No equation.
template <Real S>
[[nodiscard]] inline ToolPoints<S> coarse(const ToolPoints<S>& tool, std::size_t most) {
  if (most == 0) fail("CoarseTool", "needs at least one point");
  if (tool.size() <= most) return tool;
  constexpr S step = S(1.25L);
  constexpr int halvings = 6;  // of a step: to 0.4 % of the spacing, about 1 % of the points
  std::vector<std::uint32_t> order(tool.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto fits = [&](S spacing) {
    return detail::apart<S>(tool.points(), tool.areas(), tool.vector_areas(), order, spacing).size() <= most;
  };
  // From points that fill the area on; one point is left when the spacing is the tool's size.
  const S area = std::accumulate(tool.areas().begin(), tool.areas().end(), S(0));
  S large = std::sqrt(area / static_cast<S>(tool.size())), small = large;
  while (!fits(large)) small = large, large *= step;
  for (int i = 0; i < halvings && small < large; ++i) {
    const S middle = (small + large) / S(2);
    (fits(middle) ? large : small) = middle;
  }
  using W = Wide<S>;
  return ToolPoints<S>(detail::thinned<S>(tool.points(), tool.areas(), tool.vector_areas(), order, large,
                                          [&](const auto& visit) {
                                            for (std::size_t i = 0; i < tool.size(); ++i)
                                              visit(Vec3<W>(tool.point(i).template cast<W>()),
                                                    Vec3<W>(tool.vector_areas()[i].template cast<W>()));
                                          }),
                       {.contact_area = tool.contact_area(), .centre_of_mass = tool.centre_of_mass()});
}
}  // namespace detail

/// The tool of a solver whose ticks must keep a budget of time: of `tool` at most `most` points, chosen at
/// set-up; `most` from solver/largest_work.hpp. Topology `Coarse<..>` (contact/topology.hpp) takes it.
///
/// The points that stay are even over the tool, corners and edges first, and carry the areas and vector areas
/// of those that go: sum A_i, sum a_i and sum a_i x_i^T are kept, so what is pressed flat, or is inside
/// altogether, has the force that it had. Where points just touch, the force comes in larger steps: how much
/// is lost is in docs/solver.md. A tool that has no more points stays as it is.
template <Real S>
class CoarseTool : public ToolPoints<S> {
 public:
  /// Reports `most` = 0.
  CoarseTool(const ToolPoints<S>& tool, std::size_t most)
      : ToolPoints<S>(detail::coarse(tool, most)), is_coarse_(tool.size() > most) {}

  /// True where points are gone.
  [[nodiscard]] bool is_coarse() const noexcept { return is_coarse_; }

 private:
  bool is_coarse_;
};

}  // namespace palpate
