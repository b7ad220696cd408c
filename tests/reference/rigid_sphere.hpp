// SPDX-License-Identifier: MIT
#pragma once

/// @file A rigid frictionless sphere on a half-space, exact for any depth [sneddon1965].

#include <cmath>

namespace palpate::test {

/// Radius a of the contact [m] at the depth d [m], below 0.999 R:
///
///     d = a/2 l,   l = ln((R + a)/(R - a))
[[nodiscard]] inline double rigid_sphere_radius(double R, double d) {
  double low = 0, high = 0.999 * R;
  for (int i = 0; i < 100; ++i) {
    const double a = (low + high) / 2;
    (a / 2 * std::log((R + a) / (R - a)) < d ? low : high) = a;
  }
  return low;
}

/// Force [N], F = E'/2 ((a^2 + R^2) l - 2 a R); E' = E/(1 - nu^2) [Pa].
[[nodiscard]] inline double rigid_sphere_force(double R, double d, double E_plane) {
  const double a = rigid_sphere_radius(R, d);
  return E_plane / 2 * ((a * a + R * R) * std::log((R + a) / (R - a)) - 2 * a * R);
}

}  // namespace palpate::test
