// SPDX-License-Identifier: MIT
#pragma once

/// @file Constants of the response field's second order in depth. Formulas: docs/response_field.md, "Second
/// order in depth"; they are applied in tick/second_order_loads.hpp, tick/near_field.hpp,
/// tick/pressed_sphere.hpp and tick/rotation_correction.hpp.
///
/// | symbol | name | unit |
/// |---|---|---|
/// | d; d_n, d_t | displacement of the patch; its normal and tangential part | m |
/// | F, mu, a | force; shear modulus; radius of the patch | N, Pa, m |
/// | delta_n, delta_t | local indentation: displacement of a half-space by the same force | m |
/// | w_n, w_t | d - delta, the regular part: by how much the body as a whole moves | m |
/// | s | slope of w_n under the patch; for a rotated tool the slope that it gives the patch | - |
/// | beta, b | delta_n / a; 1 - 2 nu | - |
/// | d_H, R | a sphere's indentation of the half-space; its radius | m |
///
/// Constants are those of nu = 1/2; `at(nu)` gives what is used. All are dimensionless, were fitted on
/// neo-Hookean finite elements and rounded, and serve every body. The cases are those of docs/accuracy.md.
/// Range: d <= 2 a, nu in [0.3, 1/2]; below nu = 0.3 the constants of 0.3 are used, untested but for the
/// force of a sphere, nu in [0, 1/2].

#include <numbers>

namespace palpate {

/// Factor that changes with depth: shallow + deep beta, beta = delta_n / a in [0, 2].
struct DepthFactor {
  double shallow = 0, deep = 0;
  [[nodiscard]] double at(double beta) const noexcept { return shallow + deep * beta; }
};

/// | group            | fitted on                                                                       |
/// |------------------|---------------------------------------------------------------------------------|
/// | near the patch   | half-space pressed normally and askew at nu = 0.49, beyond its own linear field |
/// | loads and forces | cube, block, wall and two ellipsoids, normal and skew                           |
/// | rotation         | all references of docs/accuracy.md                                              |
/// | rotated tool     | half-space and block, rotated tool                                              |
/// | sphere           | half-space, block, slab, two ellipsoids                                         |
/// | change with nu   | a normal, a skew and a rotated push and a sphere at nu = 0.3                    |
///
/// Not fitted, thus not here: the radial force dipole -nu/(1-nu) F_n d_n, F_n at most twice the half-space's
/// force, and the force by which a body that spreads under the patch stiffens.
struct SecondOrder {
  // Near the patch, drawn outside it.
  double radial = 0.19;               ///< radial, times delta_n d_n / a; times (2 nu)^3
  DepthFactor radial_4{-0.39, 0.14};  ///< radial, times (a/r)^4 likewise; times 1 - 2.5 b
  DepthFactor radial_6{0.14, 0.11};   ///< radial, times (a/r)^6 likewise; times 1 - 2.5 b
  DepthFactor normal_4{-0.09, 0.42};  ///< along the normal, times (a/r)^4; the same for every nu
  DepthFactor normal_6{0.66, -0.65};  ///< along the normal, times (a/r)^6; the same for every nu
  DepthFactor slide{-0.65, 0.2};      ///< times beta^2 delta_t, beta at most 1; times 1 - 2.5 b

  // Loads and forces of a patch.
  double couple_slid =
      0.4;  ///< bending couple couple_slid F_n w_t - couple_sunk F_t w_n; the same for every nu
  double couple_sunk = 0.6;
  double lever = 0.35;      ///< energy lever (F_n w_t - F_t w_n) . s, felt by the tool; the same for every nu
  double drag = 1.2;        ///< tangential force drag mu delta_n delta_t / (1 + beta^2); times 1 + 1.3 b
  double softening = 0.36;  ///< normal force -softening mu delta_n d_n; times 1 - 2.5 b

  // Rotation of the body (rotation_correction.hpp); the same for every nu.
  double rotated = 0.7;  ///< displacement by the rotation of w
  double crossed = 0.3;  ///< displacement by that of w and of the near field together

  // A patch that the tool rotates.
  double tip = 1.85;   ///< energy -tip mu a delta_n delta_t . s; times 1 - b
  double ease = 0.13;  ///< part of the felt bending couple that is lost, times beta; the same for every nu
  double foreshortened = 1;  ///< radial force dipole -foreshortened s^2 / (compliance to a bending couple)

  // A frictionless sphere (pressed_sphere.hpp).
  double sphere_dipole = 0.33;  ///< radial force dipole -nu/(1-nu) F (C_w F + sphere_dipole d_H)
  double sphere_spread = 0.15;  ///< radial within the contact, times (1 - (r/a)^2) r d_H / R; times 1 + 1.7 b
  double sphere_softening = 0.06;  ///< of the depth, times d_H / R; times 1 - 0.4 b
  double sphere_drawn_in = 0;      ///< of it, less by times a / R: (3 - 2 nu) (1 - 2 nu) / (4 pi (1 - nu))

  /// The constants of a body with Poisson's ratio nu.
  [[nodiscard]] SecondOrder at(double nu) const noexcept {
    const double compared = nu > 0.3 ? nu : 0.3, b = 1 - 2 * compared;
    const double less = 1 - 2.5 * b;
    const auto lessened = [less](const DepthFactor& k) {
      return DepthFactor{less * k.shallow, less * k.deep};
    };
    SecondOrder out = *this;
    out.radial *= 8 * compared * compared * compared;
    out.radial_4 = lessened(radial_4);
    out.radial_6 = lessened(radial_6);
    out.slide = lessened(slide);
    out.drag *= 1 + 1.3 * b;
    out.softening *= less;
    out.tip *= 1 - b;
    out.sphere_spread *= 1 + 1.7 * b;
    out.sphere_softening *= 1 - 0.4 * b;
    out.sphere_drawn_in = (3 - 2 * nu) * (1 - 2 * nu) / (4 * std::numbers::pi * (1 - nu));
    return out;
  }
};

}  // namespace palpate
