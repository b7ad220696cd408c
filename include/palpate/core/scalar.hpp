// SPDX-License-Identifier: MIT
#pragma once

/// @file  The scalar of a scene, and a finiteness test that the host's flags cannot switch off.

#include <bit>
#include <concepts>
#include <cstdint>
#include <limits>

namespace palpate {

/// float, double or long double.
template <class S>
concept Real = std::floating_point<S>;

namespace detail {
/// double, or long double for long double.
template <Real S>
using Wide = decltype(S{} + double{});
}  // namespace detail

/// True unless x is NaN or infinite. No equation. Tests the exponent's bits, because `std::isfinite` is
/// folded to `true` under -ffast-math, which game engines use, and a NaN must never reach a motor.
template <Real S>
[[nodiscard]] constexpr bool is_finite(S x) noexcept {
  if constexpr (std::same_as<S, float>) {
    return (std::bit_cast<std::uint32_t>(x) & 0x7f800000u) != 0x7f800000u;
  } else if constexpr (sizeof(S) == sizeof(double)) {
    return (std::bit_cast<std::uint64_t>(x) & 0x7ff0000000000000u) != 0x7ff0000000000000u;
  } else {
    return x - x == S(0);  // long double: for reference computations in tests only
  }
}

/// True if x > 0, infinity included; false for NaN. No equation. Tests the bits, because under -ffast-math a
/// comparison with NaN may come out either way.
template <Real S>
[[nodiscard]] constexpr bool is_positive(S x) noexcept {
  if constexpr (std::same_as<S, float>) {
    return std::bit_cast<std::uint32_t>(x) - 1u < 0x7f800000u;
  } else if constexpr (sizeof(S) == sizeof(double)) {
    return std::bit_cast<std::uint64_t>(x) - 1u < 0x7ff0000000000000u;
  } else {
    return x > S(0);  // long double: for reference computations in tests only
  }
}

/// True if |x| <= limit, a finite positive number; false for NaN. No equation. One comparison of the bits,
/// which -ffast-math leaves alone.
template <Real S>
[[nodiscard]] constexpr bool is_within(S x, S limit) noexcept {
  if constexpr (std::same_as<S, float>) {
    return (std::bit_cast<std::uint32_t>(x) & 0x7fffffffu) <= std::bit_cast<std::uint32_t>(limit);
  } else if constexpr (sizeof(S) == sizeof(double)) {
    return (std::bit_cast<std::uint64_t>(x) & 0x7fffffffffffffffu) <= std::bit_cast<std::uint64_t>(limit);
  } else {
    return x >= -limit && x <= limit;  // long double: for reference computations in tests only
  }
}

}  // namespace palpate
