// SPDX-License-Identifier: MIT
#pragma once

/// @file Definition of coarse_tool.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/detection/coarse_tool.hpp>
#include <palpate/detection/detail/thinned.hpp>

#include <cmath>
#include <numeric>
#include <vector>

namespace palpate::detail {

template <Real S>
[[nodiscard]] ToolPoints<S> coarse(const ToolPoints<S>& tool, std::size_t most) {
  if (most == 0) fail("CoarseTool", "needs at least one point");
  if (tool.size() <= most) return tool;
  constexpr S step = S(1.25L);  // of the spacing, until it fits (chosen)
  constexpr int halvings = 6;   // of a step: to 0.4 % of the spacing, about 1 % of the points
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

}  // namespace palpate::detail
