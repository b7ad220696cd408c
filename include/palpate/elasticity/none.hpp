// SPDX-License-Identifier: MIT
#pragma once

/// @file  No deformation: the scene has no picture, or draws the undeformed body.

#include <palpate/elasticity/concept.hpp>

namespace palpate {

/// Absent: no state, no byte, no instruction.
template <Real S>
struct NoDeformation {
  using Scalar = S;
  static constexpr bool active = false;
};

static_assert(DeformationModel<NoDeformation<float>> && DeformationModel<NoDeformation<double>>);

}  // namespace palpate
