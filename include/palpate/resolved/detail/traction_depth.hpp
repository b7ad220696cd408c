// SPDX-License-Identifier: MIT
#pragma once

/// @file By how much beneath a tool's points friction's tractions act, to the second order in depth.

#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/load_fit.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::detail {

/// A tool that sticks and is dragged by u, or rolled by phi about the pole of its contact, has the energy
///
///     E = k (u + h phi)^2 / 2,   h = mean by traction of the points' heights above the pole - l
///
/// In the linear theory l = 0: h = a^2/(3 R) under a ball, a^2/(4 R) under a lying cylinder. At nu = 1/2 the
/// energy's term of third degree, the integral of -p II(H) - mu det H over the body (p: pressure in it, H:
/// gradient of the linear displacement), has a part in pressing, u and phi, which makes
///
///     l = 0.0782 a^2/R   ball;   a^2/(8 R)   lying cylinder;   0.265 d   flat disc, d deep
///
/// the cylinder's exactly, the others by quadrature. For contacts of any shape
///
///     l = 0.282 sqrt(e) (S/(1 + S/s))^(1/2),   s = A/(8 pi)
///
/// S: variance by load of the points' positions along the path, a tensor across m; A: the area under a ball
/// with the same load and mean pressure by load, and e = d_H/R by that pressure (finite_strain.hpp). 0.282
/// and 8 give the ball's and the cylinder's l; s keeps contacts far apart from an l that belongs to neither.
///
/// By finite elements, nonlinear less linear ones, over this: a ball d = R/4 deep 0.9 to 1 for nu from 0.15
/// to 0.4, 1.35 at nu = 0.49; a capsule 0.85 to 1.25; a flat cylinder with a rounded rim 0.75 to 1.4. What
/// rolls on takes in surface that has not been dragged, and has 0.5 to 0.7 of it: 0.6 is taken, chosen on a
/// ball and a capsule that roll on a block. Force and couple have the same l, or a drag and a roll round
/// would give energy. Where a tool slides it has none: the caller's share is how firmly friction holds.
class TractionDepth {
 public:
  explicit TractionDepth(double nu) : root_of_strain_(root_of_strain_per_load(nu)) {}

  void forget() noexcept { l_.setZero(), m_.setZero(); }
  /// Of the loads of `fit`.
  void measure(const LoadFit& fit) noexcept {
    forget();
    if (!(fit.pressed() > 0)) return;
    m_ = fit.direction();
    const float s = carrying_area(fit.load(), fit.pressed()) / (8 * std::numbers::pi_v<float>),
                root = (std::min)(root_of_strain_ * fit.pressed() / fit.load(), 1.f);
    const Mat3<float> S = fit.spread() / s, of_one = (Mat3<float>::Identity() + S).inverse() * S,
                      across = Mat3<float>::Identity() - m_ * m_.transpose();
    // The root of what has no part along m, by its two invariants.
    const float sum = of_one.trace(),
                product = std::sqrt((std::max)((sum * sum - of_one.squaredNorm()) / 2, 0.f));
    if (!(sum > 0)) return;
    constexpr float factor = 0.6f * 0.282f;
    l_ = factor * fit.one_sided() * root * std::sqrt(s / (sum + 2 * product)) * (of_one + product * across);
  }
  /// By how much tractions that stick are moved where the tool turns, less what its points are [m].
  [[nodiscard]] Vec3<float> moved(const Mat3<float>& turn) const noexcept { return l_ * (turn * m_ - m_); }
  /// Of tractions, their sum t, about where they act at the tool's points.
  [[nodiscard]] Vec3<float> couple(const Vec3<float>& t) const noexcept { return m_.cross(l_ * t); }

 private:
  float root_of_strain_;  // sqrt(e) over q/A
  Mat3<float> l_ = Mat3<float>::Zero();
  Vec3<float> m_ = Vec3<float>::Zero();
};

}  // namespace palpate::detail
