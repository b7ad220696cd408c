// SPDX-License-Identifier: MIT
#pragma once

/// @file  Kelvin's solution: point force in an infinite elastic body. Set-up only.
///
/// Displacement U f and traction on a plane with normal n of T u, with r = y - x, R = |r|, e = r / R:
///     U = [(3 - 4 nu) I + e e^T] / (16 pi mu (1 - nu) R)
///     T = -[(e.n)((1 - 2 nu) I + 3 e e^T) - (1 - 2 nu)(e n^T - n e^T)] / (8 pi (1 - nu) R^2)
/// mu = 1 throughout. Nothing is singular at nu = 1/2. Source: [brebbia1984].

#include <palpate/config.hpp>
#include <palpate/core/vector.hpp>

#include <cmath>
#include <numbers>

namespace palpate {

class Kelvin {
 public:
  explicit Kelvin(double nu) noexcept
      : u_(1 / (16 * std::numbers::pi * (1 - nu))),
        t_(-1 / (8 * std::numbers::pi * (1 - nu))),
        a_(3 - 4 * nu),
        b_(1 - 2 * nu) {}

  /// Displacement at y of a unit force at x; columns are the force's directions.
  [[nodiscard]] Mat3<double> displacement(const Vec3<double>& r) const noexcept {
    const double inverse = 1 / r.norm();
    const Vec3<double> e = r * inverse;
    Mat3<double> U = (u_ * inverse) * (e * e.transpose());
    U.diagonal().array() += u_ * inverse * a_;
    return U;
  }
  /// U F of three forces F, by columns.
  [[nodiscard]] PALPATE_INLINE Mat3<double> displacement(const Vec3<double>& r,
                                                         const Mat3<double>& F) const noexcept {
    const double inverse2 = 1 / r.squaredNorm(), c = u_ * std::sqrt(inverse2), ca = c * a_, ce = c * inverse2;
    Mat3<double> u;
    for (Eigen::Index j = 0; j < 3; ++j) {
      const double along = ce * (r[0] * F(0, j) + r[1] * F(1, j) + r[2] * F(2, j));
      for (Eigen::Index i = 0; i < 3; ++i) u(i, j) = ca * F(i, j) + along * r[i];
    }
    return u;
  }
  /// Row i: traction kernel that multiplies u in the boundary equation of component i.
  [[nodiscard]] Mat3<double> traction(const Vec3<double>& r, const Vec3<double>& n) const noexcept {
    const double inverse2 = 1 / r.squaredNorm(), inverse = std::sqrt(inverse2);
    const Vec3<double> e = r * inverse;
    const double en = e.dot(n), c = t_ * inverse2;
    Mat3<double> T = (3 * c * en) * (e * e.transpose()) - (c * b_) * (e * n.transpose() - n * e.transpose());
    T.diagonal().array() += c * b_ * en;
    return T;
  }

 private:
  double u_, t_, a_, b_;
};

}  // namespace palpate
