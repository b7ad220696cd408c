// SPDX-License-Identifier: MIT
#pragma once

/// @file What a response field is pressed by: a stuck patch, a sphere; and the constants of second order in
/// depth.

#include <palpate/core/vector.hpp>

#include <cmath>

namespace palpate {

/// A stuck flat patch: every surface point within `radius` of `place` moves by `displacement` and turns about
/// `place` by `rotation`.
template <Real S>
struct ResponseContact {
  Vec3<S> place = Vec3<S>::Zero();         ///< on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitZ();       ///< outward, unit
  S radius = S(0);                         ///< a > 0 [m]
  Vec3<S> displacement = Vec3<S>::Zero();  ///< d; d.normal < 0 presses [m]
  Vec3<S> rotation =
      Vec3<S>::Zero();  ///< vector of the tool's since it touched [rad]; accurate to 0.3, below a half turn
};

/// True when a contact is finite, of sensible size, with a unit normal, turned by less than a half turn.
template <Real S>
[[nodiscard]] inline bool is_usable(const ResponseContact<S>& c) noexcept {
  const S limit = S(1e6);
  return is_finite(c.place) && is_finite(c.displacement) && is_finite(c.normal) && is_finite(c.radius) &&
         is_finite(c.rotation) && c.rotation.squaredNorm() < S(9.8) && c.radius > S(1e-9) &&
         c.radius < limit && c.place.cwiseAbs().maxCoeff() < limit &&
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

/// A factor that changes with depth, by `deep` from beta = 0 to 1; beta = delta_n / a, 0 to 2.
struct DeepFactor {
  double shallow = 0, deep = 0;
  [[nodiscard]] double at(double beta) const noexcept { return shallow + deep * beta; }
};

/// Constants of second order in depth and more, for a stuck patch on neo-Hookean rubber; depth <= 2 a. They
/// are those of nu = 1/2; `at(nu)` is what is used, below 0.3 that of 0.3. What is drawn near the patch
/// (DeepFactor, contact_near.hpp) was fitted at nu = 0.49 on finite elements of a half-space alone, pressed
/// normally and askew; the rest on pushes into a cube, a block, a wall and two ellipsoids, but `turned` and
/// `crossed` on all references of docs/accuracy.md; those of a patch that the tool turns on a half-space and
/// a block; those of a sphere on a half-space, a block, a slab and two ellipsoids; the change with nu on one
/// normal, one skew and one tilted push and one sphere at 0.3. Rounded, used for every body. delta_n,
/// delta_t: local indentation, the displacement of a half-space by the same force, normal and tangential;
/// w_n, w_t: the rest, by which the body as a whole gives way; s: slope of w_n under the patch. Without
/// constants: the radial double force -nu / (1 - nu) F_n d_n, F_n at most twice the half-space's, and the
/// force by which a body that spreads under the patch stiffens.
struct SecondOrder {
  double radial = 0.19;  ///< near term along the surface, times delta_n d_n / a; times (2 nu)^3
  DeepFactor radial_4{-0.39, 0.14}, radial_6{0.14, 0.11};  ///< likewise, times s^-4 and s^-6; times 1 - 2.5 b
  DeepFactor normal_4{-0.09, 0.42}, normal_6{0.66, -0.65};  ///< along the normal; the same for every nu
  DeepFactor slide{-0.65, 0.2};  ///< times beta^2 delta_t, beta held at 1; times 1 - 2.5 b
  double turn_slid = 0.4;  ///< moment of tilt turn_slid F_n w_t - turn_sunk F_t w_n; the same for every nu
  double turn_sunk = 0.6;
  double lever =
      0.35;  ///< energy lever (F_n w_t - F_t w_n) . s, whose forces the tool feels; the same for every nu
  double drag =
      1.2;  ///< tangential force drag mu delta_n delta_t / (1 + (delta_n / a)^2); times 1 + 1.3 b, b = 1 - 2 nu
  double softening = 0.36;  ///< normal force -softening mu delta_n d_n; times 1 - 2.5 b
  double turned = 0.7;      ///< displacement by the rotation of w (turned_field.hpp); the same for every nu
  double crossed = 0.3;     ///< by w's and the near field's together; the same for every nu
  // Of a patch that the tool turns, s the slope that its normal displacement gets.
  double tip = 1.85;  ///< energy -tip mu a delta_n delta_t . s; times 1 - b
  double ease =
      0.13;  ///< of the moment of tilt that the tool feels, times delta_n / a; the same for every nu
  double foreshortened =
      1;  ///< radial double force -foreshortened s^2 over a tilt's compliance; the same for every nu
  // Of a frictionless sphere (pressed_sphere.hpp).
  double ball_pull = 0.33;  ///< radial double force -nu / (1 - nu) F (C_w F + ball_pull d_H)
  double ball_spread =
      0.15;  ///< displacement along the surface within the contact, ball_spread (1 - (r/a)^2) r d_H / R; times 1 + 1.7 b
  double ball_softening = 0.06;  ///< of depth over the sphere's radius; times 1 - 7 b

  [[nodiscard]] SecondOrder at(double nu) const noexcept {
    const double held = nu > 0.3 ? nu : 0.3, b = 1 - 2 * held;
    const double less = 1 - 2.5 * b;
    const auto lessened = [less](const DeepFactor& k) { return DeepFactor{less * k.shallow, less * k.deep}; };
    SecondOrder out = *this;
    out.radial *= 8 * held * held * held;
    out.radial_4 = lessened(radial_4);
    out.radial_6 = lessened(radial_6);
    out.slide = lessened(slide);
    out.drag *= 1 + 1.3 * b;
    out.softening *= less;
    out.tip *= 1 - b;
    out.ball_spread *= 1 + 1.7 * b;
    out.ball_softening *= 1 - 7 * b;
    return out;
  }
};

}  // namespace palpate
