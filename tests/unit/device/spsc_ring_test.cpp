// SPDX-License-Identifier: MIT
#include <palpate/device/spsc_ring.hpp>

#include <doctest/doctest.h>

#include <deque>
#include <random>

TEST_CASE("ring, empty: pop says so and leaves the item alone") {
  palpate::SpscRing<int, 4> ring;
  int item = 42;
  CHECK_FALSE(ring.pop(item));
  CHECK(item == 42);
}

TEST_CASE("ring, full: the first N stay, in order, the others are dropped and counted") {
  palpate::SpscRing<int, 4> ring;
  for (int i = 0; i < 7; ++i) CHECK(ring.push(i) == (i < 4));
  CHECK(ring.dropped() == 3);
  int item = -1;
  for (int i = 0; i < 4; ++i) {
    CHECK(ring.pop(item));
    CHECK(item == i);
  }
  CHECK_FALSE(ring.pop(item));
  CHECK(ring.push(8));
  CHECK(ring.pop(item));
  CHECK(item == 8);
}

TEST_CASE("ring, many turns: agrees with a queue") {
  std::mt19937_64 random(5);
  INFO("seed 5");
  palpate::SpscRing<int, 8> ring;
  std::deque<int> model;
  std::uint64_t dropped = 0;
  for (int i = 0; i < 100000; ++i) {
    if (random() % 2 == 0) {
      const bool room = model.size() < 8;
      REQUIRE(ring.push(i) == room);
      if (room) model.push_back(i);
      dropped += room ? 0 : 1;
    } else {
      int item = -1;
      REQUIRE(ring.pop(item) == !model.empty());
      if (model.empty()) continue;
      REQUIRE(item == model.front());
      model.pop_front();
    }
  }
  CHECK(ring.dropped() == dropped);
  CHECK(dropped > 100);
}
