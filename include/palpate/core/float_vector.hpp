// SPDX-License-Identifier: MIT
#pragma once

/// @file  Floats in one register: the vector extension of gcc and clang, on any processor.
///
/// For what Eigen's arrays have no operation for (shuffles), and where they do not stay in registers at -O2. Eight are passed by
/// reference: how they are returned depends on the host's flags.

#include <palpate/config.hpp>

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace palpate::detail {

using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;
/// As many as a register holds, up to eight.
#if defined(__AVX__)
using FloatRegister [[gnu::vector_size(32)]] = float;
using IntRegister [[gnu::vector_size(32)]] = std::int32_t;
#else
using FloatRegister = Float4;
using IntRegister = Int4;
#endif

template <class V>
PALPATE_INLINE void load(V& to, const float* from) noexcept {
  std::memcpy(&to, from, sizeof to);
}
template <class V>
PALPATE_INLINE void store(float* to, const V& x) noexcept {
  std::memcpy(to, &x, sizeof x);
}
[[nodiscard]] PALPATE_INLINE Float4 load4(const float* from) noexcept {
  Float4 x;
  load(x, from);
  return x;
}

/// (y, z, x, w).
[[nodiscard]] PALPATE_INLINE Float4 rotated(Float4 a) noexcept {
  return __builtin_shufflevector(a, a, 1, 2, 0, 3);
}

/// Rows become columns.
PALPATE_INLINE void transpose(Float4& a, Float4& b, Float4& c, Float4& d) noexcept {
  const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5), cd = __builtin_shufflevector(c, d, 0, 4, 1, 5),
               ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7),
               cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// out = 1 / sqrt(x) for x >= 0 to 4 ulp, finite at 0. `V`: Float4 or FloatRegister. Source: [lomont2003]; Newton steps until
/// rounding.
template <class V>
PALPATE_INLINE void inverse_root(const V& x, V& out) noexcept {
  using Int = std::conditional_t<sizeof(V) == sizeof(Float4), Int4, IntRegister>;
  Int bits;
  std::memcpy(&bits, &x, sizeof x);
  bits = 0x5f375a86 - (bits >> 1);
  std::memcpy(&out, &bits, sizeof x);
  const V half = 0.5f * x;
  out *= 1.5f - half * out * out;
  out *= 1.5f - half * out * out;
  out *= 1.5f - half * out * out;
}

/// Lowers `least`, entry by entry, to those of x, four by four.
template <class V>
PALPATE_INLINE void take_least(Float4& least, const V& x) noexcept {
  Float4 part[sizeof(V) / sizeof(Float4)];
  std::memcpy(part, &x, sizeof x);
  for (const Float4& four : part) least = four < least ? four : least;
}

}  // namespace palpate::detail
