// SPDX-License-Identifier: MIT
#pragma once

/// @file  A list of at most N items inside the object: no heap, trivially copyable when T is.

#include <palpate/config.hpp>

#include <array>
#include <cstddef>
#include <type_traits>

namespace palpate {

/// What lies past size(): zeros, so that equal lists are equal bytes, or whatever was there, for long lists
/// on a tick's stack.
enum class Spare { zero, undefined };

namespace detail {
template <class T, std::size_t N>
struct ZeroedItems {
  std::array<T, N> list{};
};
template <class T, std::size_t N>
struct RawItems {
  RawItems() noexcept {}
  std::array<T, N> list;
};
}  // namespace detail

template <class T, std::size_t N, Spare spare = Spare::zero>
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
    items_.list[size_++] = item;
  }
  /// n items; those past the present size() are what was there. Precondition: n <= N.
  constexpr void set_size(std::size_t n) noexcept {
    PALPATE_ASSERT(n <= N);
    size_ = n;
  }
  [[nodiscard]] constexpr T& operator[](std::size_t i) noexcept { return items_.list[i]; }
  [[nodiscard]] constexpr const T& operator[](std::size_t i) const noexcept { return items_.list[i]; }
  [[nodiscard]] constexpr T* begin() noexcept { return items_.list.data(); }
  [[nodiscard]] constexpr T* end() noexcept { return items_.list.data() + size_; }
  [[nodiscard]] constexpr const T* begin() const noexcept { return items_.list.data(); }
  [[nodiscard]] constexpr const T* end() const noexcept { return items_.list.data() + size_; }

 private:
  std::conditional_t<spare == Spare::zero, detail::ZeroedItems<T, N>, detail::RawItems<T, N>> items_;
  std::size_t size_ = 0;
};

}  // namespace palpate
