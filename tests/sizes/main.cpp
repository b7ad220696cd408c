// SPDX-License-Identifier: MIT
#include "sizes.hpp"

#include <cstdio>

int main() {
  int failures = 0;
  for (std::size_t i = 0; sizes_plain[i].type != nullptr; ++i) {
    const Size &plain = sizes_plain[i], &avx = sizes_avx[i], &avx512 = sizes_avx512[i];
    const bool same = plain.size == avx.size && plain.alignment == avx.alignment &&
                      plain.size == avx512.size && plain.alignment == avx512.alignment;
    if (!same) ++failures;
    std::printf("%-40s size %4zu %4zu %4zu  alignment %2zu %2zu %2zu  %s\n", plain.type, plain.size, avx.size,
                avx512.size, plain.alignment, avx.alignment, avx512.alignment, same ? "same" : "DIFFERENT");
  }
  return failures;
}
