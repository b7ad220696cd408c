// SPDX-License-Identifier: MIT
#pragma once

/// @file Smooth bounds: from below on a compliance, so that no force exceeds d / (least compliance); from
/// above on what a mesh may not resolve. Per tick.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::detail {

/// Replaces each eigenvalue lambda of symmetric C by max(|lambda|, min), min > 0. C has a fixed size: no
/// heap. The result is continuous in C. A true compliance is positive, so an eigenvalue far below 0 is wrong
/// by at least its size, and its mode may well be as compliant as |lambda|.
///
/// Jacobi's rotations until the sum of squares off the diagonal is 1e-18 of that on it. 4 to 6 sweeps were
/// met; 10 is the limit, for a matrix that is not finite. A rotation is left out where its entry is below
/// that bound alone. Eigen's solver is as fast for 3 to 6 rows, but costs each including file 13 s of gcc 12.
/// Source: [golub2013], 8.5.
template <class M>
void bound_below(M& C, double min) noexcept {
  constexpr Eigen::Index n = M::RowsAtCompileTime;
  M A = C, V = M::Identity();  // V^T C V = A
  const auto rotate = [](double c, double s, double* x, double* y) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double before = x[i];
      x[i] = c * before - s * y[i];
      y[i] = s * before + c * y[i];
    }
  };
  for (int sweep = 0; sweep < 10; ++sweep) {
    double on = 0, off = 0;
    for (Eigen::Index q = 0; q < n; ++q) {
      on += A(q, q) * A(q, q);
      for (Eigen::Index p = 0; p < q; ++p) off += A(p, q) * A(p, q);
    }
    if (!(off > 1e-18 * on)) break;  // less than 1e-9 of the diagonal (chosen)
    for (Eigen::Index q = 1; q < n; ++q)
      for (Eigen::Index p = 0; p < q; ++p) {
        const double both = A(p, q);
        if (both * both <= 1e-20 / (n * n) * on) continue;
        const double apart = 0.5 * (A(q, q) - A(p, p)) / both;  // cot(2 angle)
        const double t = std::copysign(1 / (std::abs(apart) + std::sqrt(apart * apart + 1)), apart),
                     c = 1 / std::sqrt(t * t + 1), s = t * c;
        const double pp = A(p, p) - t * both, qq = A(q, q) + t * both;
        rotate(c, s, &A(0, p), &A(0, q));
        rotate(c, s, &V(0, p), &V(0, q));
        A(p, p) = pp, A(q, q) = qq, A(p, q) = A(q, p) = 0;
        for (Eigen::Index i = 0; i < n; ++i) A(p, i) = A(i, p), A(q, i) = A(i, q);
      }
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const double missing = (std::max)(std::abs(A(k, k)), min) - A(k, k);
    if (!(missing > 0)) continue;
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i) C(i, j) += missing * V(i, k) * V(j, k);
  }
}

/// True when C - min I is positive definite (Sylvester's criterion).
[[nodiscard]] inline bool is_bounded_below(const Mat3<double>& C, double min) noexcept {
  const double a = C(0, 0) - min, b = C(1, 1) - min, c = C(2, 2) - min;
  const double minor = a * b - C(1, 0) * C(1, 0);
  const double det =
      c * minor - a * C(2, 1) * C(2, 1) - b * C(2, 0) * C(2, 0) + 2 * C(1, 0) * C(2, 0) * C(2, 1);
  return a > 0 && minor > 0 && det > 0;
}

/// Factor (1 + r^8)^(-1/8), r^2 = size2 / max2 >= 0, that keeps a vector of squared length size2 below max2
/// and leaves a small one alone. The power 8: within 1 % of 1 up to r = 0.7, of 1/r from r = 1.4 on.
[[nodiscard]] inline double smooth_limit(double size2, double max2) noexcept {
  const double r2 = size2 / (max2 + (std::numeric_limits<double>::min)()), r8 = r2 * r2 * r2 * r2;
  // Most vectors are small and roots are slow: below 1e-3 the binomial series is exact to the last digit.
  if (r8 < 1e-3) return 1 + r8 * (-1. / 8 + r8 * (9. / 128 + r8 * (-51. / 1024 + r8 * (1275. / 32768))));
  return 1 / std::sqrt(std::sqrt(std::sqrt(1 + r8)));
}

/// 3 t^2 - 2 t^3 of t = x, clamped to [0, 1]: from 0 to 1 without a jump of value or slope.
[[nodiscard]] inline double smooth_step(double x) noexcept {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace palpate::detail
