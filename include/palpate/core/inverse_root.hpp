// SPDX-License-Identifier: MIT
#pragma once

/// @file  1 / sqrt(x) in a few products, of a scalar or of a register.

#include <palpate/core/float_vector.hpp>

#include <bit>
#include <type_traits>

namespace palpate::detail {

/// 1 / sqrt(x) for x >= 0 to 4 ulp, finite at 0. `V`: float, double or a register. std::sqrt may have to set errno, and
/// then loops do not vectorise. Source: [lomont2003]; after it 2e-3, Newton steps and one of third order until rounding.
template <class V>
[[nodiscard]] PALPATE_INLINE V inverse_root(const V& x) noexcept {
  constexpr bool is_double = std::is_same_v<V, double>;
  using S = std::conditional_t<is_double, double, float>;
  using Word = std::conditional_t<is_double, std::uint64_t, std::uint32_t>;
  using Bits = std::conditional_t<std::is_floating_point_v<V>, Word, BitsOf<V>>;
  constexpr Word start = is_double ? Word(0x5fe6ec85e7de30da) : Word(0x5f375a86);
  V y = std::bit_cast<V>(Bits(start - (std::bit_cast<Bits>(x) >> 1)));
  const V half = S(0.5) * x;
  y *= S(1.5) - half * y * y;
  if constexpr (is_double) y *= S(1.5) - half * y * y;
  const V e = S(0.5) - half * y * y;
  y += y * e * (S(1) + S(1.5) * e);
  return y;
}

}  // namespace palpate::detail
