// SPDX-License-Identifier: MIT
#include <palpate/calibrate/duffing_fit.hpp>

#include "support/check.hpp"

#include <random>

namespace {
using namespace palpate;

std::vector<CurvePoint> curve(double c1, double c3, double deepest, double noise, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, 1);
  std::vector<CurvePoint> out;
  for (int i = 1; i <= 40; ++i) {
    const double d = deepest * i / 40;
    out.push_back({d, c1 * d + c3 * d * d * d + noise * error(random), 1});
  }
  return out;
}
}  // namespace

TEST_CASE("Duffing: exact data give the parameters back, stiffening, softening and purely cubic") {
  const double cases[3][2] = {{500, 3e6}, {500, -1.2e6}, {0, 4e6}};
  for (const auto& c : cases) {
    const DuffingFit f = fit_duffing(curve(c[0], c[1], 0.01, 0));
    CHECK_ABSOLUTE(f.params.c1, c[0], 1e-4);  // central differences: 1e-7 of the force scale, 4 N over 0.01 m
    CHECK_RELATIVE(f.params.c3, c[1], 1e-6);
    CHECK(f.fit.relative_rms < 1e-7);
    if (c[0] > 0 || c[1] > 0) CHECK(DuffingForce<double>(f.params).force(0.005) > 0);
  }
}

TEST_CASE("Duffing: a curve that falls again is fitted up to its fold, never past it") {
  const DuffingFit f = fit_duffing(curve(500, -2.5e6, 0.01, 0), {.worst_rms = 0.5});  // fold at 8.2 mm
  CHECK(f.fit.at_bound[1]);
  CHECK_RELATIVE(DuffingForce<double>(f.params).max_depth(), 0.01, 1e-9);
}

TEST_CASE("confidence: the interval holds the truth in about 95 of 100 noisy curves") {
  int first = 0, last = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    const DuffingFit f = fit_duffing(curve(500, 3e6, 0.01, 0.1, seed));
    first += std::abs(f.params.c1 - 500) < f.c1_half_width;
    last += std::abs(f.fit.value[1] - (500 + 9e6 * 1e-4) * 0.01) < f.fit.half_width[1];
  }
  // Binomial, n = 400, p = 0.95: standard deviation 4.4; four of them.
  CHECK(std::abs(first - 380) < 18);
  CHECK(std::abs(last - 380) < 18);
}

TEST_CASE("any law: a power law's factor and exponent, and bounds that hold") {
  std::vector<CurvePoint> points;
  for (int i = 1; i <= 20; ++i) points.push_back({1e-3 * i, 800 * std::pow(1e-3 * i, 1.5), 1});
  const auto power = [](const std::array<double, 2>& p, double d) { return p[0] * std::pow(d, p[1]); };
  const auto fit = fit_curve<2>(points, power, {100, 1}, {0, 0.5}, {1e6, 3});
  CHECK_RELATIVE(fit.value[0], 800, 1e-5);  // stops where the sum of squares falls by less than 1e-14
  CHECK_RELATIVE(fit.value[1], 1.5, 1e-6);
  const auto bounded = fit_curve<2>(points, power, {100, 1}, {0, 0.5}, {1e6, 1.3}, {.worst_rms = 0.5});
  CHECK(bounded.value[1] == 1.3);
  CHECK(bounded.at_bound[1]);
  CHECK(bounded.half_width[1] == 0);
}

TEST_CASE("what cannot be fitted is refused") {
  const auto good = curve(500, 0, 0.01, 0);
  CHECK_THROWS_AS((void)fit_duffing(std::span(good).first(3)), SetupError);
  CHECK_THROWS_AS((void)fit_duffing({}), SetupError);
  auto bad = good;
  bad[7].force = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS((void)fit_duffing(bad), SetupError);
  bad = good;
  bad[7].weight = -1;
  CHECK_THROWS_AS((void)fit_duffing(bad), SetupError);
  std::vector<CurvePoint> zigzag = good;
  for (std::size_t i = 0; i < zigzag.size(); ++i) zigzag[i].force = i % 2 ? 1 : 5;
  CHECK_THROWS_AS((void)fit_duffing(zigzag), SetupError);  // no such law
  const std::vector<CurvePoint> alike(10, {0.005, 2.5, 1});
  CHECK_THROWS_AS((void)fit_duffing(alike), SetupError);  // one depth does not tell c1 from c3
  const auto twice = [](const std::array<double, 2>& p, double d) { return (p[0] + p[1]) * d; };
  CHECK_THROWS_AS((void)fit_curve<2>(good, twice, {100, 100}, {0, 0}, {1e6, 1e6}), SetupError);
  CHECK_THROWS_AS((void)fit_curve<2>(good, twice, {100, 100}, {0, 5}, {1e6, 1}), SetupError);
}

TEST_CASE("what determines no fit is told by the residual where no residual is refused") {
  constexpr double any = std::numeric_limits<double>::infinity();
  const auto good = curve(500, 0, 0.01, 0);
  const auto twice = [](const std::array<double, 2>& p, double d) { return (p[0] + p[1]) * d; };
  CHECK(fit_curve<2>(good, twice, {100, 100}, {0, 0}, {1e6, 1e6}, {.worst_rms = any}).relative_rms == any);
  const std::vector<CurvePoint> alike(10, {0.005, 2.5, 1});
  CHECK(fit_duffing(alike, {.worst_rms = any}).fit.relative_rms == any);
  // One step does not settle.
  const auto line = [](const std::array<double, 1>& p, double d) { return std::exp(p[0]) * d; };
  CHECK_THROWS_AS((void)fit_curve<1>(good, line, {1}, {0}, {10}, {.max_steps = 1}), SetupError);
  CHECK(fit_curve<1>(good, line, {1}, {0}, {10}, {.worst_rms = any, .max_steps = 1}).relative_rms == any);
  std::vector<CurvePoint> zigzag = good;
  for (std::size_t i = 0; i < zigzag.size(); ++i) zigzag[i].force = i % 2 ? 1 : 5;
  const double rms = fit_duffing(zigzag, {.worst_rms = any}).fit.relative_rms;
  CHECK(rms > 0.2);  // no such law, but a fit
  CHECK(rms < 1);
}
