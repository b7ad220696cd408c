// SPDX-License-Identifier: MIT
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/relaxing.hpp>

#include <support/check.hpp>

#include <array>
#include <cmath>
#include <string>

using namespace palpate;
using palpate::test::ulps;

namespace {

using One = RelaxingForce<LinearForce<double>>;
using Three = RelaxingForce<DuffingForce<double>, 3>;
const LinearForce<double> spring({.k = 1000});
const DuffingForce<double> rubber({.c1 = 400, .c3 = 3e7});
const One solid(spring, {.terms = {{{0.6, 0.1}}}, .extent = 0.01});
const Three tissue(rubber, {.terms = {{{0.2, 0.01}, {0.3, 0.1}, {0.25, 1.0}}}, .extent = 0.01});

}  // namespace

TEST_CASE("relaxing: a step gives the law at once, G(t) of it later, whatever the ticks") {
  for (const double dt : {1e-4, 1e-3, 0.02, 0.5}) {
    Three::State state = tissue.advance({}, 5e-3, 0);  // no time passes: a step
    CHECK(tissue.force(5e-3, state) == rubber.force(5e-3));
    double t = 0;
    for (int i = 0; i < 50; ++i) {
      state = tissue.advance(state, 5e-3, dt);
      t += dt;
      const double G = 0.25 + 0.2 * std::exp(-t / 0.01) + 0.3 * std::exp(-t / 0.1) + 0.25 * std::exp(-t);
      CHECK_RELATIVE(tissue.force(5e-3, state), G * rubber.force(5e-3),
                     ulps<double>(200));  // 50 ticks' roundings
    }
  }
}

TEST_CASE("relaxing: at a constant rate the closed form, whatever the ticks") {
  // F = k v (g_inf t + g tau (1 - exp(-t/tau))), by hand from the hereditary integral.
  for (const double dt : {1e-4, 1e-2, 0.3}) {
    One::State state{};
    for (int i = 1; i <= 40; ++i) {
      const double t = dt * i, v = 0.02;
      state = solid.advance(state, v * t, dt);
      CHECK_RELATIVE(solid.force(v * t, state), 1000 * v * (0.4 * t - 0.6 * 0.1 * std::expm1(-t / 0.1)),
                     ulps<double>(200));
    }
  }
}

TEST_CASE("relaxing: left faster than it recovers, contact is lost; the body comes back and is met again") {
  One::State state = solid.advance({}, 5e-3, 0);
  for (int i = 0; i < 1000; ++i) state = solid.advance(state, 5e-3, 0.01);  // 100 times its time
  CHECK_RELATIVE(solid.force(5e-3, state), 0.4 * 5, ulps<double>(64));
  state = solid.advance(state, 0, 0);  // at once
  CHECK(solid.force(0, state) == 0);
  CHECK_RELATIVE(solid.depth(0, state), 0.6 * 5e-3, ulps<double>(64));
  CHECK(solid.force(2.9e-3, state) == 0);
  CHECK(solid.force(3.1e-3, state) > 0);
  // Free recovery by hand: s' = -(1 - g) s/tau, here 0.3 s in ticks of 1 ms.
  for (int i = 0; i < 300; ++i) state = solid.advance(state, 0, 1e-3);
  CHECK_RELATIVE(solid.depth(0, state), 0.6 * 5e-3 * std::exp(-0.4 * 0.3 / 0.1),
                 1e-4);  // straight in a tick: (dt/tau)^2
}

TEST_CASE("relaxing: against a fine integration of its equation, pressed, held and left") {
  const auto depth_at = [](double t) {
    return (std::max)(0.0, 5e-3 * std::sin(3 * t) + 2e-3 * std::sin(17 * t));
  };
  const double part[3] = {0.2, 0.3, 0.25}, time[3] = {0.01, 0.1, 1.0};
  std::array<double, 3> s{};
  Three::State state{};
  double worst = 0;
  constexpr double dt = 1e-3, fine = dt / 200;
  double t = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    double lost = 0;
    for (int i = 0; i < 200; ++i) {  // Heun's rule; without contact the force is what makes F vanish
      t += fine;
      const auto slope = [&](const std::array<double, 3>& x, double when, std::array<double, 3>& rate) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += part[k] * x[std::size_t(k)];
        const double u = (std::max)(rubber.force(depth_at(when)), sum);
        for (std::size_t k = 0; k < 3; ++k) rate[k] = (u - x[k]) / time[k];
      };
      std::array<double, 3> a, b, x;
      slope(s, t - fine, a);
      for (std::size_t k = 0; k < 3; ++k) x[k] = s[k] + fine * a[k];
      slope(x, t, b);
      for (std::size_t k = 0; k < 3; ++k) s[k] += fine / 2 * (a[k] + b[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) lost += part[k] * s[k];
    state = tissue.advance(state, depth_at(t), dt);
    const double reference = (std::max)(rubber.force(depth_at(t)) - lost, 0.0);
    worst = (std::max)(worst, std::abs(tissue.force(depth_at(t), state) - reference));
  }
  // Ticks a tenth of the shortest time: where contact is lost within one, up to a tenth of a tick's change of
  // F.
  CHECK(worst <= 2e-3 * rubber.force(7e-3));
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("relaxing: bad parameters are refused by name and value") {
  const auto message = [](double part, double time, double extent) {
    try {
      One(spring, {.terms = {{{part, time}}}, .extent = extent});
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message(0.5, 1, 0.01).empty());
  CHECK(message(0, 1, 0.01) == "RelaxingForce: part [-] of a term must be > 0 and finite, got 0");
  CHECK(message(0.5, -1, 0.01) == "RelaxingForce: time [s] of a term must be > 0 and finite, got -1");
  CHECK(message(1, 1, 0.01) == "RelaxingForce: the parts [-] must add up to less than 1, got 1");
  CHECK(message(0.5, 1, 0) == "RelaxingForce: extent [m] must be > 0 and finite, got 0");
}
#endif
