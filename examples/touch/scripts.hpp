// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the scripted hand does: targets for the tool's origin over time, in object coordinates.

#include <functional>

#include "body.hpp"
#include "tools.hpp"

namespace touch {

struct Script {
  double seconds;
  std::function<V(double t)> target;                 ///< [m]
  std::function<palpate::Mat3<S>(double t)> turn{};  ///< empty: upright
};

/// Leads the tool over the body's upper side, upright, as options.script or options.scene says.
[[nodiscard]] Script make_script(const Options& options, const Body& body, const Tool& tool);

}  // namespace touch
