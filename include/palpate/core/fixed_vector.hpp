// SPDX-License-Identifier: MIT
#pragma once

/// @file  A list of at most N items inside the object: no heap, trivially copyable when T is.

#include <palpate/config.hpp>

#include <array>
#include <cstddef>

namespace palpate {

template <class T, std::size_t N>
class FixedVector {
 public:
  static constexpr std::size_t capacity = N;

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] constexpr bool full() const noexcept { return size_ == N; }
  constexpr void clear() noexcept { size_ = 0; }
  /// Precondition: not full().
  constexpr void push_back(const T& item) noexcept {
    PALPATE_ASSERT(!full());
    items_[size_++] = item;
  }
  [[nodiscard]] constexpr T& operator[](std::size_t i) noexcept { return items_[i]; }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  [[nodiscard]] constexpr T* begin() noexcept { return items_.data(); }
  [[nodiscard]] constexpr T* end() noexcept { return items_.data() + size_; }
  [[nodiscard]] constexpr const T* begin() const noexcept { return items_.data(); }
  [[nodiscard]] constexpr const T* end() const noexcept { return items_.data() + size_; }

 private:
  std::array<T, N> items_{};
  std::size_t size_ = 0;
};

}  // namespace palpate
