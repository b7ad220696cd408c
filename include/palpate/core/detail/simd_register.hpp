// SPDX-License-Identifier: MIT
#pragma once

/// @file Vector registers as gcc and clang know them (vector_size), and what those need instructions for.
/// Used by simd.hpp alone.

#include <palpate/config.hpp>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE4_1__)
#include <smmintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace palpate::detail {

#if defined(__AVX512F__)
inline constexpr std::size_t native_bytes = 64;
#elif defined(__AVX__)
inline constexpr std::size_t native_bytes = 32;
#else
inline constexpr std::size_t native_bytes = 16;
#endif

/// Bytes of the widest register that N numbers fill without a rest; those of one number if none does. long
/// double has no registers.
template <class T, int N>
[[nodiscard]] constexpr std::size_t register_bytes() noexcept {
  if constexpr (sizeof(T) <= 8)
    for (std::size_t bytes = native_bytes; bytes >= 16; bytes /= 2)
      if (static_cast<std::size_t>(N) % (bytes / sizeof(T)) == 0) return bytes;
  return sizeof(T);
}
template <class T, std::size_t bytes>
struct VectorOf {
  using Type [[gnu::vector_size(bytes)]] = T;
};
template <class T, std::size_t bytes>
  requires(bytes == sizeof(T))
struct VectorOf<T, bytes> {
  using Type = T;
};
template <class T, int N>
using RegisterFor = typename VectorOf<T, register_bytes<T, N>()>::Type;

/// What a register's entries are.
template <class V>
[[nodiscard]] constexpr auto entry_of(const V& x) noexcept {
  if constexpr (std::is_arithmetic_v<V>)
    return x;
  else
    return x[0];
}
template <class V>
using RegisterEntry = decltype(entry_of(std::declval<V>()));
template <class V>
inline constexpr std::size_t register_size = sizeof(V) / sizeof(RegisterEntry<V>);
/// What a comparison of two V gives: a mask, or bool of numbers.
template <class V>
using MaskOf = decltype(std::declval<V>() < std::declval<V>());

template <class V>
[[nodiscard]] PALPATE_INLINE V load_native(const RegisterEntry<V>* from) noexcept {
  V x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <class V>
[[nodiscard]] PALPATE_INLINE V broadcast(RegisterEntry<V> x) noexcept {
  return x - V{};
}

/// a > b ? a : b, which gcc turns into masks where b is 0. AVX-512: all entries by a mask, because gcc 12
/// warns of what the plain form leaves undefined.
template <class V>
[[nodiscard]] PALPATE_INLINE V register_max(const V& a, const V& b) noexcept {
  using T = RegisterEntry<V>;
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && std::same_as<T, float>) return _mm512_maskz_max_ps(0xffff, a, b);
  if constexpr (sizeof(V) == 64 && std::same_as<T, double>) return _mm512_maskz_max_pd(0xff, a, b);
#endif
#if defined(__AVX__)
  if constexpr (sizeof(V) == 32 && std::same_as<T, float>) return _mm256_max_ps(a, b);
  if constexpr (sizeof(V) == 32 && std::same_as<T, double>) return _mm256_max_pd(a, b);
#endif
#if defined(__SSE2__)
  if constexpr (register_size<V> == 4 && std::same_as<T, float>) return _mm_max_ps(a, b);
  if constexpr (register_size<V> == 2 && std::same_as<T, double>) return _mm_max_pd(a, b);
#endif
  return a > b ? a : b;
}
/// a < b ? a : b.
template <class V>
[[nodiscard]] PALPATE_INLINE V register_min(const V& a, const V& b) noexcept {
  using T = RegisterEntry<V>;
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64 && std::same_as<T, float>) return _mm512_maskz_min_ps(0xffff, a, b);
  if constexpr (sizeof(V) == 64 && std::same_as<T, double>) return _mm512_maskz_min_pd(0xff, a, b);
#endif
#if defined(__AVX__)
  if constexpr (sizeof(V) == 32 && std::same_as<T, float>) return _mm256_min_ps(a, b);
  if constexpr (sizeof(V) == 32 && std::same_as<T, double>) return _mm256_min_pd(a, b);
#endif
#if defined(__SSE2__)
  if constexpr (register_size<V> == 4 && std::same_as<T, float>) return _mm_min_ps(a, b);
  if constexpr (register_size<V> == 2 && std::same_as<T, double>) return _mm_min_pd(a, b);
#endif
  return a < b ? a : b;
}
/// Correctly rounded. Not Eigen's of floats, which by default begins at the processor's estimate: that
/// differs from maker to maker.
template <class V>
[[nodiscard]] PALPATE_INLINE V register_sqrt(const V& a) noexcept {
  using T = RegisterEntry<V>;
  if constexpr (std::is_arithmetic_v<V>) {
    return std::sqrt(a);
  } else {
#if defined(__AVX512F__)
    if constexpr (sizeof(V) == 64 && std::same_as<T, float>) return _mm512_maskz_sqrt_ps(0xffff, a);
    if constexpr (sizeof(V) == 64 && std::same_as<T, double>) return _mm512_maskz_sqrt_pd(0xff, a);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(V) == 32 && std::same_as<T, float>) return _mm256_sqrt_ps(a);
    if constexpr (sizeof(V) == 32 && std::same_as<T, double>) return _mm256_sqrt_pd(a);
#endif
#if defined(__SSE2__)
    if constexpr (sizeof(V) == 16 && std::same_as<T, float>) return _mm_sqrt_ps(a);
    if constexpr (sizeof(V) == 16 && std::same_as<T, double>) return _mm_sqrt_pd(a);
#else
    Eigen::Array<T, static_cast<int>(register_size<V>), 1> x;
    std::memcpy(x.data(), &a, sizeof a);
    x = x.sqrt();
    return load_native<V>(x.data());
#endif
  }
}
/// Without the sign bit, so that -ffast-math leaves it alone.
template <class V>
[[nodiscard]] PALPATE_INLINE V register_abs(const V& a) noexcept {
  using T = RegisterEntry<V>;
  if constexpr (std::is_arithmetic_v<V>) {
    return std::abs(a);
  } else {
    using Word = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    using Bits = typename VectorOf<Word, sizeof(V)>::Type;
    return std::bit_cast<V>(std::bit_cast<Bits>(a) & (~Word(0) >> 1));
  }
}

/// The whole number at or below a. Without an instruction for it: of |a| < 2^22, 2^51.
template <class V>
[[nodiscard]] PALPATE_INLINE V register_floor(const V& a) noexcept {
  using T = RegisterEntry<V>;
  if constexpr (std::is_arithmetic_v<V>) {
    return std::floor(a);
  } else {
#if defined(__AVX512F__)
    if constexpr (sizeof(V) == 64 && std::same_as<T, float>)
      return _mm512_maskz_roundscale_ps(0xffff, a, _MM_FROUND_TO_NEG_INF);
    if constexpr (sizeof(V) == 64 && std::same_as<T, double>)
      return _mm512_maskz_roundscale_pd(0xff, a, _MM_FROUND_TO_NEG_INF);
#endif
#if defined(__AVX__)
    if constexpr (sizeof(V) == 32 && std::same_as<T, float>) return _mm256_floor_ps(a);
    if constexpr (sizeof(V) == 32 && std::same_as<T, double>) return _mm256_floor_pd(a);
#endif
#if defined(__SSE4_1__)
    if constexpr (sizeof(V) == 16 && std::same_as<T, float>) return _mm_floor_ps(a);
    if constexpr (sizeof(V) == 16 && std::same_as<T, double>) return _mm_floor_pd(a);
#endif
    // Near 1.5 * 2^23 floats are whole numbers; 2^52 of double.
    const V shift =
        broadcast<V>(T(3) * static_cast<T>(std::uint64_t(1) << (std::numeric_limits<T>::digits - 2)));
    V shifted = a + shift;
    EIGEN_OPTIMIZATION_BARRIER(shifted)
    V nearest = shifted - shift;
    EIGEN_OPTIMIZATION_BARRIER(nearest)
    return nearest - (nearest > a ? broadcast<V>(T(1)) : V{});
  }
}

/// Of a mask: is an entry true?
template <class M>
[[nodiscard]] PALPATE_INLINE bool register_any(const M& mask) noexcept {
  if constexpr (std::same_as<M, bool>) {
    return mask;
#if defined(__AVX512F__)
  } else if constexpr (sizeof mask == 64) {
    const auto bits = std::bit_cast<__m512i>(mask);
    return _mm512_test_epi64_mask(bits, bits) != 0;
#endif
#if defined(__AVX__)
  } else if constexpr (sizeof mask == 32) {
    return _mm256_movemask_ps(std::bit_cast<__m256>(mask)) != 0;
#endif
#if defined(__SSE2__)
  } else if constexpr (sizeof mask == 16) {
    return _mm_movemask_ps(std::bit_cast<__m128>(mask)) != 0;
#endif
  } else {
    std::array<std::uint64_t, sizeof(M) / sizeof(std::uint64_t)> words;
    std::memcpy(words.data(), &mask, sizeof mask);
    std::uint64_t sum = 0;
    for (const std::uint64_t word : words) sum |= word;
    return sum != 0;
  }
}

/// Entries first .. first + count - 1 of a register.
template <std::size_t first, std::size_t count, class V>
[[nodiscard]] PALPATE_INLINE auto register_slice(const V& x) noexcept {
  if constexpr (count == 1)
    return x[first];
  else
    return [&x]<std::size_t... i>(std::index_sequence<i...>) PALPATE_INLINE_LAMBDA {
      using Part = typename VectorOf<RegisterEntry<V>, count * sizeof(RegisterEntry<V>)>::Type;
      return Part(__builtin_shufflevector(x, x, (first + i)...));
    }(std::make_index_sequence<count>{});
}
/// All entries by `op`: its first half with its second, and so on.
template <class V, class Op>
[[nodiscard]] PALPATE_INLINE auto register_reduce(const V& x, const Op& op) noexcept {
  constexpr std::size_t n = register_size<V>;
  if constexpr (n == 1)
    return x;
  else if constexpr (n == 2)
    return op(x[0], x[1]);
  else
    return register_reduce(op(register_slice<0, n / 2>(x), register_slice<n / 2, n / 2>(x)), op);
}

}  // namespace palpate::detail
