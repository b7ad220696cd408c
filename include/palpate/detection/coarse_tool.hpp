// SPDX-License-Identifier: MIT
#pragma once

/// @file  A tool of no more points than a tick has time for.

#include <palpate/detection/tool_points.hpp>

#include <cstddef>

namespace palpate {

namespace detail {
/// At most `most` of the tool's points, even over it, with the areas of all. No equation.
template <Real S>
[[nodiscard]] ToolPoints<S> coarse(const ToolPoints<S>& tool, std::size_t most);
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

#ifndef PALPATE_COMPILED
#include <palpate/detection/setup/coarse_tool_impl.hpp>
#endif
