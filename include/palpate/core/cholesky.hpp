// SPDX-License-Identifier: MIT
#pragma once

/// @file  Small symmetric positive definite systems on the stack, in double, for the servo tick.

#include <array>
#include <cmath>
#include <cstddef>

namespace palpate::detail {

/// K x = b with K symmetric positive definite, up to N x N. Fill the lower triangle and b, then `solve`; for
/// more right sides fill b and `substitute` again.
template <std::size_t N>
struct SpdSystem {
  std::array<double, N * N> k;  // row major; only the lower triangle is read, and becomes the factor
  std::array<double, N> b;      // right side; the solution after solve()

  [[nodiscard]] double& at(std::size_t row, std::size_t column) noexcept { return k[row * N + column]; }

  /// Cholesky, n <= N. False, with b undefined, when a pivot is not positive: only rounding or NaN can do
  /// that.
  [[nodiscard]] bool solve(std::size_t n) noexcept {
    if (!factor(n)) return false;
    substitute(n);
    return true;
  }
  /// K = L L^T; false, and then not done, when a pivot is not positive.
  [[nodiscard]] bool factor(std::size_t n) noexcept {
    for (std::size_t j = 0; j < n; ++j) {
      double pivot = at(j, j);
      for (std::size_t m = 0; m < j; ++m) pivot -= at(j, m) * at(j, m);
      if (!(pivot > 0)) return false;
      const double root = std::sqrt(pivot);
      at(j, j) = root;
      for (std::size_t i = j + 1; i < n; ++i) {
        double sum = at(i, j);
        for (std::size_t m = 0; m < j; ++m) sum -= at(i, m) * at(j, m);
        at(i, j) = sum / root;
      }
    }
    return true;
  }
  /// b becomes the solution; after `factor`.
  void substitute(std::size_t n) noexcept {
    for (std::size_t j = 0; j < n; ++j) {
      double sum = b[j];
      for (std::size_t m = 0; m < j; ++m) sum -= at(j, m) * b[m];
      b[j] = sum / at(j, j);
    }
    for (std::size_t j = n; j-- > 0;) {
      double sum = b[j];
      for (std::size_t m = j + 1; m < n; ++m) sum -= at(m, j) * b[m];
      b[j] = sum / at(j, j);
    }
  }
};

}  // namespace palpate::detail
