// SPDX-License-Identifier: MIT
// Law (3), harmonic balance and the oscillator (1) it comes from, side by side. The figures are those of
// docs/laws.md.

#include "support/check.hpp"

#include <palpate/law/force/duffing.hpp>

#include <numbers>

using namespace palpate;
using palpate::test::ulps;

namespace {

using Number = long double;
constexpr Number two_pi = 2 * std::numbers::pi_v<Number>;

// x'' + 2 mu x' + a x + b x^3 = A cos(W t)   (1): a = omega_0^2, b = beta_0^2 epsilon. Classical Runge-Kutta.
struct Oscillator {
  Number a, b, mu = 0, A = 0, W = 0;
  Number t = 0, x = 0, v = 0;

  Number acceleration(Number time, Number position, Number speed) const {
    return A * std::cos(W * time) - 2 * mu * speed - (a + b * position * position) * position;
  }
  void step(Number h) {
    const Number v1 = v, a1 = acceleration(t, x, v);
    const Number v2 = v + h / 2 * a1, a2 = acceleration(t + h / 2, x + h / 2 * v1, v2);
    const Number v3 = v + h / 2 * a2, a3 = acceleration(t + h / 2, x + h / 2 * v2, v3);
    const Number v4 = v + h * a3, a4 = acceleration(t + h, x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    t += h;
  }
  void run(Number duration, int steps) {
    for (int i = 0; i < steps; ++i) step(duration / steps);
  }
};

// Amplitude of the fundamental over one period of the drive, once settled.
Number fundamental(Oscillator o, int settle_periods, int steps) {
  const Number period = two_pi / o.W;
  o.run(settle_periods * period, settle_periods * steps);
  Number c = 0, s = 0;
  for (int i = 0; i < steps; ++i) {
    c += o.x * std::cos(o.W * o.t);
    s += o.x * std::sin(o.W * o.t);
    o.step(period / steps);
  }
  return 2 * std::hypot(c, s) / steps;
}

// One-term harmonic balance: A0^2 ((a - W^2 + g b A0^2)^2 + (2 mu W)^2) = A^2, g = 3/4; the only root below
// `high`.
Number harmonic_balance(const Oscillator& o, Number high, Number g = 0.75L) {
  Number low = 0;
  for (int i = 0; i < 100; ++i) {
    const Number m = (low + high) / 2, d = o.a - o.W * o.W + g * o.b * m * m;
    (m * m * (d * d + 4 * o.mu * o.mu * o.W * o.W) > o.A * o.A ? high : low) = m;
  }
  return low;
}

DuffingForce<double> law(Number a, Number b, double factor) {  // mass 1, SI
  return DuffingForce<double>({.c1 = static_cast<double>(a), .c3 = factor * static_cast<double>(b)});
}

}  // namespace

TEST_CASE("oscillator (1): the integrator reproduces Jacobi's cn, undamped and free") {
  struct Row {
    Number a, b, A, period, x1, x2, x10;
  };
  // x = A cn(W t | m), W^2 = a + b A^2, m = b A^2 / (2 W^2), evaluated to 17 digits with 30-digit arithmetic.
  const Row rows[] = {
      {1, 1, 1, 4.7680220291024608L, 0.23369179114314127L, -0.85934935810185523L, 0.79887476899741433L},
      {0.04L, 0.4L, 1, 10.959145563629725L, 0.80017318451404728L, 0.36058151970460835L, 0.81483761035484053L},
      {0, 1, 1, 7.4162987092054877L, 0.59597656767214067L, -0.10318361552776183L, -0.51229003466699252L},
      {1, -0.5L, 1, 8.0086190436488499L, 0.7425287172921059L, 0.0018660762450273856L, 0.0093302079447638496L},
  };
  for (const Row& r : rows) {
    INFO("a ", r.a, " b ", r.b);
    const auto at = [&](Number t) {
      Oscillator o{.a = r.a, .b = r.b, .x = r.A};
      o.run(t, static_cast<int>(2000 * std::ceil(t)));
      return o.x;
    };
    // Step 5e-4, fourth order: error about 1e-13.
    CHECK_ABSOLUTE(at(1), r.x1, 1e-12);
    CHECK_ABSOLUTE(at(2), r.x2, 1e-12);
    CHECK_ABSOLUTE(at(10), r.x10, 1e-12);
    CHECK_ABSOLUTE(at(r.period), r.A, 1e-12);
  }
  // The paper's row in the time it takes: one-term harmonic balance, W^2 = a + 3/4 b A^2, is 1.70 % too fast;
  // the worst hardening case, a = 0, 2.22 %.
  const auto excess = [](const Row& r) {
    return std::sqrt(r.a + 0.75L * r.b * r.A * r.A) * r.period / two_pi - 1;
  };
  CHECK_ABSOLUTE(excess(rows[0]), 0.0039, 1e-4);
  CHECK_ABSOLUTE(excess(rows[1]), 0.0170, 1e-4);
  CHECK_ABSOLUTE(excess(rows[2]), 0.0222, 1e-4);
}

TEST_CASE("oscillator (1): a constant load settles at factor 1; law (3) with 3/4 goes deeper") {
  struct Row {
    Number r;       // c3 D^2 / c1 at the settled depth
    double deeper;  // depth of (3) over the settled depth
  };
  // r against the ratio of depths; the limit is (4/3)^(1/3) = 1.1006.
  const Row rows[] = {{0.01L, 1.00244}, {0.1L, 1.02033}, {1, 1.07313}, {10, 1.09707}};
  for (const Row& row : rows) {
    const Number a = 1, b = row.r, load = a + b;  // settles at x = 1
    Oscillator o{.a = a, .b = b, .mu = 0.7L * std::sqrt(a + 3 * b), .A = load, .W = 0};
    o.run(60, 60000);
    CHECK_RELATIVE(o.x, 1, 1e-9);  // exp(-mu t) has died out
    CHECK_RELATIVE(law(a, b, 1).depth(static_cast<double>(load)), o.x, 1e-9);
    const double ratio = law(a, b, 0.75).depth(static_cast<double>(load)) / static_cast<double>(o.x);
    MESSAGE("r = ", static_cast<double>(row.r), ": depth of (3) / settled depth = ", ratio);
    CHECK_ABSOLUTE(ratio, row.deeper, 1e-5);  // the figures of docs/laws.md
    // The other way round, at a given depth: force of (3) below the static force by 25 % of r/(1+r).
    const double deficit = 1 - law(a, b, 0.75).force(1) / law(a, b, 1).force(1);
    CHECK_RELATIVE(deficit, 0.25L * row.r / (1 + row.r), 1e-12);
  }
}

TEST_CASE("oscillator (1): a slow cosine load follows factor 1 as well, not the harmonic balance") {
  // a = b = 1, load amplitude 2: factor 1 gives 1, (3) gives 1.0731. Drive 500 times slower than omega_0.
  Oscillator o{.a = 1, .b = 1, .mu = 0.5L, .A = 2, .W = 0.002L, .x = 1};
  const Number period = two_pi / o.W;
  Number peak = 0;
  for (int i = 0; i < 300000; ++i) {
    o.step(1.2L * period / 300000);
    if (o.t > 0.8L * period) peak = std::fmax(peak, o.x);
  }
  MESSAGE("peak under a slow cosine load: ", static_cast<double>(peak));
  CHECK_ABSOLUTE(peak, 1, 2e-5);  // lag of the order (2 mu W / stiffness)^2
  CHECK_ABSOLUTE(law(1, 1, 0.75).depth(2), 1.07313, 1e-5);
}

TEST_CASE("oscillator (1): near resonance harmonic balance with 3/4 is the amplitude") {
  // Case 37 of duffing_time_cases.csv: m = 0.1 kg, omega_0 = 60, beta_0^2 epsilon = 5e5, zeta = 0.1, 0.73 N
  // at 66 rad/s.
  const Oscillator o{.a = 3600, .b = 5e5L, .mu = 6, .A = 7.3L, .W = 66};
  const Number amplitude = fundamental(o, 80, 400);
  const Number balance = harmonic_balance(o, 0.02L);
  CHECK_RELATIVE(amplitude, 0.00673925549L, 1e-8);  // the file's ten digits
  CHECK_RELATIVE(balance, 0.006739244588L, 1e-9);
  CHECK_RELATIVE(balance, amplitude, 2e-6);
  // Strongly nonlinear, r = 1 at amplitude 1: there 3/4 is right to 1 %, factor 1 is not.
  const Oscillator strong{.a = 1, .b = 1, .mu = 0.05L, .A = 0.3L, .W = 1.2L};
  const Number exact = fundamental(strong, 200, 400);
  const Number three_quarters = harmonic_balance(strong, 1);
  const Number one = harmonic_balance(strong, 1, 1);
  MESSAGE("amplitude at W = 1.2: oscillator ", static_cast<double>(exact), ", harmonic balance with 3/4 ",
          static_cast<double>(three_quarters), ", with 1 ", static_cast<double>(one));
  CHECK_RELATIVE(three_quarters, exact, 0.01);
  CHECK(one < 0.93L * exact);
}

TEST_CASE("the three readings of the paper's law at its own constants") {
  // F in N, D = 1 mm: (3) 0.340; static 0.440; (2) before truncation, m (w0 + 3 eps b0^2 D^2/(8 w0))^2 D,
  // 0.9025.
  const Number w0 = 0.2L, b = 0.4L, D = 1;
  CHECK_RELATIVE(law(w0 * w0, b, 0.75).force(1), 0.34, ulps<double>(4));
  CHECK_RELATIVE(law(w0 * w0, b, 1).force(1), 0.44, ulps<double>(4));
  const Number w = w0 + 3 * b * D * D / (8 * w0);
  CHECK_RELATIVE(w * w * D, 0.9025, 1e-15);  // the D^5 term that (3) drops is larger than what it keeps
}
