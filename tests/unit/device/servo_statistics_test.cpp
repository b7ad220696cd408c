// SPDX-License-Identifier: MIT
#include <palpate/device/servo_statistics.hpp>

#include <support/check.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using palpate::ServoStatistics;
using palpate::TimeHistogram;

TEST_CASE("time histogram, empty: zeros") {
  const TimeHistogram h;
  CHECK(h.count() == 0);
  CHECK(h.min() == 0);
  CHECK(h.max() == 0);
  CHECK(h.mean() == 0);
  CHECK(h.quantile(0.5) == 0);
}

TEST_CASE("time histogram, quantiles: never below the sorted list's, above by at most 1/32") {
  std::mt19937_64 random(9);
  INFO("seed 9");
  std::uniform_real_distribution<double> exponent(0, 30);
  TimeHistogram h;
  std::vector<std::uint64_t> all;
  for (int i = 0; i < 20000; ++i) {
    const auto ns = static_cast<std::int64_t>(std::exp2(exponent(random)));
    h.add(ns);
    all.push_back(static_cast<std::uint64_t>(ns));
  }
  std::sort(all.begin(), all.end());
  for (double q : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * 20000)) - 1;
    const std::uint64_t exact = all[rank], got = h.quantile(q);
    CHECK(got >= exact);
    CHECK(static_cast<double>(got) <= static_cast<double>(exact) * (1 + 1.0 / 32));
  }
  CHECK(h.max() == all.back());
  CHECK(h.min() == all.front());
  CHECK(h.count() == 20000);
}

TEST_CASE("time histogram, small values are exact; negative and huge ones land at the ends") {
  TimeHistogram h;
  for (int i = 0; i < 64; ++i) h.add(i);
  for (int i = 1; i <= 64; ++i) CHECK(h.quantile(i / 64.0) == static_cast<std::uint64_t>(i - 1));
  CHECK_RELATIVE(h.mean(), 31.5, 0);
  h.add(-5);
  CHECK(h.min() == 0);
  h.add(std::int64_t{1} << 62);
  CHECK(h.max() == (std::uint64_t{1} << 40) - 1);
}

TEST_CASE("servo statistics: rate, jitter and overruns of a loop with one late and one long tick") {
  ServoStatistics s;
  s.add(1000000, 0, 5000);
  for (int i = 0; i < 98; ++i) s.add(1000000, 1000000, 5000);
  s.add(1000000, 3000000, 1000001);
  CHECK(s.ticks == 100);
  CHECK(s.overruns == 1);
  CHECK(s.jitter.count() == 99);
  CHECK(s.jitter.max() == 2000000);
  CHECK(s.jitter.quantile(0.98) == 0);
  CHECK(s.span == 101000000);
  CHECK_RELATIVE(s.rate(), 99 / 0.101, 1e-15);  // one division
}
