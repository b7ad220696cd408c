// SPDX-License-Identifier: MIT
#pragma once

/// @file  What crosses the interface between objects that may be compiled with different vector flags.

#include <cstddef>

struct Size {
  const char* type;
  std::size_t size, alignment;
};

// The same list, compiled with different flags; a row without a type ends it.
extern const Size sizes_plain[];
extern const Size sizes_avx[];
extern const Size sizes_avx512[];
