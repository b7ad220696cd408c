// SPDX-License-Identifier: MIT
#pragma once

/// @file A rigid frictionless sphere pressed into the body: the contact area grows with depth. Per tick.
///
/// The half-space's compliance in series with that of the regular part, l = ln((R+a)/(R-a)):
///     d = d_H (1 + k d_H/R)/(1 + x a/R) + C_w F
///     d_H = (a/2) l - g a^4/(3 R^3),   F = E* ((a^2 + R^2) l/2 - a R - 8/15 g a^5/R^3),   E* = E/(1-nu^2)
/// | symbol | name | unit | range |
/// |---|---|---|---|
/// | R | radius of the relative curvature, 2/R = 2/R_sphere + k1 + k2 | m | > 0 |
/// | a | radius of the contact | m | [0, 0.95 R] |
/// | d | how deep the sphere is pressed | m | <= 0: none |
/// | C_w | normal compliance of the regular part; < 0 where a layer lies on something stiff | m/N |  |
/// | g | of the gap's r^4, the part that a sphere of radius R on a plane has too much | - | [0, 1] |
/// | k | softening by finite strain | - | > -0.25 |
/// | x | stiffening where the surface is drawn in, nu < 1/2 | - | >= 0 |
/// k1, k2: the surface's principal curvatures. Limits: no friction; pressed along the normal; the depth is
/// bounded where a = 0.95 R; what a body takes from d_H is at most half of it. Sources: [sneddon1965],
/// [johnson1985] ch. 4.

#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/response/tick/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// What a pressed sphere feels.
template <Real S>
struct SphereForce {
  S force = S(0);      ///< normal, >= 0 [N]
  S stiffness = S(0);  ///< dF/dd [N/m]
  S radius = S(0);     ///< of the contact [m]
};

/// What a sphere that is pressed into a body feels; `force` and `stiffness` are along the normal.
struct PressedSphere : SphereForce<double> {
  /// Tangential force on the body [N], 1 to 5 % of `force` where the body slopes.
  Vec3<double> across = Vec3<double>::Zero();

  /// Force that the sphere exerts on the body [N]; `normal`: the contact's, outward, unit.
  [[nodiscard]] Vec3<double> on_body(const Vec3<double>& normal) const noexcept {
    return across - force * normal;
  }
};

/// Solves d(a) for a by Newton steps inside a bracket; d grows with a, so the root is single. `compliance`:
/// C_w; `less`: g; `softening`: k; `drawn_in`: x.
template <Real S>
[[nodiscard]] inline SphereForce<S> sphere_force(S depth, S R, S modulus, S compliance, S less = S(0),
                                                 S softening = S(0), S drawn_in = S(0)) noexcept {
  if (!is_finite(depth) || !(depth > S(0)) || !is_finite(R) || !(R > S(0))) return {};
  struct Value {
    S load, by_load, depth, by_depth;  // F / R^2, d / R, and their derivatives by s = a / R
  };
  const S target = depth / R, series = compliance * R;
  constexpr S min_share = S(-detail::tick::max_body_share);
  const auto at = [&](S s) {
    const S l = std::log((S(1) + s) / (S(1) - s)), q = S(1) / (S(1) - s * s), s2 = s * s, s3 = s2 * s;
    const S own = S(0.5) * s * l - less * s * s3 / S(3),
            by_own = S(0.5) * l + s * q - S(4) / S(3) * less * s3;
    Value v;
    // Series where the difference cancels.
    v.load = s < S(0.1) ? s3 * (S(4) / S(3) + s2 * (S(8) / S(15) + s2 * S(12) / S(35)))
                        : S(0.5) * ((s2 + S(1)) * l - S(2) * s);
    v.load = modulus * (v.load - S(8) / S(15) * less * s2 * s3);
    v.by_load = modulus * (s * l + (s2 + S(1)) * q - S(1) - S(8) / S(3) * less * s2 * s2);
    const S stiffer = S(1) + drawn_in * s;
    v.depth = own * (S(1) + softening * own) / stiffer;
    v.by_depth = (by_own * (S(1) + S(2) * softening * own) - drawn_in * v.depth) / stiffer;
    const bool bounded = series * v.load < min_share * v.depth;
    v.depth += bounded ? min_share * v.depth : series * v.load;
    v.by_depth += bounded ? min_share * v.by_depth : series * v.by_load;
    return v;
  };
  // Newton's method in a bracket, from Hertz's a^2 = R d on; 2 to 6 steps are usual.
  S low = 0, high = S(detail::tick::max_contact_radius), s = (std::min)(std::sqrt(target), S(0.9));
  for (int i = 0; i < 40; ++i) {
    const Value v = at(s);
    const S step = (v.depth - target) / v.by_depth;
    if (std::abs(step) <= S(4) * std::numeric_limits<S>::epsilon() * s) break;
    (v.depth > target ? high : low) = s;
    const S next = s - step;
    s = next > low && next < high ? next : S(0.5) * (low + high);
  }
  const Value v = at(s);
  return {R * R * v.load, R * v.by_load / v.by_depth, R * s};
}

}  // namespace palpate
