// SPDX-License-Identifier: MIT
#pragma once

/// @file Powers of a register of numbers.
///
/// Why not Eigen's: gcc does not inline its logarithm of a register of floats, so that the formula around it
/// leaves the registers, and it takes 5 times as long as this one; in double its logarithm takes 4 and its
/// exponential 2 times as long (gcc 12, AVX-512). What they look after and this does not: numbers that are
/// zero, negative, infinite or denormal.

#include <palpate/core/lane_polynomial.hpp>
#include <palpate/core/lane_register.hpp>
#include <palpate/core/simd_math.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>

namespace palpate::detail {

/// log2 x, x > 0 normal: x = 2^n m, sqrt(1/2) <= m < sqrt(2), and with t = (m - 1) / (m + 1)
///
///     log2 x = n + (2 / ln 2) (t + t^3 / 3 + t^5 / 5 + ..)
///
/// Anything else gives some number. `V`: a register of S, or S.
template <Real S, class V>
[[nodiscard]] PALPATE_INLINE V log2_of(const V& x) noexcept {
  if constexpr (std::same_as<V, S>) {
    return std::log2(x);
  } else {
    using E = ExponentBits<S>;
    using Bits = LaneBits<S>;
    constexpr auto root_half = std::bit_cast<typename E::Bits>(std::numbers::sqrt2_v<S> / S(2)),
                   one = std::bit_cast<typename E::Bits>(S(1));
    const Bits bits = std::bit_cast<Bits>(x), biased = (bits + (one - root_half)) >> E::mantissa;
    const V m = std::bit_cast<V>(bits - (biased << E::mantissa) + one), t = (m - S(1)) / (m + S(1));
    V n = std::bit_cast<V>(biased | E::whole) - E::shift;
    EIGEN_OPTIMIZATION_BARRIER(n)
    return n + t * polynomial(V(t * t), log2_series<S>);
  }
}

/// 2^x; outside the exponents of normal numbers that of the nearest of them. NaN gives some number.
///
///     2^x = 2^n 2^(x - n), n whole, |x - n| <= 1/2
template <Real S, class V>
[[nodiscard]] PALPATE_INLINE V exp2_of(const V& x) noexcept {
  if constexpr (std::same_as<V, S>) {
    return std::exp2(x);
  } else {
    using E = ExponentBits<S>;
    using Bits = LaneBits<S>;
    const V least = all_of<V>(S(1 - E::bias)), most = all_of<V>(S(E::bias));
    const V at = smaller(larger(x, least), most);
    V rounded = at + E::shift;  // to a whole number
    EIGEN_OPTIMIZATION_BARRIER(rounded)
    V n = rounded - E::shift;
    EIGEN_OPTIMIZATION_BARRIER(n)
    const Bits power = std::bit_cast<Bits>(rounded) << E::mantissa;
    return polynomial(V(at - n), exp2_series<S>) * std::bit_cast<V>(power);
  }
}

/// x^e of x > 0: by products where e is a small whole number, else by logarithm. `V`: a register of S, or S.
template <Real S>
class LanePower {
 public:
  explicit LanePower(S e) noexcept
      : exponent_(e), whole_(e >= S(0) && e <= S(18) && e == std::floor(e) ? static_cast<int>(e) : -1) {}

  template <class V>
  [[nodiscard]] PALPATE_INLINE V of(const V& x) const noexcept {
    return whole_ >= 0 ? product(x) : of(x, log2_of<S>(x));
  }
  /// The same where log2 x is known.
  template <class V>
  [[nodiscard]] PALPATE_INLINE V of(const V& x, const V& log2_x) const noexcept {
    return whole_ >= 0 ? product(x) : exp2_of<S>(V(log2_x * exponent_));
  }

 private:
  template <class V>
  [[nodiscard]] PALPATE_INLINE V product(const V& x) const noexcept {
    V result = all_of<V>(S(1)), square = x;
    for (int k = whole_; k > 0; k /= 2) {
      if (k % 2 == 1) result *= square;
      square *= square;
    }
    return result;
  }

  S exponent_;
  int whole_;  // -1: not a small whole number
};

}  // namespace palpate::detail
