// SPDX-License-Identifier: MIT
#pragma once

/// @file  Polynomials of a register of numbers: old names, see polynomial.hpp.

#include <palpate/core/float_vector.hpp>
#include <palpate/core/polynomial.hpp>

namespace palpate::detail {

/// sum_k c_k x^k, where the result is waited for.
template <class V, class S, std::size_t N>
  requires(!SimdOrReal<V>)
[[nodiscard]] PALPATE_INLINE V polynomial(const V& x, const std::array<S, N>& c) noexcept {
  // Two short chains: even and odd powers.
  static_assert(N % 2 == 0);
  const V square = x * x;
  V even = all_of<V>(c[N - 2]), odd = all_of<V>(c[N - 1]);
  for (std::size_t k = N - 2; k > 0; k -= 2) {
    even = even * square + c[k - 2];
    odd = odd * square + c[k - 1];
  }
  return even + x * odd;
}
/// The same where others hide the wait: one product less.
template <class V, class S, std::size_t N>
  requires(!SimdOrReal<V>)
[[nodiscard]] PALPATE_INLINE V nested_polynomial(const V& x, const std::array<S, N>& c) noexcept {
  V sum = all_of<V>(c[N - 1]);
  unrolled<N - 1>([&](std::size_t k) PALPATE_INLINE_LAMBDA { sum = sum * x + c[N - 2 - k]; });
  return sum;
}

}  // namespace palpate::detail
