// SPDX-License-Identifier: MIT
#pragma once

/// @file Floats in one register: the vector extension of gcc and clang, on any processor.
///
/// For what Eigen's arrays have no operation for (shuffles), where they do not stay in registers at -O2, and
/// in long formulas: each of Eigen's terms is a type, and gcc takes seconds and gigabytes over thousands of
/// them.

#include <palpate/config.hpp>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE__)
#include <xmmintrin.h>
#else
#include <Eigen/Core>
#endif

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

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
/// As many as the widest register holds, up to sixteen: for short loops over long rows.
#if defined(__AVX512F__)
using WideRegister [[gnu::vector_size(64)]] = float;
using WideBits [[gnu::vector_size(64)]] = std::uint32_t;
#else
using WideRegister = FloatRegister;
using WideBits = BitsRegister;
#endif
/// The bits of a register V.
template <class V>
using BitsOf =
    std::conditional_t<sizeof(V) == sizeof(Float4), Bits4,
                       std::conditional_t<sizeof(V) == sizeof(BitsRegister), BitsRegister, WideBits>>;

/// How many a register V holds, and n of them rounded up to whole registers.
template <class V>
inline constexpr std::uint32_t entries = sizeof(V) / sizeof(float);
template <class V>
[[nodiscard]] constexpr std::size_t whole(std::size_t n) noexcept {
  return (n + entries<V> - 1) / entries<V> * entries<V>;
}

/// work(0) .. work(N - 1), written out: compilers keep short loops at -O2, and their arrays in memory.
template <std::size_t N, class Work>
PALPATE_INLINE void unrolled(const Work& work) noexcept {
  [&]<std::size_t... i>(std::index_sequence<i...>)
      PALPATE_INLINE_LAMBDA { (work(i), ...); }(std::make_index_sequence<N>{});
}

template <class V>
[[nodiscard]] PALPATE_INLINE V load_vector(const void* from) noexcept {
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

/// Rows of four one after the other, `step` numbers apart: x0 y0 z0 0, x1 y1 z1 0, ..
PALPATE_INLINE void store_by_fours(float* to, Float4 x, Float4 y, Float4 z, std::size_t step = 4) noexcept {
  Float4 none{};
  transpose(x, y, z, none);
  store_vector(to, x);
  store_vector(to + step, y);
  store_vector(to + 2 * step, z);
  store_vector(to + 3 * step, none);
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

/// x, y, z of each entry to its own place.
PALPATE_INLINE void store_apart(unsigned char* to0, unsigned char* to1, unsigned char* to2,
                                unsigned char* to3, Float4 x, Float4 y, Float4 z) noexcept {
  const Float4 xy = __builtin_shufflevector(x, y, 0, 4, 1, 5),
               xy_high = __builtin_shufflevector(x, y, 2, 6, 3, 7),
               xy1 = __builtin_shufflevector(xy, xy, 2, 3, 2, 3),
               xy3 = __builtin_shufflevector(xy_high, xy_high, 2, 3, 2, 3);
  const auto store = [](unsigned char* to, const Float4& two, float third) {
    std::memcpy(to, &two, 2 * sizeof(float));
    std::memcpy(to + 2 * sizeof(float), &third, sizeof(float));
  };
  store(to0, xy, z[0]);
  store(to1, xy1, z[1]);
  store(to2, xy_high, z[2]);
  store(to3, xy3, z[3]);
}

/// x in every entry. `V`: a register of S, or S itself.
template <class V, std::floating_point S>
[[nodiscard]] PALPATE_INLINE V all_of(S x) noexcept {
  return x - V{};
}
[[nodiscard]] PALPATE_INLINE Float4 four(float x) noexcept { return all_of<Float4>(x); }
/// Entry by entry; b where one is not a number. Written as instructions: gcc turns a comparison with 0 into
/// masks.
template <std::floating_point S>
[[nodiscard]] constexpr S larger(S a, S b) noexcept {
  return a > b ? a : b;
}
template <std::floating_point S>
[[nodiscard]] constexpr S smaller(S a, S b) noexcept {
  return a < b ? a : b;
}
[[nodiscard]] PALPATE_INLINE Float4 larger(Float4 a, Float4 b) noexcept {
#if defined(__SSE__)
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}
[[nodiscard]] PALPATE_INLINE Float4 smaller(Float4 a, Float4 b) noexcept {
#if defined(__SSE__)
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}
[[nodiscard]] PALPATE_INLINE Float4 root(Float4 a) noexcept {
#if defined(__SSE__)
  return _mm_sqrt_ps(a);
#else
  Eigen::Array4f x;
  std::memcpy(x.data(), &a, sizeof a);
  x = x.sqrt();
  return load_vector<Float4>(x.data());
#endif
}
#if defined(__AVX__)
[[nodiscard]] PALPATE_INLINE FloatRegister larger(FloatRegister a, FloatRegister b) noexcept {
  return _mm256_max_ps(a, b);
}
[[nodiscard]] PALPATE_INLINE FloatRegister smaller(FloatRegister a, FloatRegister b) noexcept {
  return _mm256_min_ps(a, b);
}
[[nodiscard]] PALPATE_INLINE FloatRegister root(FloatRegister a) noexcept { return _mm256_sqrt_ps(a); }
#endif
#if defined(__AVX512F__)
// All entries by a mask: gcc 12 warns of what the plain form leaves undefined.
[[nodiscard]] PALPATE_INLINE WideRegister larger(WideRegister a, WideRegister b) noexcept {
  return _mm512_maskz_max_ps(0xffff, a, b);
}
[[nodiscard]] PALPATE_INLINE WideRegister smaller(WideRegister a, WideRegister b) noexcept {
  return _mm512_maskz_min_ps(0xffff, a, b);
}
#endif
/// `V`: Float4 or FloatRegister.
template <class V>
[[nodiscard]] PALPATE_INLINE V between(const V& a, float least, float most) noexcept {
  return smaller(larger(a, all_of<V>(least)), all_of<V>(most));
}
template <class V>
  requires(!std::floating_point<V>)
[[nodiscard]] PALPATE_INLINE V magnitude(const V& a) noexcept {
  return std::bit_cast<V>(std::bit_cast<BitsOf<V>>(a) & 0x7fffffffu);
}
/// Entries From .. From + 3 of a register.
template <std::size_t From, class V>
[[nodiscard]] PALPATE_INLINE Float4 four_of(const V& x) noexcept {
  return __builtin_shufflevector(x, x, From, From + 1, From + 2, From + 3);
}
/// work(0), work(4) .. up to a register's last four, with constants for four_of.
template <class V, class Work>
PALPATE_INLINE void each_four(const Work& work) noexcept {
  [&]<std::size_t... k>(std::index_sequence<k...>) PALPATE_INLINE_LAMBDA {
    (work(std::integral_constant<std::size_t, 4 * k>{}), ...);
  }(std::make_index_sequence<entries<V> / entries<Float4>>{});
}
[[nodiscard]] PALPATE_INLINE float least_of(Float4 a) noexcept {
  const Float4 two = smaller(a, __builtin_shufflevector(a, a, 2, 3, 0, 1));
  return two[0] < two[1] ? two[0] : two[1];
}

/// The same for wider registers.
template <class V>
  requires(entries<V> > entries<Float4>)
PALPATE_INLINE void store_interleaved(unsigned char* to, const V& x, const V& y, const V& z) noexcept {
  each_four<V>([&](auto from) PALPATE_INLINE_LAMBDA {
    store_interleaved(to + 3 * sizeof(float) * from, four_of<from>(x), four_of<from>(y), four_of<from>(z));
  });
}
#if defined(__AVX512F__)
/// Six permutations of whole registers instead of 24 of quarters.
PALPATE_INLINE void store_interleaved(unsigned char* to, const WideRegister& x, const WideRegister& y,
                                      const WideRegister& z) noexcept {
  // x and y first, z between them.
  const WideRegister xy_first =
                         __builtin_shufflevector(x, y, 0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5),
                     xy_second =
                         __builtin_shufflevector(x, y, 21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26),
                     xy_third = __builtin_shufflevector(x, y, 0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0,
                                                        15, 31, 0);
  store_vector(to, WideRegister(__builtin_shufflevector(xy_first, z, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19,
                                                        12, 13, 20, 15)));
  store_vector(to + sizeof x, WideRegister(__builtin_shufflevector(xy_second, z, 0, 21, 2, 3, 22, 5, 6, 23, 8,
                                                                   9, 24, 11, 12, 25, 14, 15)));
  store_vector(to + 2 * sizeof x, WideRegister(__builtin_shufflevector(xy_third, z, 26, 1, 2, 27, 4, 5, 28, 7,
                                                                       8, 29, 10, 11, 30, 13, 14, 31)));
}
#endif

/// Lowers `least`, entry by entry, to those of x, four by four.
template <class V>
PALPATE_INLINE void take_least(Float4& least, const V& x) noexcept {
  each_four<V>([&](auto from) PALPATE_INLINE_LAMBDA { least = smaller(four_of<from>(x), least); });
}
#if defined(__AVX__)
[[nodiscard]] PALPATE_INLINE float least_of(FloatRegister a) noexcept {
  return least_of(smaller(four_of<0>(a), four_of<4>(a)));
}
#endif

}  // namespace palpate::detail
