// SPDX-License-Identifier: MIT
#pragma once

/// @file  What a response field is pressed by: a stuck patch, a sphere; and the constants of second order in depth.

#include <palpate/core/vector.hpp>

#include <cmath>

namespace palpate {

/// A stuck flat patch: every surface point within `radius` of `place` moves by `displacement`.
template <Real S>
struct ResponseContact {
  Vec3<S> place = Vec3<S>::Zero();         ///< on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitZ();       ///< outward, unit
  S radius = S(0);                         ///< a > 0 [m]
  Vec3<S> displacement = Vec3<S>::Zero();  ///< d; d.normal < 0 presses [m]
};

/// True when a contact is finite, of sensible size, with a unit normal.
template <Real S>
[[nodiscard]] inline bool is_usable(const ResponseContact<S>& c) noexcept {
  const S limit = S(1e6);
  return is_finite(c.place) && is_finite(c.displacement) && is_finite(c.normal) && is_finite(c.radius) &&
         c.radius > S(1e-9) && c.radius < limit && c.place.cwiseAbs().maxCoeff() < limit &&
         c.displacement.cwiseAbs().maxCoeff() < limit && c.normal.cwiseAbs().maxCoeff() < S(2) &&
         std::abs(c.normal.squaredNorm() - S(1)) < S(1e-3);
}

/// A rigid frictionless sphere, pressed along the normal.
template <Real S>
struct SphereContact {
  Vec3<S> place = Vec3<S>::Zero();    ///< first touch, on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitZ();  ///< outward, unit
  S radius = S(0);                    ///< of the sphere [m], > 0
  S curvature = S(0);                 ///< k1 + k2 of the surface at `place`, > 0 where convex [1/m]
  S depth = S(0);                     ///< [m]; <= 0: no contact
};

/// Constants of second order in depth, for a stuck patch on nearly incompressible rubber (neo-Hookean, nu = 0.49).
/// Fitted on one normal push on a cube and one skew push on an ellipsoid, rounded, used for every body; depth <= 2 a.
/// delta_n: local indentation, the normal displacement of a half-space by the same force. Without constants: the radial
/// double force -F_n d_n and the moment of tilt F_n d_t - F_t d_n, by which the load has moved.
struct SecondOrder {
  double radial = 0.18;    ///< near term along the surface, times delta_n d_n / a
  double sink = 0.36;      ///< near term along the normal, likewise
  double drag = 0.3;       ///< tangential force drag mu delta_n d_t
  double softening = 0.3;  ///< normal force -softening mu delta_n d_n
};

}  // namespace palpate
