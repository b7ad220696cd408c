// SPDX-License-Identifier: MIT
#pragma once

/// @file Bounds that are kept smoothly: of a compliance from below, so that no force is larger than d /
/// (least compliance); of what a mesh may not resolve from above. Per tick.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::detail {

/// Makes the eigenvalues lambda of symmetric C (of fixed size: no heap) max(|lambda|, least), least > 0;
/// those above stay. Continuous in C. A true one is positive: one that is far below 0 is off by at least as
/// much, so that mode may well give way.
///
/// Jacobi's rotations, until what is left off the diagonal is 1e-9 of what is on it; 4 to 6 sweeps met, at
/// most 10 done. Eigen's solver is as fast for 3 to 6 rows, and costs each including file 13 s of gcc 12.
/// Source: [golub2013], 8.5.
template <class M>
void bound_below(M& C, double least) noexcept {
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
    if (!(off > 1e-18 * on)) break;
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
    const double missing = (std::max)(std::abs(A(k, k)), least) - A(k, k);
    if (!(missing > 0)) continue;
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = 0; i < n; ++i) C(i, j) += missing * V(i, k) * V(j, k);
  }
}

/// True when C - least I is positive definite (Sylvester).
[[nodiscard]] inline bool is_bounded_below(const Mat3<double>& C, double least) noexcept {
  const double a = C(0, 0) - least, b = C(1, 1) - least, c = C(2, 2) - least;
  const double minor = a * b - C(1, 0) * C(1, 0);
  const double det =
      c * minor - a * C(2, 1) * C(2, 1) - b * C(2, 0) * C(2, 0) + 2 * C(1, 0) * C(2, 0) * C(2, 1);
  return a > 0 && minor > 0 && det > 0;
}

/// (1 + r^8)^(-1/8), r^2 = size2 / most2 >= 0: what keeps a vector of squared length size2 below most2; 1
/// where it is.
[[nodiscard]] inline double smooth_limit(double size2, double most2) noexcept {
  const double r2 = size2 / (most2 + (std::numeric_limits<double>::min)()), r8 = r2 * r2 * r2 * r2;
  // Most are small, and roots take their time: the series, to the last digit.
  if (r8 < 1e-3) return 1 + r8 * (-1. / 8 + r8 * (9. / 128 + r8 * (-51. / 1024 + r8 * (1275. / 32768))));
  return 1 / std::sqrt(std::sqrt(std::sqrt(1 + r8)));
}

}  // namespace palpate::detail
