// SPDX-License-Identifier: MIT
#pragma once

/// @file  Display vertices by the block and by the vector register.

#include <palpate/config.hpp>
#include <palpate/core/scalar.hpp>

#include <Eigen/Core>

#include <cstddef>

namespace palpate {

/// Vertices are worked on in blocks of at most this many, whose intermediate results stay in the first-level cache.
inline constexpr std::size_t block_size = 64;

/// One number per vertex of a block. Loops run over all `block_size` entries, so that they vectorise without a
/// remainder; past the block's last vertex they hold whatever follows in memory, which is never used.
template <Real S>
struct alignas(64) Block {
  S value[block_size];
  [[nodiscard]] S& operator[](std::size_t i) noexcept { return value[i]; }
  [[nodiscard]] const S& operator[](std::size_t i) const noexcept { return value[i]; }
};

namespace detail {

/// One or two vector registers' worth of a block; a block is a whole number of them. For what compilers leave scalar at -O2:
/// minima and maxima, short loops, addresses they cannot tell apart. The same whatever the vector flags.
template <Real S>
inline constexpr std::size_t lanes = 32 / sizeof(S);
template <Real S>
using Lanes = Eigen::Array<S, static_cast<int>(lanes<S>), 1>;

template <Real S>
[[nodiscard]] inline Lanes<S> load_lanes(const S* from) noexcept {
  return Eigen::Map<const Lanes<S>>(from);
}
template <Real S>
inline void store_lanes(S* to, const Lanes<S>& from) noexcept {
  Eigen::Map<Lanes<S>> out(to);
  out = from;
}

/// Extremes of all entries of a block.
template <Real S>
[[nodiscard]] inline S least(const Block<S>& block) noexcept {
  Lanes<S> extreme = load_lanes(block.value);
  for (std::size_t i = lanes<S>; i < block_size; i += lanes<S>)
    extreme = extreme.min(load_lanes(block.value + i));
  return extreme.minCoeff();
}
template <Real S>
[[nodiscard]] inline S largest(const Block<S>& block) noexcept {
  Lanes<S> extreme = load_lanes(block.value);
  for (std::size_t i = lanes<S>; i < block_size; i += lanes<S>)
    extreme = extreme.max(load_lanes(block.value + i));
  return extreme.maxCoeff();
}

}  // namespace detail

}  // namespace palpate
