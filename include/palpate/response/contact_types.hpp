// SPDX-License-Identifier: MIT
#pragma once

/// @file What a response field is pressed by: a bonded patch or a sphere.

#include <palpate/core/vector.hpp>

#include <cmath>

namespace palpate {

/// A bonded flat patch: every surface point within `radius` of `position` moves by `displacement` and turns
/// about `position` by `rotation`.
template <Real S>
struct ResponseContact {
  Vec3<S> position = Vec3<S>::Zero();      ///< on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitZ();       ///< outward, unit
  S radius = S(0);                         ///< a > 0 [m]
  Vec3<S> displacement = Vec3<S>::Zero();  ///< d; d.normal < 0 presses [m]
  Vec3<S> rotation =
      Vec3<S>::Zero();  ///< rotation vector since it touched [rad]; accurate to 0.3, below a half turn
};

/// True when a contact is finite, of sensible size, with a unit normal, turned by less than a half turn.
template <Real S>
[[nodiscard]] inline bool is_usable(const ResponseContact<S>& c) noexcept {
  constexpr S limit = S(1e6), half_turn2 = S(9.8);  // a little below pi^2
  return is_finite(c.position) && is_finite(c.displacement) && is_finite(c.normal) && is_finite(c.radius) &&
         is_finite(c.rotation) && c.rotation.squaredNorm() < half_turn2 && c.radius > S(1e-9) &&
         c.radius < limit && c.position.cwiseAbs().maxCoeff() < limit &&
         c.displacement.cwiseAbs().maxCoeff() < limit && c.normal.cwiseAbs().maxCoeff() < S(2) &&
         std::abs(c.normal.squaredNorm() - S(1)) < S(1e-3);
}

/// A rigid frictionless sphere, pressed along the normal.
template <Real S>
struct SphereContact {
  Vec3<S> position = Vec3<S>::Zero();  ///< first touch, on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitZ();   ///< outward, unit
  S radius = S(0);                     ///< of the sphere [m], > 0
  S curvature = S(0);                  ///< k1 + k2 of the surface at `position`, > 0 where convex [1/m]
  S depth = S(0);                      ///< [m]; <= 0: no contact
};

}  // namespace palpate
