// SPDX-License-Identifier: MIT
#pragma once

/// @file What every fuzz target shares: numbers from bytes, a check that stops the fuzzer, a count of heap
/// allocations that works under the sanitizers.

#include <palpate/core/vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*,
                                                                             std::size_t),
                                                         void (*free_hook)(const volatile void*));

namespace palpate::fuzz {

/// What must hold, else the fuzzer keeps the input.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Values from the fuzzer's bytes; after the last byte all are 0.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}
  [[nodiscard]] bool empty() const { return left_.empty(); }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return left_; }

  template <class T>
  T raw() {
    T value{};
    const std::size_t n = left_.size() < sizeof(T) ? left_.size() : sizeof(T);
    if (n > 0) std::memcpy(&value, left_.data(), n);
    left_ = left_.subspan(n);
    return value;
  }
  std::uint8_t byte() { return raw<std::uint8_t>(); }
  /// In [-1, 1].
  template <Real S>
  S unit() {
    return S(raw<std::int16_t>()) / S(32767);
  }
  /// Any number: bits as they come, one of the awkward ones, or m 10^k with a small m.
  template <Real S>
  S number() {
    using L = std::numeric_limits<S>;
    const std::uint8_t kind = byte();
    if (kind < 64) return raw<S>();
    if (kind < 128) {
      const S awkward[] = {
          S(0),        S(-0.0),  L::infinity(),       -L::infinity(), L::quiet_NaN(), L::max(),
          L::lowest(), L::min(), L::denorm_min(),     -L::min(),      L::epsilon(),   S(1),
          S(-1),       S(0.5),   S(1) / S(3),         S(1e6),         S(1e-6),        S(1e9),
          S(1e-9),     S(1000),  S(1) + L::epsilon(), S(2) / S(3),    S(1e-30),       S(1e30)};
      return awkward[kind % std::size(awkward)];
    }
    const int tens = int(kind % 24) - 14;  // 1e-14 .. 1e9
    S scale = S(1);
    for (int k = 0; k < std::abs(tens); ++k) scale *= S(10);
    const S digits = S(raw<std::int16_t>()) / S(1000);
    return tens < 0 ? digits / scale : digits * scale;
  }
  /// A sensible positive number, from low to high: even in its logarithm.
  template <Real S>
  S between(S low, S high) {
    const S part = S(raw<std::uint16_t>()) / S(65535);
    return low * std::pow(high / low, part);
  }
  template <Real S>
  Vec3<S> numbers() {
    const S x = number<S>(), y = number<S>(), z = number<S>();
    return {x, y, z};
  }
  template <Real S>
  Vec3<S> units() {
    const S x = unit<S>(), y = unit<S>(), z = unit<S>();
    return {x, y, z};
  }

 private:
  std::span<const std::uint8_t> left_;
};

/// Heap allocations of this thread while a `NoHeap` lives: there must be none.
class NoHeap {
 public:
  NoHeap() {
    [[maybe_unused]] static const int installed = __sanitizer_install_malloc_and_free_hooks(
        [](const volatile void*, std::size_t) { ++count; }, [](const volatile void*) {});
    count = 0;
  }
  ~NoHeap() { require(count == 0, "no heap in a tick"); }
  NoHeap(const NoHeap&) = delete;
  NoHeap& operator=(const NoHeap&) = delete;

 private:
  static inline thread_local std::size_t count = 0;
};

template <Real S>
[[nodiscard]] inline bool same(const Vec3<S>& a, const Vec3<S>& b) {
  return std::memcmp(a.data(), b.data(), 3 * sizeof(S)) == 0;
}

}  // namespace palpate::fuzz
