// SPDX-License-Identifier: MIT
#pragma once

/// @file  Display vertices by the block.

#include <palpate/core/scalar.hpp>

#include <array>
#include <cstddef>

namespace palpate {

/// Vertices are worked on in blocks of at most this many, whose intermediate results stay in the first-level
/// cache.
inline constexpr std::size_t block_size = 256;

/// One number per vertex of a block. What follows the block's last vertex in its LaneGroup is never used.
template <Real S>
struct alignas(64) Block {
  S value[block_size];
  [[nodiscard]] S& operator[](std::size_t i) noexcept { return value[i]; }
  [[nodiscard]] const S& operator[](std::size_t i) const noexcept { return value[i]; }
};

/// Where the vertices of a block are, coordinate by coordinate.
template <class S>
using Lists = std::array<S*, 3>;

}  // namespace palpate
