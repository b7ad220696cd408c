// SPDX-License-Identifier: MIT
#pragma once

/// @file Rigid flat circular punch that is bonded to a half-space: its compliance, the mean over it, its
/// force. Its field around it: disc.hpp.

#include <palpate/elasticity/disc.hpp>

namespace palpate {

/// Compliance of the bonded flat punch to a force, times mu [1/m]:
///
///     normal      (1 - 2 nu) / (4 a ln(3 - 4 nu)),   1/(8 a) at nu = 1/2
///     tangential  (2 - nu) / (8 a)
///
/// | symbol | name              | unit | range    |
/// |--------|-------------------|------|----------|
/// | a      | radius            | m    | > 0      |
/// | nu     | Poisson's ratio   | -    | [0, 1/2] |
///
/// Sources: [spence1968] (normal, bonded), [mindlin1949] (tangential).
struct FlatPunchCompliance {
  double normal, tangential;
};
[[nodiscard]] inline FlatPunchCompliance flat_punch_compliance(double radius, double nu) noexcept {
  const double b = 1 - 2 * nu;
  // Below b = 1e-6 the limit 1/(8 a) is exact to six digits and nothing is divided by 0.
  return {b > 1e-6 ? b / (4 * radius * std::log1p(2 * b)) : 1 / (8 * radius), (2 - nu) / (8 * radius)};
}

/// Twelve points of the unit disc with equal weights, for means with the flat punch's weight: two rings by
/// Gauss's rule in sqrt(1 - s^2), in which the weight is uniform.
[[nodiscard]] inline const std::array<std::array<double, 2>, 12>& flat_punch_points() noexcept {
  // h = sqrt(3)/2; the rings have the radii r and q.
  static constexpr double h = 0.86602540378443865, r = 0.97741587937861918, q = 0.61481015937592787;
  static constexpr std::array<std::array<double, 2>, 12> points{{{r, 0},
                                                                 {0.5 * r, h * r},
                                                                 {-0.5 * r, h * r},
                                                                 {-r, 0},
                                                                 {-0.5 * r, -h * r},
                                                                 {0.5 * r, -h * r},
                                                                 {h * q, 0.5 * q},
                                                                 {0, q},
                                                                 {-h * q, 0.5 * q},
                                                                 {-h * q, -0.5 * q},
                                                                 {0, -q},
                                                                 {h * q, -0.5 * q}}};
  return points;
}

/// 4 pi mu u at r [m] of the force f on a bonded flat punch; m: unit normal into the body, `depth` [m] as the
/// disc sees it (edge_depth).
[[nodiscard]] inline Vec3<double> flat_punch_load(const Vec3<double>& r, const Vec3<double>& m, double depth,
                                                  double radius, const Vec3<double>& f, double nu) noexcept {
  const double fn = f.dot(m);
  const Vec3<double> p = r - r.dot(m) * m, t = f - fn * m;
  const auto u = Disc<double>(p.squaredNorm(), (std::max)(depth, 0.0), radius).flat_punch(fn, t.dot(p), nu);
  return u.in_plane * p + u.normal * m + u.along * t;
}

}  // namespace palpate
