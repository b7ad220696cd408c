// SPDX-License-Identifier: MIT

/// @file A hand for programs that know nothing of the stand-in: linked to one, it presses down and slides,
/// and after 4 s of simulated time it pushes the stylus' button.

#include "standin.hpp"

#include <algorithm>

namespace {

/// 1.2 s in the air, so that a gate arms and ramps; then 28 mm down, 20 mm along, up.
void press(double t, standin::Target& target, void*) {
  const auto ramp = [t](double begin, double seconds) { return std::clamp((t - begin) / seconds, 0.0, 1.0); };
  target.position[0] = 20 * ramp(2, 1);
  target.position[1] = -28 * (ramp(1.2, 0.6) - ramp(3.2, 0.6));
  target.buttons = t < 4 ? 0 : 1;
}

const bool scripted = [] {
  standin::script(press);
  return true;
}();

}  // namespace
