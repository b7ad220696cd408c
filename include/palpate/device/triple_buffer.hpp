// SPDX-License-Identifier: MIT
#pragma once

/// @file  Latest-value hand-over between two threads, for example servo to graphics, without locks.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace palpate {

/// Owns nothing: copying it needs no heap and dropping it does nothing. Trivially copyable types qualify, and
/// so do structs of Eigen's fixed-size vectors, which are not trivially copyable because Eigen writes out its
/// copies.
template <class T>
concept PlainValue =
    std::is_trivially_destructible_v<T> && std::is_default_constructible_v<T> && std::is_copy_assignable_v<T>;

/// Three slots: the writer owns one, the reader owns one, the third is exchanged atomically. One writer
/// thread, one reader thread. Both sides are wait-free: one atomic exchange each, no loop. The reader sees
/// the newest complete value; values in between are lost, which is what a display wants (for a list of
/// events: SpscRing).
///
/// | writer                          | reader                                                       |
/// |---------------------------------|--------------------------------------------------------------|
/// | `publish(value)`                | `if (b.fetch()) use(b.front());`  fetch() is false: no news  |
/// | or fill `back()`, `publish()`   | `front()` stays valid and unchanged until the next fetch()   |
///
/// back() has an old value, two or more publications ago: fill it completely.
template <PlainValue T>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  /// Writer: the slot to fill.
  [[nodiscard]] T& back() noexcept { return slots_[back_].value; }
  /// Writer: hands back() over.
  void publish() noexcept {
    // release: the reader's acquire below sees the slot filled; acquire: this thread sees the reader done
    // with the slot it gets.
    back_ = shared_.exchange(static_cast<std::uint8_t>(back_ | fresh_bit), std::memory_order_acq_rel) &
            index_mask;
  }
  void publish(const T& value) noexcept {
    back() = value;
    publish();
  }

  /// Reader: true when a value was published since the last fetch().
  [[nodiscard]] bool fresh() const noexcept {
    return (shared_.load(std::memory_order_relaxed) & fresh_bit) != 0;
  }
  /// Reader: makes the newest value front(). False, and front() is as before, when there is none.
  bool fetch() noexcept {
    if (!fresh()) return false;
    front_ = shared_.exchange(front_, std::memory_order_acq_rel) & index_mask;
    return true;
  }
  /// Reader: a default-constructed T until the first successful fetch().
  [[nodiscard]] const T& front() const noexcept { return slots_[front_].value; }

 private:
  static constexpr std::uint8_t index_mask = 3, fresh_bit = 4;
  static constexpr std::size_t line = 64;  // cache line: the two threads must not share one

  struct alignas(line) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  alignas(line) std::atomic<std::uint8_t> shared_{1};
  alignas(line) std::uint8_t back_ = 0;   // writer's
  alignas(line) std::uint8_t front_ = 2;  // reader's
};

}  // namespace palpate
