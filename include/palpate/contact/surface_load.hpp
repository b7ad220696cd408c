// SPDX-License-Identifier: MIT
#pragma once

/// @file What a resolved contact hands to a shape: a load on a part of the body's surface.

#include <palpate/core/vector.hpp>

namespace palpate {

/// A force on a cell of the surface. A plain value in object coordinates, as ContactState is.
template <Real S>
struct SurfaceLoad {
  Vec3<S> position;   ///< on the undeformed surface [m]
  Vec3<S> direction;  ///< of pressing, into the body, unit
  Vec3<S> force;      ///< on the body [N]
  S area;             ///< of the cell [m^2]
  S softening = 0;    ///< by finite strain: near it 1 + softening of the half-space's displacement
};

}  // namespace palpate
