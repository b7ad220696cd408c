// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/saturated.hpp>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE("saturated: the law's own bits up to the knee, the limit beyond, continuous slope", S,
                   float, double) {
  const DuffingForce<S> law({.c1 = S(40), .c3 = S(3e8)});
  const SaturatedForce capped(law, {.limit = S(3), .knee = S(0.8)});
  const S knee = law.depth(S(2.4));
  for (int i = 0; i <= 100; ++i) {
    const S d = knee * static_cast<S>(i) / S(100);
    CHECK(capped.force(d) == law.force(d));
    CHECK(capped.stiffness(d) == law.stiffness(d));
    CHECK_RELATIVE(capped.energy(d), law.energy(d),
                   test::ulps<S>(4));  // a compiler may contract a b + c in one place only
  }
  const S after = knee * (S(1) + S(2) * std::numeric_limits<S>::epsilon());
  CHECK_RELATIVE(capped.force(after), law.force(knee), ulps<S>(16));
  CHECK_RELATIVE(capped.stiffness(after), law.stiffness(knee), ulps<S>(64));
  CHECK_RELATIVE(capped.energy(after), law.energy(knee), ulps<S>(16));
  CHECK_ABSOLUTE(capped.stiffness(capped.max_depth() * (S(1) - S(1e-4))), 0, S(1e-3) * law.stiffness(knee));
  // Never above the limit, also in rounding.
  int above = 0;
  for (int i = 0; i <= 5000; ++i) {
    if (!(capped.force(S(2) * capped.max_depth() * static_cast<S>(i) / S(5000)) <= S(3))) ++above;
  }
  CHECK(above == 0);
  CHECK(capped.force(S(1)) == S(3));
}

TEST_CASE_TEMPLATE("saturated: depth is the inverse of force below, above and at the knee", S, float,
                   double) {
  const SaturatedForce capped(DuffingForce<S>({.c1 = S(40), .c3 = S(3e8)}), {.limit = S(3), .knee = S(0.8)});
  for (const S f : {S(0.1), S(2.3), S(2.4), S(2.401), S(2.7), S(2.9), S(2.99)}) {
    INFO(f);
    CHECK(capped.depth(f) < capped.max_depth());
    CHECK_RELATIVE(capped.force(capped.depth(f)), f, ulps<S>(16));
  }
  CHECK(capped.depth(S(3)) == capped.max_depth());
}

TEST_CASE("saturated: a law that stays within the limit is left alone") {
  const DuffingForce<double> soft({.c1 = 40, .c3 = -7e4});  // 0.37 N at most
  const SaturatedForce capped(soft, {.limit = 0.4});
  CHECK(capped.max_depth() == soft.max_depth());
  for (const double d : {1e-4, 0.01, soft.max_depth(), 1.0}) CHECK(capped.force(d) == soft.force(d));
  CHECK(capped.depth(0.39) == soft.max_depth());
  // Just below its maximum the cap works on the stable branch.
  const SaturatedForce lower(soft, {.limit = 0.36, .knee = 0.9});
  CHECK(lower.force(1.0) == 0.36);
  CHECK(lower.max_depth() > soft.depth(0.9 * 0.36));
}

TEST_CASE_TEMPLATE("damped: hunt-crossley has no step on entry, the literal viscous term has one", S, float,
                   double) {
  const DuffingForce<S> law({.c1 = S(400), .c3 = S(3e6)});
  const DampedForce hunt_crossley(law, {.damping = S(0.5)});
  const DampedForce<DuffingForce<S>, Viscous> viscous(law, {.damping = S(2)});
  const S touch = S(1e-9), speed = S(0.1);
  CHECK_ABSOLUTE(hunt_crossley.force(touch, speed), 0, 1e-6);
  CHECK_RELATIVE(viscous.force(touch, speed), S(2) * speed, 1e-5);  // 0.2 N at once
  const S d = S(0.003);
  CHECK_RELATIVE(hunt_crossley.force(d, speed), law.force(d) * (S(1) + S(1.5) * S(0.5) * speed), ulps<S>(2));
  CHECK_RELATIVE(viscous.force(d, speed), law.force(d) + S(2) * speed, ulps<S>(2));
  for (const S rate : {S(0), std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity(),
                       -std::numeric_limits<S>::infinity()}) {
    CHECK(hunt_crossley.force(d, rate) == law.force(d));
    CHECK(viscous.force(d, rate) == law.force(d));
  }
  // So are rates that only a step of next to no time can have: the total would not be a number.
  const S absurd = std::numeric_limits<S>::max();
  CHECK(DampedForce(law, {.damping = S(3)}).force(d, absurd) == law.force(d));
  CHECK(viscous.force(d, absurd) == law.force(d));
  // Leaving fast: never pulls. Out of contact: nothing, at any rate.
  CHECK(hunt_crossley.force(d, S(-10)) == S(0));
  CHECK(viscous.force(d, S(-10)) == S(0));
  for (const S out : {S(0), S(-1e-3), std::numeric_limits<S>::quiet_NaN()}) {
    CHECK(hunt_crossley.force(out, S(1)) == S(0));
    CHECK(viscous.force(out, S(1)) == S(0));
  }
}

TEST_CASE("damped: a press and release takes energy from the hand") {
  const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});
  const double period = 0.2, peak = 0.002;
  const auto work = [&](const auto& damped) {
    double sum = 0;
    const int n = 4000;
    for (int i = 0; i < n; ++i) {  // D = peak sin^2(pi t / T), midpoint rule
      const double phase = 2 * 3.141592653589793 * (i + 0.5) / n;
      const double depth = peak * (1 - std::cos(phase)) / 2,
                   rate = peak * std::sin(phase) * 3.141592653589793 / period;
      sum += damped.force(depth, rate) * rate * period / n;
    }
    return sum;
  };
  CHECK(work(DampedForce(law, {.damping = 2})) > 1e-6);
  CHECK(work(DampedForce<DuffingForce<double>, Viscous>(law, {.damping = 2})) > 1e-6);
  CHECK_ABSOLUTE(work(DampedForce(law, {.damping = 0})), 0,
                 1e-12);  // conservative; quadrature of a smooth period
}

TEST_CASE("damped outside saturated: the elastic part is capped") {
  const DampedForce law(SaturatedForce(DuffingForce<double>({.c1 = 40, .c3 = 3e8}), {.limit = 3}),
                        {.damping = 0.5});
  static_assert(RateDependentForceLaw<std::remove_const_t<decltype(law)>>);
  CHECK(law.force(1.0, 0.0) == 3);
  CHECK_RELATIVE(law.force(1.0, 0.1), 3 * 1.075, ulps<double>(2));
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("decorators: bad parameters are refused by name and value") {
  const DuffingForce<double> law({.c1 = 40});
  using Capped = SaturatedForce<DuffingForce<double>>;
  using Damped = DampedForce<DuffingForce<double>>;
  CHECK_THROWS_WITH_AS(Capped(law, {.limit = 0}), "SaturatedForce: limit [N] must be > 0 and finite, got 0",
                       SetupError);
  CHECK_THROWS_WITH_AS(Capped(law, {.limit = 3, .knee = 1}),
                       "SaturatedForce: knee [-] must be in (0, 1), got 1", SetupError);
  CHECK_THROWS_WITH_AS(Damped(law, {.damping = -1}), "DampedForce: damping must be >= 0 and finite, got -1",
                       SetupError);
}
#endif
