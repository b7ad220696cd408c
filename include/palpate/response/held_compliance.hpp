// SPDX-License-Identifier: MIT
#pragma once

/// @file  Bounds that are kept smoothly: of a compliance from below, so that no force is larger than d / (least compliance); of
/// what a mesh may not resolve from above. Per tick.

#include <palpate/core/vector.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>

namespace palpate::detail {

/// Makes the eigenvalues lambda of symmetric C (of fixed size: no heap) max(|lambda|, least), least > 0; those above stay.
/// Continuous in C. A true one is positive: one that is far below 0 is off by at least as much, so that mode may well give way.
template <class M>
void hold_above(M& C, double least) noexcept {
  const Eigen::SelfAdjointEigenSolver<M> eigen(C);
  const auto& V = eigen.eigenvectors();
  M missing = V;  // V (max(|lambda|, least) - lambda)
  for (Eigen::Index i = 0; i < C.cols(); ++i)
    missing.col(i) *= (std::max)(std::abs(eigen.eigenvalues()[i]), least) - eigen.eigenvalues()[i];
  C.noalias() += missing * V.transpose();
}

/// True when C - least I is positive definite (Sylvester).
[[nodiscard]] inline bool is_above(const Mat3<double>& C, double least) noexcept {
  const double a = C(0, 0) - least, b = C(1, 1) - least, c = C(2, 2) - least;
  const double minor = a * b - C(1, 0) * C(1, 0);
  const double det =
      c * minor - a * C(2, 1) * C(2, 1) - b * C(2, 0) * C(2, 0) + 2 * C(1, 0) * C(2, 0) * C(2, 1);
  return a > 0 && minor > 0 && det > 0;
}

/// (1 + r^8)^(-1/8), r^2 = size2 / most2 >= 0: what keeps a vector of squared length size2 below most2; 1 where it is.
[[nodiscard]] inline double fading(double size2, double most2) noexcept {
  const double r2 = size2 / (most2 + (std::numeric_limits<double>::min)()), r8 = r2 * r2 * r2 * r2;
  // Most are small, and roots take their time: the series, to the last digit.
  if (r8 < 1e-3) return 1 + r8 * (-1. / 8 + r8 * (9. / 128 + r8 * (-51. / 1024 + r8 * (1275. / 32768))));
  return 1 / std::sqrt(std::sqrt(std::sqrt(1 + r8)));
}

}  // namespace palpate::detail
