// SPDX-License-Identifier: MIT
#include <palpate/core/pose.hpp>
#include <palpate/device/triple_buffer.hpp>

#include <doctest/doctest.h>

#include <random>
#include <string>
#include <vector>

using palpate::TripleBuffer;

static_assert(palpate::PlainValue<int>);
static_assert(palpate::PlainValue<palpate::Wrench<float>>);  // Eigen's vectors are not trivially copyable
static_assert(!palpate::PlainValue<std::string>);
static_assert(!palpate::PlainValue<std::vector<int>>);

TEST_CASE("triple buffer, before the first publication: nothing fresh, a default value") {
  TripleBuffer<int> b;
  CHECK_FALSE(b.fresh());
  CHECK_FALSE(b.fetch());
  CHECK(b.front() == 0);
}

TEST_CASE("triple buffer, reader slower: it gets the newest value, once") {
  TripleBuffer<int> b;
  for (int i = 1; i <= 5; ++i) b.publish(i);
  CHECK(b.fresh());
  CHECK(b.fetch());
  CHECK(b.front() == 5);
  CHECK_FALSE(b.fetch());
  CHECK(b.front() == 5);
}

TEST_CASE("triple buffer, writer busy: front() does not change until the next fetch") {
  TripleBuffer<int> b;
  b.publish(1);
  CHECK(b.fetch());
  for (int i = 2; i < 10; ++i) {
    b.back() = i;
    CHECK(b.front() == 1);
    b.publish();
    CHECK(b.front() == 1);
  }
  CHECK(b.fetch());
  CHECK(b.front() == 9);
}

TEST_CASE("triple buffer, any order of calls: agrees with a one-value model") {
  std::mt19937_64 random(3);
  INFO("seed 3");
  TripleBuffer<int> b;
  int newest = 0, seen = 0;
  bool fresh = false;
  for (int i = 1; i < 100000; ++i) {
    if (random() % 2 == 0) {
      b.publish(newest = i);
      fresh = true;
    } else {
      REQUIRE(b.fetch() == fresh);
      if (fresh) seen = newest;
      fresh = false;
      REQUIRE(b.front() == seen);
    }
    REQUIRE(b.fresh() == fresh);
  }
}
