// SPDX-License-Identifier: MIT
#pragma once

/// @file  A list of numbers that begins on a cache line.

#include <palpate/core/scalar.hpp>

#include <cstddef>
#include <vector>

namespace palpate {

/// A list on the heap in whole groups of registers, whatever the vector flags: of two cache lines. A part
/// that begins where `padded()` of the one before ends begins on a cache line, and a register's load there
/// touches one line instead of two. Sized at set-up; zeros at first.
template <Real S>
class AlignedList {
 public:
  /// n numbers, rounded up to whole groups.
  [[nodiscard]] static constexpr std::size_t padded(std::size_t n) noexcept {
    return (n + entries_in_group - 1) / entries_in_group * entries_in_group;
  }

  void resize(std::size_t size) { lines_.resize(padded(size) / entries_in_line); }
  [[nodiscard]] S* data() noexcept { return reinterpret_cast<S*>(lines_.data()); }
  [[nodiscard]] const S* data() const noexcept { return reinterpret_cast<const S*>(lines_.data()); }
  [[nodiscard]] S& operator[](std::size_t i) noexcept { return data()[i]; }
  [[nodiscard]] const S& operator[](std::size_t i) const noexcept { return data()[i]; }

 private:
  static constexpr std::size_t line = 64, entries_in_line = line / sizeof(S),
                               entries_in_group = 2 * entries_in_line;
  struct alignas(line) Line {
    S entry[entries_in_line]{};
  };
  std::vector<Line> lines_;
};

}  // namespace palpate
