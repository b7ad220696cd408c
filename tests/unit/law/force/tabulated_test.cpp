// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/law/force/tabulated.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace palpate;
using palpate::test::ulps;

namespace {

template <class S>
using Table = TabulatedForce<S, 32>;

template <class S>
std::vector<typename Table<S>::Sample> random_curve(std::mt19937_64& random, std::size_t n) {
  // Steps over four decades: steep next to flat, near next to far.
  std::uniform_real_distribution<double> decade(-4, 0);
  std::vector<typename Table<S>::Sample> samples{{S(0), S(0)}};
  while (samples.size() < n) {
    const S depth = samples.back().depth + static_cast<S>(0.01 * std::pow(10.0, decade(random)));
    const S force = samples.back().force + static_cast<S>(std::pow(10.0, decade(random)));
    samples.push_back({depth, force});
  }
  return samples;
}

}  // namespace

TEST_CASE_TEMPLATE("tabulated: through every sample, rising, with continuous slope, on wild data", S, float,
                   double) {
  std::mt19937_64 random(1980);  // fixed seed
  for (int run = 0; run < 200; ++run) {
    const auto samples = random_curve<S>(random, 2 + static_cast<std::size_t>(run) % 31);
    const Table<S> law(samples);
    const S epsilon = std::numeric_limits<S>::epsilon();
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const auto [depth, force] = samples[i];
      CHECK(law.force(depth) == force);
      const S before = std::nextafter(depth, S(0));
      // One ulp of depth before the sample the piece on its left gives the same force and slope; the slack is
      // that of the piece's own sums: slopes are below 3 secants.
      const S step = depth - samples[i - 1].depth, rise = force - samples[i - 1].force;
      CHECK_ABSOLUTE(law.force(before), force, S(8) * (epsilon * force + rise * epsilon * depth / step));
      CHECK_ABSOLUTE(law.stiffness(before), law.stiffness(depth),
                     S(64) * rise / step * (epsilon * depth / step));
      int falls = 0;
      S last = samples[i - 1].force;
      for (int j = 0; j <= 50; ++j) {
        const S f = law.force((std::min)(samples[i - 1].depth + step * static_cast<S>(j) / S(50), depth));
        // The piece's sum has terms up to 6 times its rise.
        if (!(f >= last - S(16) * epsilon * force) || !(f <= force * (S(1) + S(16) * epsilon))) ++falls;
        last = f;
      }
      CHECK(falls == 0);
    }
  }
}

TEST_CASE_TEMPLATE("tabulated: inverse of wild data", S, float, double) {
  std::mt19937_64 random(1984);  // fixed seed
  std::uniform_real_distribution<double> share(0, 1.5);
  for (int run = 0; run < 200; ++run) {
    const auto samples = random_curve<S>(random, 2 + static_cast<std::size_t>(run) % 31);
    const Table<S> law(samples);
    for (int j = 0; j < 50; ++j) {
      const S force = samples.back().force * static_cast<S>(share(random) * share(random));
      const S depth = law.depth(force);
      // The force at the depth found, to the rounding of that depth and of the force.
      CHECK_ABSOLUTE(law.force(depth), force,
                     ulps<S>(8) * static_cast<long double>(force + law.stiffness(depth) * depth));
    }
    for (const auto& [depth, force] : samples) CHECK_RELATIVE(law.depth(force), depth, ulps<S>(4));
  }
}

TEST_CASE("tabulated: a straight line and two samples are straight") {
  const std::array<Table<double>::Sample, 4> line{{{0, 0}, {1, 2}, {3, 6}, {4, 8}}};
  const std::array<Table<double>::Sample, 2> two{{{0, 0}, {4, 8}}};
  const Table<double> a(line), b(two);
  for (const double d : {1e-9, 0.5, 1.0, 2.7, 4.0, 100.0}) {
    CHECK_RELATIVE(a.force(d), 2 * d, ulps<double>(4));
    CHECK_RELATIVE(a.stiffness(d), 2, ulps<double>(8));
    CHECK_RELATIVE(a.energy(d), d * d, ulps<double>(8));
    CHECK_RELATIVE(b.force(d), 2 * d, ulps<double>(1));
    CHECK_RELATIVE(b.depth(2 * d), d, ulps<double>(1));
  }
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const double d : {1e308, infinite}) {
    CHECK(a.force(d) == infinite);
    CHECK(a.energy(d) == infinite);
    CHECK_RELATIVE(a.stiffness(d), 2, ulps<double>(8));
  }
}

TEST_CASE("tabulated: converges to the law it samples") {
  // F = u + u^3 on [0, 1] from n samples: error falls at least as h^2 (third order inside, second at the
  // ends).
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const std::size_t n = k == 0 ? 9 : 17;
    std::vector<Table<double>::Sample> samples;
    for (std::size_t i = 0; i < n; ++i) {
      const double u = static_cast<double>(i) / static_cast<double>(n - 1);
      samples.push_back({u, u + u * u * u});
    }
    const Table<double> law(samples);
    errors[k] = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double u = i / 1000.0;
      errors[k] = std::fmax(errors[k], std::fabs(law.force(u) - (u + u * u * u)));
    }
  }
  MESSAGE("largest error of 9 and 17 samples of u + u^3: ", errors[0], ", ", errors[1]);
  CHECK(errors[0] < 0.01);
  CHECK(errors[1] < errors[0] / 3.5);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("tabulated: bad data is refused with its position and value") {
  using Law = TabulatedForce<double, 4>;
  using Sample = Law::Sample;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto message = [](const std::vector<Sample>& samples) -> std::string {
    try {
      const Law law(samples);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message({{0, 0}, {1, 1}, {2, 3}, {3, 4}}) == "");
  CHECK(message({}) == "TabulatedForce: needs at least 2 samples, got 0");
  CHECK(message({{0, 0}}) == "TabulatedForce: needs at least 2 samples, got 1");
  CHECK(message({{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}) ==
        "TabulatedForce: more samples than the object holds, got 5");
  CHECK(message({{0.1, 0}, {1, 1}}) == "TabulatedForce: the first depth [m] must be 0, at sample 0, got 0.1");
  CHECK(message({{0, -0.5}, {1, 1}}) ==
        "TabulatedForce: the first force [N] must be 0, at sample 0, got -0.5");
  CHECK(message({{0, 0}, {2, 1}, {1, 2}}) ==
        "TabulatedForce: depth [m] must be above the sample before, at sample 2, got 1");
  CHECK(message({{0, 0}, {1, 1}, {1, 2}}) ==
        "TabulatedForce: depth [m] must be above the sample before, at sample 2, got 1");
  CHECK(message({{0, 0}, {1, 3}, {2, 2.5}}) ==
        "TabulatedForce: force [N] must be above the sample before, at sample 2, got 2.5");
  CHECK(message({{0, 0}, {1, nan}, {2, 2}}) ==
        "TabulatedForce: force [N] must be finite, at sample 1, got nan");
  CHECK(message({{0, 0}, {nan, 1}, {2, 2}}) ==
        "TabulatedForce: depth [m] must be finite, at sample 1, got nan");
  // Samples so close that the slope overflows.
  CHECK(message({{0, 0}, {1e-200, 1}, {1, 2}}).find("curvature or energy of the curve is out") !=
        std::string::npos);
  CHECK(message({{0, 0}, {1e-308, 1e300}, {1, 2e300}}).find("out of the scalar's range, at sample 0") !=
        std::string::npos);
}
#endif

TEST_CASE(
    "tabulated: slopes at the ends are the secants continued, at most two of them; energy is the integral") {
  // Secants 2 N/m over 1 m, then 1 over 2 m, then 4 over 1 m.
  const std::vector<Table<double>::Sample> samples{{0, 0}, {1, 2}, {3, 4}, {4, 8}};
  const Table<double> law(samples);
  CHECK_RELATIVE(law.stiffness(1e-12), 2 * std::cbrt(2.0), 1e-9);                  // 2 (2/1)^(1/3)
  CHECK_RELATIVE(law.force(5), 8 + 4 * std::pow(4.0, 1.0 / 3), ulps<double>(16));  // 4 (4/1)^(1/3) = 6.35
  const std::vector<Table<double>::Sample> steep{{0, 0}, {1, 0.01}, {2, 1.01}};
  CHECK_RELATIVE(Table<double>(steep).force(3), 1.01 + 2, ulps<double>(16));  // (100)^(1/2) is more than 2
  double sum = 0;
  for (const double at : {0.0, 1.0, 2.0, 3.0, 3.5}) {  // Simpson's rule is exact for a piece's cubic
    const double end = at < 3 ? at + 1 : at == 3.0 ? 3.5 : 4;
    sum += (end - at) / 6 * (law.force(at) + 4 * law.force(0.5 * (at + end)) + law.force(end));
    CHECK_RELATIVE(law.energy(end), sum, ulps<double>(32));
  }
}
