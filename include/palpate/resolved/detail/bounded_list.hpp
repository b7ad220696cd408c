// SPDX-License-Identifier: MIT
#pragma once

/// @file A list on the heap that is sized at set-up.

#include <palpate/config.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::detail {

/// At most `capacity` items. A copy has the same capacity, which a vector's has not: a copied state must take
/// no heap in a tick.
template <class T>
class BoundedList {
 public:
  explicit BoundedList(std::size_t capacity) : items_(capacity) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] bool full() const noexcept { return size_ == items_.size(); }
  void clear() noexcept { size_ = 0; }
  /// Precondition: not full().
  void push_back(const T& item) noexcept {
    PALPATE_ASSERT(!full());
    items_[size_++] = item;
  }
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return items_[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return items_[i]; }
  [[nodiscard]] T* begin() noexcept { return items_.data(); }
  [[nodiscard]] T* end() noexcept { return items_.data() + size_; }
  [[nodiscard]] const T* begin() const noexcept { return items_.data(); }
  [[nodiscard]] const T* end() const noexcept { return items_.data() + size_; }

 private:
  std::vector<T> items_;
  std::size_t size_ = 0;
};

}  // namespace palpate::detail
