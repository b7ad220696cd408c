// SPDX-License-Identifier: MIT
#pragma once

/// @file Inverse roots, powers, sines and cosines of a number or a Simd.
///
/// Why not Eigen's: gcc does not inline its logarithm of a register of floats, so that the formula around it
/// leaves the registers, and it takes 5 times as long as this one; in double its logarithm takes 4 and its
/// exponential 2 times as long (gcc 12, AVX-512). What they look after and these do not: numbers that are
/// zero, negative, infinite or denormal.

#include <palpate/core/polynomial.hpp>
#include <palpate/core/simd.hpp>

#include <Eigen/Core>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <type_traits>

namespace palpate::detail {

/// -ffast-math must not look through it.
template <SimdOrReal V>
PALPATE_INLINE void optimization_barrier(V& x) noexcept {
  if constexpr (Real<V>)
    EIGEN_OPTIMIZATION_BARRIER(x)
  else
    for (auto& part : x.native) EIGEN_OPTIMIZATION_BARRIER(part)
}

/// 1 / sqrt(x) within 3.5 %, by the bits. Source: [lomont2003].
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V inverse_sqrt_guess(const V& x) noexcept {
  using T = ValueOf<V>;
  using Word = WordOf<T>;
  using Bits = WordsOf<V>;
  constexpr Word start = sizeof(T) == 4 ? Word(0x5f375a86) : Word(0x5fe6ec85e7de30da);
  return std::bit_cast<V>(Bits(start - (std::bit_cast<Bits>(x) >> 1)));
}

/// 1 / sqrt(x) for x >= 0 to 4 ulp, finite at 0: Newton steps and one of third order until rounding. float or
/// double. std::sqrt may have to set errno, and then loops do not vectorise.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V inverse_sqrt(const V& x) noexcept {
  using T = ValueOf<V>;
  const V half = T(0.5) * x;
  V y = inverse_sqrt_guess(x);
  y = y * (T(1.5) - half * y * y);
  if constexpr (std::same_as<T, double>) y = y * (T(1.5) - half * y * y);
  const V e = T(0.5) - half * y * y;
  return y + y * e * (T(1) + T(1.5) * e);
}

/// How a number lies in memory: exponent plus `bias`, then `mantissa` bits. A whole number n added to `shift`
/// is n + bias in the lowest of them. (-ffast-math would take such a sum apart: hence the barriers.)
template <Real S>
struct ExponentBits {
  using Bits = std::conditional_t<std::same_as<S, float>, std::uint32_t, std::uint64_t>;
  static constexpr int mantissa = std::numeric_limits<S>::digits - 1;
  static constexpr int bias = std::numeric_limits<S>::max_exponent - 1;
  static constexpr Bits whole = Bits{bias + mantissa} << mantissa;  // of 2^mantissa
  static constexpr S shift = std::bit_cast<S>(whole) + S(bias);
};

/// log2((1 + t) / (1 - t)) / t as a polynomial in t^2, for numbers between sqrt(1/2) and sqrt(2).
template <Real S>
inline constexpr auto log2_series = [] {
  constexpr std::size_t terms = std::same_as<S, float> ? 4 : 8;  // what is left out: below 1e-9, 2e-18
  std::array<long double, 2 * terms + 9> taylor{};
  for (std::size_t k = 0; k < taylor.size(); k += 2)
    taylor[k] = 2 * std::numbers::log2e_v<long double> / static_cast<long double>(k + 1);
  const auto best = economised<2 * terms - 1>(taylor, 0.1716L);  // (sqrt(2) - 1) / (sqrt(2) + 1)
  std::array<S, terms> c{};
  for (std::size_t k = 0; k < terms; ++k) c[k] = static_cast<S>(best[2 * k]);
  return c;
}();

/// 2^x for |x| <= 1/2.
template <Real S>
inline constexpr auto exp2_series = [] {
  constexpr std::size_t terms = std::same_as<S, float> ? 8 : 12;  // what is left out: below 1e-10, 5e-18
  std::array<long double, terms + 6> taylor{1};
  for (std::size_t k = 1; k < taylor.size(); ++k)
    taylor[k] = taylor[k - 1] * std::numbers::ln2_v<long double> / static_cast<long double>(k);
  return rounded<S>(economised<terms>(taylor, 0.5L));
}();

/// log2 x, x > 0 normal: x = 2^n m, sqrt(1/2) <= m < sqrt(2), and with t = (m - 1) / (m + 1)
///
///     log2 x = n + (2 / ln 2) (t + t^3 / 3 + t^5 / 5 + ..)
///
/// Anything else gives some number.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V log2(const V& x) noexcept {
  if constexpr (Real<V>) {
    return std::log2(x);
  } else {
    using T = ValueOf<V>;
    using E = ExponentBits<T>;
    using Bits = WordsOf<V>;
    constexpr auto root_half = std::bit_cast<typename E::Bits>(std::numbers::sqrt2_v<T> / T(2)),
                   one = std::bit_cast<typename E::Bits>(T(1));
    const Bits bits = std::bit_cast<Bits>(x), biased = (bits + (one - root_half)) >> E::mantissa;
    const V m = std::bit_cast<V>(bits - (biased << E::mantissa) + one), t = (m - T(1)) / (m + T(1));
    V n = std::bit_cast<V>(biased | E::whole) - E::shift;
    optimization_barrier(n);
    return n + t * polynomial(t * t, log2_series<T>);
  }
}

/// 2^x; outside the exponents of normal numbers that of the nearest of them. NaN gives some number.
///
///     2^x = 2^n 2^(x - n), n whole, |x - n| <= 1/2
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V exp2(const V& x) noexcept {
  if constexpr (Real<V>) {
    return std::exp2(x);
  } else {
    using T = ValueOf<V>;
    using E = ExponentBits<T>;
    using Bits = WordsOf<V>;
    const V at = clamp(x, T(1 - E::bias), T(E::bias));
    V rounded = at + E::shift;  // to a whole number
    optimization_barrier(rounded);
    V n = rounded - E::shift;
    optimization_barrier(n);
    const Bits power = std::bit_cast<Bits>(rounded) << E::mantissa;
    return polynomial(at - n, exp2_series<T>) * std::bit_cast<V>(power);
  }
}

/// x^e of x > 0: by products where e is a small whole number, else by logarithm.
template <Real T>
class Power {
 public:
  explicit Power(T e) noexcept
      : exponent_(e), whole_(e >= T(0) && e <= T(18) && e == std::floor(e) ? static_cast<int>(e) : -1) {}

  template <SimdOrReal V>
  [[nodiscard]] PALPATE_INLINE V operator()(const V& x) const noexcept {
    return whole_ >= 0 ? product(x) : exp2(log2(x) * exponent_);
  }
  /// The same where log2 x is known.
  template <SimdOrReal V>
  [[nodiscard]] PALPATE_INLINE V operator()(const V& x, const V& log2_x) const noexcept {
    return whole_ >= 0 ? product(x) : exp2(log2_x * exponent_);
  }

 private:
  template <SimdOrReal V>
  [[nodiscard]] PALPATE_INLINE V product(const V& x) const noexcept {
    V result = T(1), square = x;
    for (int k = whole_; k > 0; k /= 2) {
      if (k % 2 == 1) result *= square;
      square *= square;
    }
    return result;
  }

  T exponent_;
  int whole_;  // -1: not a small whole number
};

/// cos y (K = 1) or (sin y) / y (K = 2) for |y| <= pi/2 as a polynomial in y^2 - pi^2 / 8: Taylor's series in
/// y^2
///
///     sum_k (-1)^k y^(2k) / (K (K+1) .. (K+2k-1))
///
/// about the middle, economised. What is left out: below 3e-10 and 5e-9 in float, 4e-18 in double.
template <Real S, std::size_t K>
inline constexpr auto sine_series = [] {
  constexpr std::size_t terms = !std::same_as<S, float> ? 9 : K == 1 ? 6 : 5;
  constexpr long double middle = std::numbers::pi_v<long double> * std::numbers::pi_v<long double> / 8;
  std::array<long double, terms + 5> taylor{1}, about_middle{};
  for (std::size_t k = 1; k < taylor.size(); ++k)
    taylor[k] = -taylor[k - 1] / static_cast<long double>((K + 2 * k - 2) * (K + 2 * k - 1));
  for (std::size_t k = taylor.size(); k-- > 0;) {  // times (middle + w), plus the next one
    for (std::size_t i = taylor.size() - 1; i > 0; --i)
      about_middle[i] = about_middle[i] * middle + about_middle[i - 1];
    about_middle[0] = about_middle[0] * middle + taylor[k];
  }
  return rounded<S>(economised<terms>(about_middle, middle));
}();

/// Sine and cosine of angles y, |y| <= pi/2, to 2 ulp of 1.
template <SimdOrReal V>
PALPATE_INLINE void sine_and_cosine(const V& y, V& sine, V& cosine) noexcept {
  using T = ValueOf<V>;
  const V w = y * y - static_cast<T>(std::numbers::pi_v<long double> * std::numbers::pi_v<long double> / 8);
  sine = y * nested_polynomial(w, sine_series<T, 2>);
  cosine = nested_polynomial(w, sine_series<T, 1>);
}

}  // namespace palpate::detail
