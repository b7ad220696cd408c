// SPDX-License-Identifier: MIT
#pragma once

/// @file  A queue of events between two threads, without locks: for error codes, which the servo must not
/// print.

#include <palpate/device/triple_buffer.hpp>

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace palpate {

/// First in, first out; capacity N, a power of two. One writer thread, one reader thread, both wait-free.
/// When it is full the new item is dropped and counted: the first errors say more than the last.
template <PlainValue T, std::size_t N>
class SpscRing {
  static_assert(std::has_single_bit(N), "SpscRing: N must be a power of two, so that the counters may wrap");

 public:
  static constexpr std::size_t capacity = N;

  SpscRing() = default;
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  /// Writer: false when it was full and `item` was dropped.
  bool push(const T& item) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == N) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    items_[end % N] = item;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  /// Reader: false when it was empty.
  bool pop(T& item) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    item = items_[begin % N];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

  /// Either side: how many push() have failed.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<T, N> items_{};
  alignas(64) std::atomic<std::size_t> begin_{0};  // written by the reader only
  alignas(64) std::atomic<std::size_t> end_{0};    // written by the writer only
  std::atomic<std::uint64_t> dropped_{0};          // written by the writer only
};

}  // namespace palpate
