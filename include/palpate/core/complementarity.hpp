// SPDX-License-Identifier: MIT
#pragma once

/// @file Linear complementarity problems on the stack, in double, for the servo tick: unilateral contact.

#include <palpate/core/cholesky.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::detail {

/// Finds x >= 0 with M x - q >= 0 and x.(M x - q) = 0 for a symmetric positive definite M of n rows, n <= N,
/// where it is the one minimum of x.M x/2 - q.x over x >= 0. `M(i, j)` is asked for j <= i.
///
/// Block pivoting: all rows on the wrong side change sides at once; where that has not made them fewer three
/// times in a row, the last of them alone, which ends for every such M. Hardly ever more than five rounds; at
/// most 2 n + 8. x depends on M and q alone and is continuous in them, to 1e-12 of the largest q. False where
/// M is not positive definite or not finite, or the rounds were not enough: x is then >= 0 and no more.
/// Sources: [murty1974], [kostreva1978].
template <std::size_t N, class Matrix>
[[nodiscard]] inline bool solve_complementarity(const Matrix& M, const std::array<double, N>& q,
                                                std::size_t n, std::array<double, N>& x) noexcept {
  static_assert(N <= 256);
  constexpr int blocks_without_gain = 3;
  double largest = 0;
  std::array<bool, N> is_free;  // x_i > 0
  for (std::size_t i = 0; i < n; ++i) {
    largest = (std::max)(largest, q[i]);
    is_free[i] = q[i] > 0;
  }
  const double tolerance = 1e-12 * largest;
  const auto entry = [&M](std::size_t i, std::size_t j) { return i < j ? M(j, i) : M(i, j); };
  SpdSystem<N> system;
  std::array<std::uint8_t, N> row;  // of M, by row of the system
  std::size_t fewest = n + 1;
  int blocks = blocks_without_gain;
  bool solved = false;
  for (std::size_t round = 0; round < 2 * n + 8; ++round) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      x[i] = 0;
      if (is_free[i]) row[size++] = static_cast<std::uint8_t>(i);
    }
    for (std::size_t a = 0; a < size; ++a) {
      for (std::size_t b = 0; b <= a; ++b) system.at(a, b) = M(row[a], row[b]);
      system.b[a] = q[row[a]];
    }
    if (!system.solve(size)) break;
    for (std::size_t a = 0; a < size; ++a) x[row[a]] = system.b[a];

    std::array<bool, N> is_wrong;
    std::size_t wrong = 0, last = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double side = x[i];
      if (!is_free[i]) {
        side = -q[i];
        for (std::size_t a = 0; a < size; ++a) side += entry(i, row[a]) * x[row[a]];
      }
      is_wrong[i] = !(side >= -tolerance);
      if (is_wrong[i]) ++wrong, last = i;
    }
    if (wrong == 0) {
      solved = true;
      break;
    }
    const bool all = wrong < fewest || blocks > 0;
    blocks = wrong < fewest ? blocks_without_gain : blocks - 1;
    fewest = (std::min)(fewest, wrong);
    for (std::size_t i = 0; i < n; ++i) {
      if (is_wrong[i] && (all || i == last)) is_free[i] = !is_free[i];
    }
  }
  for (std::size_t i = 0; i < n; ++i) x[i] = x[i] > 0 ? x[i] : 0;
  return solved;
}

}  // namespace palpate::detail
