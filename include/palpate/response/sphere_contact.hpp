// SPDX-License-Identifier: MIT
#pragma once

/// @file  A rigid frictionless sphere pressed into the body: the contact area grows with depth. Per tick.
///
/// The half-space's answer in series with the body's correction, d = d_H(F) + C_w F:
///     d_H = (a/2) l,   F = (E*/2) ((a^2 + R^2) l - 2 a R),   l = ln((R+a)/(R-a)),   E* = E/(1-nu^2)
/// | symbol | name                                     | unit | range            |
/// |--------|------------------------------------------|------|------------------|
/// | R      | radius of the relative curvature         | m    | > 0              |
/// | a      | radius of the contact                    | m    | [0, 0.95 R]      |
/// | d      | how deep the sphere is pressed           | m    | <= 0: no contact |
/// | C_w    | normal compliance of the correction      | m/N  |                  |
/// 2/R = 2/R_sphere + k1 + k2 with the surface's principal curvatures. Limits: no friction; pressed along the normal; the
/// depth is held where a = 0.95 R. Second order in depth is left out: with a growing frictionless contact it makes the
/// field worse. Sources: [sneddon1965], [johnson1985] ch. 4.

#include <palpate/core/scalar.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// What a pressed sphere feels.
template <Real S>
struct SphereForce {
  S force;      ///< normal, >= 0 [N]
  S stiffness;  ///< dF/dd [N/m]
  S radius;     ///< of the contact [m]
};

/// Solves d = d_H(a) + C_w F(a) for a by Newton steps inside a bracket; d grows with a, so the root is single.
template <Real S>
[[nodiscard]] inline SphereForce<S> sphere_force(S depth, S R, S modulus, S compliance) noexcept {
  if (!is_finite(depth) || !(depth > S(0)) || !is_finite(R) || !(R > S(0))) return {S(0), S(0), S(0)};
  const S C = (std::max)(compliance, S(0));
  const auto load = [&](S s) {  // F / R^2 at s = a / R; series where the difference cancels
    if (s < S(0.1)) return modulus * s * s * s * (S(4) / S(3) + s * s * (S(8) / S(15) + s * s * S(12) / S(35)));
    return S(0.5) * modulus * ((s * s + S(1)) * std::log((S(1) + s) / (S(1) - s)) - S(2) * s);
  };
  const auto own = [&](S s) { return S(0.5) * s * std::log((S(1) + s) / (S(1) - s)); };  // d_H / R
  const S target = depth / R, series = C * R;
  S low = 0, high = S(0.95), s = (std::min)(std::sqrt(target), S(0.9));
  for (int i = 0; i < 40; ++i) {
    const S value = own(s) + series * load(s) - target;
    (value > S(0) ? high : low) = s;
    const S l = std::log((S(1) + s) / (S(1) - s)), q = S(1) / (S(1) - s * s);
    const S d_own = S(0.5) * l + s * q, d_load = modulus * (s * l + (s * s + S(1)) * q - S(1));
    const S next = s - value / (d_own + series * d_load);
    const S old = s;
    s = next > low && next < high ? next : S(0.5) * (low + high);
    if (std::abs(s - old) <= S(4) * std::numeric_limits<S>::epsilon() * s) break;
  }
  const S l = std::log((S(1) + s) / (S(1) - s)), q = S(1) / (S(1) - s * s);
  const S d_own = S(0.5) * l + s * q, d_load = modulus * (s * l + (s * s + S(1)) * q - S(1));
  return {R * R * load(s), R * d_load / (d_own + series * d_load), R * s};
}

}  // namespace palpate
