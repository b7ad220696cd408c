// SPDX-License-Identifier: MIT
#pragma once

/// @file  Floats in one register: the vector extension of gcc and clang, on any processor.
///
/// For what Eigen's arrays have no operation for (shuffles), and where they do not stay in registers at -O2.

#include <palpate/config.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace palpate::detail {

using Float4 [[gnu::vector_size(16)]] = float;
using Bits4 [[gnu::vector_size(16)]] = std::uint32_t;
/// As many as a register holds, up to eight.
#if defined(__AVX__)
using FloatRegister [[gnu::vector_size(32)]] = float;
using BitsRegister [[gnu::vector_size(32)]] = std::uint32_t;
#else
using FloatRegister = Float4;
using BitsRegister = Bits4;
#endif

template <class V>
[[nodiscard]] PALPATE_INLINE V load_vector(const float* from) noexcept {
  V x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <class V>
PALPATE_INLINE void store_vector(void* to, const V& x) noexcept {
  std::memcpy(to, &x, sizeof x);
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

/// Rows one after the other: x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3.
PALPATE_INLINE void store_interleaved(unsigned char* to, Float4 x, Float4 y, Float4 z) noexcept {
  const Float4 xy = __builtin_shufflevector(x, y, 0, 4, 1, 5), zx = __builtin_shufflevector(z, x, 0, 5, 2, 7),
               yz = __builtin_shufflevector(y, z, 1, 5, 3, 7),
               xy_high = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  store_vector(to, Float4(__builtin_shufflevector(xy, zx, 0, 1, 4, 5)));
  store_vector(to + sizeof x, Float4(__builtin_shufflevector(yz, xy_high, 0, 1, 4, 5)));
  store_vector(to + 2 * sizeof x, Float4(__builtin_shufflevector(zx, yz, 2, 3, 6, 7)));
}

/// Entries from, from + 1, .. of a register.
template <class V>
[[nodiscard]] PALPATE_INLINE Float4 four_of(const V& x, std::size_t from) noexcept {
  return load_vector<Float4>(reinterpret_cast<const float*>(&x) + from);
}
/// Lowers `least`, entry by entry, to those of x, four by four.
template <class V>
PALPATE_INLINE void take_least(Float4& least, const V& x) noexcept {
  for (std::size_t from = 0; from < sizeof(V) / sizeof(float); from += 4) {
    const Float4 four = four_of(x, from);
    least = four < least ? four : least;
  }
}

}  // namespace palpate::detail
