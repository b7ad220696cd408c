// SPDX-License-Identifier: MIT
#pragma once

/// @file Entries of registers in another order: conversions, parts, rows and columns, interleaved stores.

#include <palpate/core/simd.hpp>

#include <limits>

namespace palpate::detail {

/// The same numbers as U.
template <Real U, class T, int N, class R>
[[nodiscard]] PALPATE_INLINE Simd<U, N> simd_cast(const Simd<T, N, R>& x) noexcept {
  using To = Simd<U, N>;
  constexpr std::size_t n = (std::max)(register_size<R>, register_size<typename To::register_type>);
  T from[To::size()];
  U to[To::size()];
  x.copy_to(from);
  [&]<std::size_t... k>(std::index_sequence<k...>) PALPATE_INLINE_LAMBDA {
    const auto convert = [&](std::size_t i) PALPATE_INLINE_LAMBDA {
      if constexpr (n == 1) {
        to[i] = static_cast<U>(from[i]);
      } else {
        typename VectorOf<T, n * sizeof(T)>::Type wide;
        std::memcpy(&wide, from + i, sizeof wide);
        const auto part = __builtin_convertvector(wide, typename VectorOf<U, n * sizeof(U)>::Type);
        std::memcpy(to + i, &part, sizeof part);
      }
    };
    (convert(k * n), ...);
  }(std::make_index_sequence<static_cast<std::size_t>(N) / n>{});
  return To(to);
}

/// Entries first .. first + M - 1 of x. Precondition: they lie in one register.
template <int M, std::size_t first, class T, int N, class R>
[[nodiscard]] PALPATE_INLINE Simd<T, M> chunk(const Simd<T, N, R>& x) noexcept {
  Simd<T, M> result;
  result.native[0] = register_slice<first % register_size<R>, static_cast<std::size_t>(M)>(
      x.native[first / register_size<R>]);
  return result;
}
/// f(first, chunk<M, first>(x)) for first = 0, M, 2 M .., a constant.
template <int M, class T, int N, class R, class F>
PALPATE_INLINE void for_each_chunk(const Simd<T, N, R>& x, const F& f) noexcept {
  [&]<std::size_t... k>(std::index_sequence<k...>) PALPATE_INLINE_LAMBDA {
    (f(std::integral_constant<std::size_t, k * M>{}, chunk<M, k * M>(x)), ...);
  }(std::make_index_sequence<static_cast<std::size_t>(N / M)>{});
}

/// Four floats: one register of every processor.
using Simd4 = Simd<float, 4>;

/// Entries of a, or from 4 on of b, by number.
template <int i0, int i1, int i2, int i3>
[[nodiscard]] PALPATE_INLINE Simd4 shuffle(const Simd4& a, const Simd4& b) noexcept {
  Simd4 result;
  result.native[0] = __builtin_shufflevector(a.native[0], b.native[0], i0, i1, i2, i3);
  return result;
}
/// (y, z, x, w).
[[nodiscard]] PALPATE_INLINE Simd4 rotated(const Simd4& a) noexcept { return shuffle<1, 2, 0, 3>(a, a); }

/// Rows become columns.
PALPATE_INLINE void transpose(Simd4& a, Simd4& b, Simd4& c, Simd4& d) noexcept {
  const Simd4 ab = shuffle<0, 4, 1, 5>(a, b), cd = shuffle<0, 4, 1, 5>(c, d),
              ab_high = shuffle<2, 6, 3, 7>(a, b), cd_high = shuffle<2, 6, 3, 7>(c, d);
  a = shuffle<0, 1, 4, 5>(ab, cd);
  b = shuffle<2, 3, 6, 7>(ab, cd);
  c = shuffle<0, 1, 4, 5>(ab_high, cd_high);
  d = shuffle<2, 3, 6, 7>(ab_high, cd_high);
}

/// Rows of four one after the other, `step` numbers apart: x0 y0 z0 0, x1 y1 z1 0, ..
PALPATE_INLINE void store_by_fours(float* to, Simd4 x, Simd4 y, Simd4 z, std::size_t step = 4) noexcept {
  Simd4 none{};
  transpose(x, y, z, none);
  x.copy_to(to);
  y.copy_to(to + step);
  z.copy_to(to + 2 * step);
  none.copy_to(to + 3 * step);
}

/// To bytes, wherever they lie.
template <class T, int N, class R>
PALPATE_INLINE void store_bytes(unsigned char* to, const Simd<T, N, R>& x) noexcept {
  std::memcpy(to, &x, sizeof x);
}
/// Rows one after the other: x0 y0 z0 x1, y1 z1 x2 y2, z2 x3 y3 z3.
PALPATE_INLINE void store_interleaved(unsigned char* to, const Simd4& x, const Simd4& y,
                                      const Simd4& z) noexcept {
  const Simd4 xy = shuffle<0, 4, 1, 5>(x, y), zx = shuffle<0, 5, 2, 7>(z, x), yz = shuffle<1, 5, 3, 7>(y, z),
              xy_high = shuffle<2, 6, 3, 7>(x, y);
  store_bytes(to, shuffle<0, 1, 4, 5>(xy, zx));
  store_bytes(to + sizeof x, shuffle<0, 1, 4, 5>(yz, xy_high));
  store_bytes(to + 2 * sizeof x, shuffle<2, 3, 6, 7>(zx, yz));
}
/// The same of more than four, four by four.
template <int N, class R>
  requires(N > 4)
PALPATE_INLINE void store_interleaved(unsigned char* to, const Simd<float, N, R>& x,
                                      const Simd<float, N, R>& y, const Simd<float, N, R>& z) noexcept {
#if defined(__AVX512F__)
  if constexpr (N == 16) {
    // Six permutations of whole registers instead of 24 of quarters: x and y first, z between them.
    const R &a = x.native[0], &b = y.native[0], &c = z.native[0];
    const R ab_first = __builtin_shufflevector(a, b, 0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5),
            ab_second = __builtin_shufflevector(a, b, 21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26),
            ab_third =
                __builtin_shufflevector(a, b, 0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
    const R first =
                __builtin_shufflevector(ab_first, c, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15),
            second = __builtin_shufflevector(ab_second, c, 0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25,
                                             14, 15),
            third = __builtin_shufflevector(ab_third, c, 26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14,
                                            31);
    std::memcpy(to, &first, sizeof first);
    std::memcpy(to + sizeof first, &second, sizeof second);
    std::memcpy(to + 2 * sizeof first, &third, sizeof third);
    return;
  }
#endif
  for_each_chunk<4>(x, [&](auto from, const Simd4& part) PALPATE_INLINE_LAMBDA {
    store_interleaved(to + 3 * sizeof(float) * from, part, chunk<4, from>(y), chunk<4, from>(z));
  });
}

/// x, y, z of each entry to its own address.
PALPATE_INLINE void store_apart(unsigned char* to0, unsigned char* to1, unsigned char* to2,
                                unsigned char* to3, const Simd4& x, const Simd4& y, const Simd4& z) noexcept {
  const Simd4 xy = shuffle<0, 4, 1, 5>(x, y), xy_high = shuffle<2, 6, 3, 7>(x, y),
              xy1 = shuffle<2, 3, 2, 3>(xy, xy), xy3 = shuffle<2, 3, 2, 3>(xy_high, xy_high);
  const auto store = [](unsigned char* to, const Simd4& two, float third) {
    std::memcpy(to, &two, 2 * sizeof(float));
    std::memcpy(to + 2 * sizeof(float), &third, sizeof(float));
  };
  store(to0, xy, z[0]);
  store(to1, xy1, z[1]);
  store(to2, xy_high, z[2]);
  store(to3, xy3, z[3]);
}

}  // namespace palpate::detail
