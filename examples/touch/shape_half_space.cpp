// SPDX-License-Identifier: MIT

/// @file Half-spaces in series: an elastic shape without a set-up.

#include "shape.hpp"

#include <palpate/elasticity/half_space.hpp>

namespace touch {

using namespace palpate;

Shape half_space_shape(const Body& body) {
  const auto fixed = [below = fixed_below(body)](const auto& position) { return position.y() <= below; };
  return shape_of(HalfSpaceDeformation<S>(body.display, fixed, {.nu = rubber.params().nu}));
}

}  // namespace touch
