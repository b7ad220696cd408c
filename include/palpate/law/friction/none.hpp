// SPDX-License-Identifier: MIT
#pragma once

/// @file  No friction: the tool slides freely.

#include <palpate/law/friction/concept.hpp>

namespace palpate {

/// Absence of friction. No equation: own choice. Empty; a solver with it keeps no origin p0, no stick or
/// slip, and spends no instruction on them.
template <Real S>
struct Frictionless {
  using Scalar = S;
  static constexpr bool active = false;
};

static_assert(FrictionLaw<Frictionless<float>> && FrictionLaw<Frictionless<double>>);

}  // namespace palpate
