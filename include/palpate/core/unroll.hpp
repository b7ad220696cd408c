// SPDX-License-Identifier: MIT
#pragma once

/// @file A short loop, written out.

#include <palpate/config.hpp>

#include <cstddef>
#include <utility>

namespace palpate::detail {

/// work(0) .. work(N - 1), written out: compilers keep short loops at -O2, and their arrays in memory.
template <std::size_t N, class Work>
PALPATE_INLINE void unroll(const Work& work) noexcept {
  [&]<std::size_t... i>(std::index_sequence<i...>)
      PALPATE_INLINE_LAMBDA { (work(i), ...); }(std::make_index_sequence<N>{});
}

}  // namespace palpate::detail
