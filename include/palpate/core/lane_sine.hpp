// SPDX-License-Identifier: MIT
#pragma once

/// @file  Sine and cosine of a register of angles.

#include <palpate/core/lane_polynomial.hpp>
#include <palpate/core/scalar.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace palpate::detail {

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

/// Of angles y, |y| <= pi/2, to 2 ulp of 1. `V`: a register of S, or S. No equation of the paper.
template <Real S, class V>
PALPATE_INLINE void sine_and_cosine(const V& y, V& sine, V& cosine) noexcept {
  const V w = y * y - static_cast<S>(std::numbers::pi_v<long double> * std::numbers::pi_v<long double> / 8);
  sine = y * nested_polynomial(w, sine_series<S, 2>);
  cosine = nested_polynomial(w, sine_series<S, 1>);
}

}  // namespace palpate::detail
