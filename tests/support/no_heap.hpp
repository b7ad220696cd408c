// SPDX-License-Identifier: MIT
#pragma once

/// @file Counts heap allocations of the calling thread, so that a test can show that a tick makes none:
///
///     const palpate::test::HeapCount heap;
///     solver.tick(pose, dt);
///     CHECK(heap.allocations() == 0);
///
/// Counted: operator new in all its forms, and on Linux malloc, calloc, realloc, aligned_alloc and
/// posix_memalign called from the program's own objects, which a header-only library is a part of.

#include <cstddef>

namespace palpate::test {

/// Allocations of the calling thread since it started.
[[nodiscard]] std::size_t allocations_of_thread() noexcept;

class HeapCount {
 public:
  HeapCount() noexcept : start_(allocations_of_thread()) {}
  /// Allocations since construction.
  [[nodiscard]] std::size_t allocations() const noexcept { return allocations_of_thread() - start_; }

 private:
  std::size_t start_;
};

}  // namespace palpate::test
