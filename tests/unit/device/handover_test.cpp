// SPDX-License-Identifier: MIT

// Two threads hand values over at full speed. The thread sanitizer (preset tsan) proves here that the
// hand-over has no data race, and relaxed.cmake shows that it would see one. Without the sanitizer a torn
// value shows in the checksum.

#include <palpate/device/spsc_ring.hpp>
#include <palpate/device/triple_buffer.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cstdint>
#include <thread>

namespace {

/// Large enough that a copy takes many instructions; every word follows from the first.
struct Packet {
  std::uint64_t word[64] = {};

  void fill(std::uint64_t n) noexcept {
    word[0] = n;
    for (std::uint64_t i = 1; i < 64; ++i) word[i] = word[i - 1] * 6364136223846793005u + n + i;
  }
  [[nodiscard]] bool whole() const noexcept {
    Packet expected;
    if (word[0] == 0) {  // never written
      for (std::uint64_t w : word)
        if (w != 0) return false;
      return true;
    }
    expected.fill(word[0]);
    for (int i = 0; i < 64; ++i)
      if (word[i] != expected.word[i]) return false;
    return true;
  }
};

constexpr std::uint64_t count = 200000;

}  // namespace

TEST_CASE("triple buffer, two threads: no torn value, order kept, the last one arrives") {
  palpate::TripleBuffer<Packet> buffer;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= count; ++n) {
      buffer.back().fill(n);
      buffer.publish();
    }
    done.store(true, std::memory_order_release);
  });
  std::uint64_t last = 0, torn = 0, backwards = 0, fetched = 0;
  for (bool final = false; !final;) {
    final = done.load(std::memory_order_acquire);
    if (!buffer.fetch()) continue;
    ++fetched;
    const Packet& p = buffer.front();
    torn += p.whole() ? 0 : 1;
    backwards += p.word[0] > last ? 0 : 1;
    last = p.word[0];
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backwards == 0);
  CHECK(last == count);
  CHECK(fetched > 0);
}

TEST_CASE("ring, two threads: everything that was accepted arrives once, whole and in order") {
  palpate::SpscRing<Packet, 16> ring;
  std::atomic<bool> done{false};
  std::uint64_t accepted = 0;
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= count; ++n) {
      Packet p;
      p.fill(n);
      accepted += ring.push(p) ? 1 : 0;
    }
    done.store(true, std::memory_order_release);
  });
  std::uint64_t last = 0, torn = 0, backwards = 0, received = 0;
  Packet p;
  for (bool final = false; !final;) {
    final = done.load(std::memory_order_acquire);
    while (ring.pop(p)) {
      ++received;
      torn += p.whole() ? 0 : 1;
      backwards += p.word[0] > last ? 0 : 1;
      last = p.word[0];
    }
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backwards == 0);
  CHECK(received == accepted);
  CHECK(accepted + ring.dropped() == count);
}
