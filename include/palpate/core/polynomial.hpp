// SPDX-License-Identifier: MIT
#pragma once

/// @file Polynomials of a number or a Simd; coefficients are made at compile time.

#include <palpate/core/simd.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace palpate::detail {

/// The first N of c, changed so that sum_k c_k x^k stays as near as it can for |x| <= h: each power from the
/// highest on is replaced by lower ones with its Chebyshev polynomial, which is off by c_n h^n / 2^(n - 1) at
/// most.
template <std::size_t N, std::size_t M>
[[nodiscard]] constexpr std::array<long double, N> economised(std::array<long double, M> c,
                                                              long double h) noexcept {
  for (std::size_t n = M - 1; n >= N; --n) {
    std::array<long double, M> before{1}, T{0, 1};  // of x / h
    long double leading = 1 / h;                    // coefficient of x^n
    for (std::size_t k = 1; k < n; ++k) {
      std::array<long double, M> next{};
      for (std::size_t i = 0; i < n; ++i) next[i + 1] = 2 * T[i];
      for (std::size_t i = 0; i < n; ++i) next[i] -= before[i];
      before = T, T = next, leading *= 2 / h;
    }
    long double scale = c[n] / leading;
    for (std::size_t i = 0; i <= n; ++i, scale /= h) c[i] -= scale * T[i];
  }
  std::array<long double, N> first{};
  for (std::size_t k = 0; k < N; ++k) first[k] = c[k];
  return first;
}

/// The same numbers in type S.
template <class S, std::size_t N>
[[nodiscard]] constexpr std::array<S, N> rounded(const std::array<long double, N>& c) noexcept {
  std::array<S, N> result{};
  for (std::size_t k = 0; k < N; ++k) result[k] = static_cast<S>(c[k]);
  return result;
}

/// sum_k c_k x^k, where the result is waited for: two short chains, of even and of odd powers.
template <SimdOrReal V, std::size_t N>
[[nodiscard]] PALPATE_INLINE V polynomial(const V& x, const std::array<ValueOf<V>, N>& c) noexcept {
  static_assert(N % 2 == 0);
  const V square = x * x;
  V even = c[N - 2], odd = c[N - 1];
  for (std::size_t k = N - 2; k > 0; k -= 2) {
    even = even * square + c[k - 2];
    odd = odd * square + c[k - 1];
  }
  return even + x * odd;
}
/// The same by Horner's rule, where others hide the wait: one product less.
template <SimdOrReal V, std::size_t N>
[[nodiscard]] PALPATE_INLINE V nested_polynomial(const V& x, const std::array<ValueOf<V>, N>& c) noexcept {
  V sum = c[N - 1];
  [&]<std::size_t... k>(std::index_sequence<k...>)
      PALPATE_INLINE_LAMBDA { ((sum = sum * x + c[N - 2 - k]), ...); }(std::make_index_sequence<N - 1>{});
  return sum;
}

}  // namespace palpate::detail
