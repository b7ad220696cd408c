// SPDX-License-Identifier: MIT
#pragma once

/// @file  Display vertices by the block.

#include <palpate/core/scalar.hpp>

#include <array>
#include <cstddef>

namespace palpate {

/// Vertices are worked on in blocks of at most this many: a dozen intermediate results of a block in double
/// fit in a first-level cache of 32 kB.
inline constexpr std::size_t block_size = 256;

/// One number per vertex of a block. Entries after the last vertex fill up its `simd_group`; they are not
/// used.
template <Real S>
struct alignas(64) Block {
  S value[block_size];
  [[nodiscard]] S& operator[](std::size_t i) noexcept { return value[i]; }
  [[nodiscard]] const S& operator[](std::size_t i) const noexcept { return value[i]; }
};

/// Vectors of the vertices of a block (positions, displacements), coordinate by coordinate.
template <class S>
using Lists = std::array<S*, 3>;

}  // namespace palpate
