// SPDX-License-Identifier: MIT
#pragma once

/// @file  Small symmetric positive definite systems on the stack, in double, for the servo tick and for
/// set-up: a fixed size of Eigen's LDLT costs a compiler some seconds.

#include <algorithm>
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
  /// The lower triangle of an N x N matrix.
  void set(const auto& matrix) noexcept {
    for (std::size_t r = 0; r < N; ++r)
      for (std::size_t c = 0; c <= r; ++c) at(r, c) = matrix(static_cast<int>(r), static_cast<int>(c));
  }

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
  /// The least pivot over the largest, by which a singular N x N matrix shows; after `factor`.
  [[nodiscard]] double pivot_ratio() noexcept {
    double least = at(0, 0), most = least;
    for (std::size_t j = 1; j < N; ++j)
      least = (std::min)(least, at(j, j)), most = (std::max)(most, at(j, j));
    return least * least / (most * most);
  }
  /// `matrix` becomes the N x N inverse; after `factor`.
  void invert(auto& matrix) noexcept {
    for (std::size_t c = 0; c < N; ++c) {
      b.fill(0);
      b[c] = 1;
      substitute(N);
      for (std::size_t r = 0; r < N; ++r) matrix(static_cast<int>(r), static_cast<int>(c)) = b[r];
    }
  }
};

}  // namespace palpate::detail
