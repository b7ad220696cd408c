// SPDX-License-Identifier: MIT
#pragma once

/// @file  Sine and cosine of a register of angles.

#include <palpate/core/lane_polynomial.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <numbers>

namespace palpate::detail {

/// Of angles y, |y| <= pi/2, to 2 ulp of 1. `V`: a register of S, or S. No equation of the paper.
template <Real S, class V>
  requires(!SimdOrReal<V>)
PALPATE_INLINE void sine_and_cosine(const V& y, V& sine, V& cosine) noexcept {
  const V w = y * y - static_cast<S>(std::numbers::pi_v<long double> * std::numbers::pi_v<long double> / 8);
  sine = y * nested_polynomial(w, sine_series<S, 2>);
  cosine = nested_polynomial(w, sine_series<S, 1>);
}

}  // namespace palpate::detail
