// SPDX-License-Identifier: MIT
#pragma once

/// @file  1 / sqrt(x) in a few products, of a scalar or of a register.

#include <palpate/core/lane_register.hpp>

#include <bit>
#include <type_traits>

namespace palpate::detail {

/// 1 / sqrt(x) within 3.5 %, by the bits. `V`: float, double or a register. Source: [lomont2003].
template <class V>
[[nodiscard]] PALPATE_INLINE V inverse_root_guess(const V& x) noexcept {
  constexpr bool is_double = std::same_as<EntryOf<V>, double>;
  using Word = std::conditional_t<is_double, std::uint64_t, std::uint32_t>;
  using Bits = std::conditional_t<std::is_floating_point_v<V>, Word,
                                  std::conditional_t<is_double, DoubleBits, BitsOf<V>>>;
  constexpr Word start = is_double ? Word(0x5fe6ec85e7de30da) : Word(0x5f375a86);
  return std::bit_cast<V>(Bits(start - (std::bit_cast<Bits>(x) >> 1)));
}

/// 1 / sqrt(x) for x >= 0 to 4 ulp, finite at 0. `V`: float, double, a register or a group of them. std::sqrt
/// may have to set errno, and then loops do not vectorise. Newton steps and one of third order until
/// rounding.
template <class V>
[[nodiscard]] PALPATE_INLINE V inverse_root(const V& x) noexcept {
  using S = EntryOf<V>;
  const V half = S(0.5) * x;
  V y = inverse_root_guess(x);
  y = y * (S(1.5) - half * y * y);
  if constexpr (std::same_as<S, double>) y = y * (S(1.5) - half * y * y);
  const V e = S(0.5) - half * y * y;
  return y + y * e * (S(1) + S(1.5) * e);
}

}  // namespace palpate::detail
