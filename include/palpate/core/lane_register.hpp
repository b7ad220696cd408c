// SPDX-License-Identifier: MIT
#pragma once

/// @file As many floats or doubles as the widest register holds: for long formulas over many points, which
/// Eigen's arrays keep in memory. What is written for `V` also serves a single number.

#include <palpate/core/float_vector.hpp>
#include <palpate/core/scalar.hpp>

#include <Eigen/Core>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include <array>
#include <type_traits>
#include <utility>

namespace palpate::detail {

#if defined(__AVX512F__)
using DoubleRegister [[gnu::vector_size(64)]] = double;
using DoubleBits [[gnu::vector_size(64)]] = std::uint64_t;
#elif defined(__AVX__)
using DoubleRegister [[gnu::vector_size(32)]] = double;
using DoubleBits [[gnu::vector_size(32)]] = std::uint64_t;
#else
using DoubleRegister [[gnu::vector_size(16)]] = double;
using DoubleBits [[gnu::vector_size(16)]] = std::uint64_t;
#endif

/// long double: one, for reference computations.
template <Real S>
using LaneRegister = std::conditional_t<std::same_as<S, float>, WideRegister,
                                        std::conditional_t<std::same_as<S, double>, DoubleRegister, S>>;
template <Real S>
inline constexpr std::size_t register_lanes = sizeof(LaneRegister<S>) / sizeof(S);

/// What a register's entries are; a number is its own.
template <class V>
[[nodiscard]] constexpr auto first_entry(const V& x) noexcept {
  if constexpr (std::is_floating_point_v<V>)
    return x;
  else
    return first_entry(x[0]);
}
template <class V>
using EntryOf = decltype(first_entry(std::declval<V>()));

/// The bits of its entries.
template <Real S>
using LaneBits = std::conditional_t<std::same_as<S, float>, WideBits, DoubleBits>;

/// A number that meets many registers: as many of it as a register holds, unless a load can repeat it.
#if defined(__AVX__)
template <Real S>
using LaneFactor = S;
#else
template <Real S>
using LaneFactor = LaneRegister<S>;
#endif
template <Real S>
[[nodiscard]] PALPATE_INLINE LaneFactor<S> lane_factor(S x) noexcept {
  return all_of<LaneFactor<S>>(x);
}

/// What a comparison gives, to choose with: mask ? a : b.
template <class V>
using MaskOf = decltype(std::declval<V>() < std::declval<V>());

template <Real S>
[[nodiscard]] PALPATE_INLINE LaneRegister<S> load_register(const S* from) noexcept {
  return load_vector<LaneRegister<S>>(from);
}

template <Real S, class V>
[[nodiscard]] PALPATE_INLINE V root_of(const V& x) noexcept {
  Eigen::Array<S, static_cast<int>(sizeof(V) / sizeof(S)), 1> entries;
  store_vector(entries.data(), x);
  entries = entries.sqrt();
  return load_vector<V>(entries.data());
}

/// As of floats: entry by entry; b where one is not a number.
[[nodiscard]] PALPATE_INLINE DoubleRegister larger(DoubleRegister a, DoubleRegister b) noexcept {
#if defined(__AVX512F__)
  return _mm512_maskz_max_pd(0xff, a, b);
#elif defined(__AVX__)
  return _mm256_max_pd(a, b);
#elif defined(__SSE2__)
  return _mm_max_pd(a, b);
#else
  return a > b ? a : b;
#endif
}
[[nodiscard]] PALPATE_INLINE DoubleRegister smaller(DoubleRegister a, DoubleRegister b) noexcept {
#if defined(__AVX512F__)
  return _mm512_maskz_min_pd(0xff, a, b);
#elif defined(__AVX__)
  return _mm256_min_pd(a, b);
#elif defined(__SSE2__)
  return _mm_min_pd(a, b);
#else
  return a < b ? a : b;
#endif
}
template <class V>
[[nodiscard]] PALPATE_INLINE V absolute(const V& a) noexcept {
  return a < V{} ? -a : a;
}
/// Masks that are true together, and the opposite of one.
template <class M, class... Others>
[[nodiscard]] PALPATE_INLINE M all_true(const M& a, const Others&... others) noexcept {
  if constexpr (sizeof...(others) == 0)
    return a;
  else if constexpr (std::same_as<M, bool>)
    return a && all_true<M>(others...);
  else
    return a & all_true<M>(others...);
}
template <class M>
[[nodiscard]] PALPATE_INLINE M negated(const M& a) noexcept {
  return a == 0;
}

/// is_finite() of every entry.
template <Real S, class V>
[[nodiscard]] PALPATE_INLINE MaskOf<V> finite(const V& x) noexcept {
  if constexpr (std::same_as<V, S>) {
    return is_finite(x);
  } else {
    using Bits = MaskOf<V>;
    constexpr auto exponent = std::bit_cast<std::conditional_t<sizeof(S) == 4, std::int32_t, std::int64_t>>(
        std::numeric_limits<S>::infinity());
    return (std::bit_cast<Bits>(x) & exponent) != exponent;
  }
}
/// Of a mask: is an entry true?
template <Real S, class M>
[[nodiscard]] PALPATE_INLINE bool any(const M& mask) noexcept {
  if constexpr (std::same_as<M, bool>) {
    return mask;
#if defined(__AVX512F__)
  } else if constexpr (sizeof mask == sizeof(__m512i)) {
    const auto bits = std::bit_cast<__m512i>(mask);
    return _mm512_test_epi64_mask(bits, bits) != 0;
#endif
  } else {
    std::array<std::uint64_t, sizeof(M) / sizeof(std::uint64_t)> words;
    std::memcpy(words.data(), &mask, sizeof mask);
    std::uint64_t sum = 0;
    for (const std::uint64_t word : words) sum |= word;
    return sum != 0;
  }
}

}  // namespace palpate::detail
