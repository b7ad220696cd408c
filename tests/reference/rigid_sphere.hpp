// SPDX-License-Identifier: MIT
#pragma once

/// @file A rigid frictionless sphere on a half-space, exact for any depth [sneddon1965].

#include <cmath>

namespace palpate::test {

/// Force [N] at the depth d [m], below that of a = 0.999 R; E' = E/(1 - nu^2) [Pa].
///
///     d = a/2 l,   F = E'/2 ((a^2 + R^2) l - 2 a R),   l = ln((R + a)/(R - a))
[[nodiscard]] inline double rigid_sphere_force(double R, double d, double E_plane) {
  double low = 0, high = 0.999 * R;
  for (int i = 0; i < 100; ++i) {
    const double a = (low + high) / 2;
    (a / 2 * std::log((R + a) / (R - a)) < d ? low : high) = a;
  }
  const double a = low;
  return E_plane / 2 * ((a * a + R * R) * std::log((R + a) / (R - a)) - 2 * a * R);
}

}  // namespace palpate::test
