// SPDX-License-Identifier: MIT
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/law/friction/slip.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

using namespace palpate;

namespace {

// Paper's law in SI (section VII) and a dry pair with a marked drop at breakaway.
const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});
const CoulombFriction<double> dry({.mu_static = 0.6, .mu_dynamic = 0.3});

template <class Slip, class Skew>
SlipResult<double> push(SlipState<double>& state, double stretch, double before, double travel,
                        double normal_force = 1.0) {
  const double depth = law.depth(normal_force);
  return Slip::advance(dry, Skew{}, law, {depth, normal_force, stretch, before, travel}, state);
}

}  // namespace

TEST_CASE("below the static limit the contact sticks: force is the law's, stretch untouched") {
  SlipState<double> state;
  const double stretch = law.depth(0.59);
  const auto now = push<ReturnMapping, ByComponents>(state, stretch, 0, stretch);
  CHECK_FALSE(state.sliding);
  CHECK(now.stretch == stretch);
  CHECK(now.force.tangential == law.force(stretch));
  CHECK(now.force.normal == 1.0);
}

TEST_CASE(
    "return mapping: friction starts at the static limit and wears off to the sliding one with travel") {
  SlipState<double> state;
  const double start = law.depth(0.6), step = 1e-6;
  double stretch = start, force = 0.6, largest_drop = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto now = push<ReturnMapping, ByComponents>(state, stretch + step, stretch, step);
    largest_drop = (std::max)(largest_drop, force - now.force.tangential);
    stretch = now.stretch;
    force = now.force.tangential;
  }
  CHECK(state.sliding);
  CHECK_RELATIVE(force, 0.3, 1e-6);  // the excess decays as a power of the travel over 20 mm = 20 stretches
  // Documented bound: the drop per tick is at most the secant stiffness times the travel.
  CHECK(largest_drop <= 0.6 / start * step * 1.01);
  CHECK(largest_drop > 0);
}

TEST_CASE("return mapping: elastic force equals the friction after every slip") {
  SlipState<double> state{true, 1.0, 0.0};
  for (const double normal_force : {1e-6, 1e-3, 1.0, 50.0}) {
    const auto now = push<ReturnMapping, ByComponents>(state, 0.1, 0.05, 0.05, normal_force);
    CHECK_RELATIVE(law.force(now.stretch), 0.3 * normal_force,
                   test::ulps<double>(64));  // inverse of the law, then the law
  }
}

TEST_CASE(
    "return mapping: going back by a tenth of the stretch restores the static limit without a force step") {
  const double stretch = law.depth(0.3);
  SlipState<double> state{true, 1.0, stretch};
  const auto rest = push<ReturnMapping, ByComponents>(state, stretch, stretch, 0);
  CHECK(state.sliding);  // a stop, or one step of an encoder, is not a reversal
  CHECK_RELATIVE(rest.force.tangential, 0.3, test::ulps<double>(16));
  const auto little = push<ReturnMapping, ByComponents>(state, 0.91 * stretch, stretch, 0.09 * stretch);
  CHECK(state.sliding);  // nor is less than a tenth
  CHECK(little.force.tangential == law.force(0.91 * stretch));
  const auto back = push<ReturnMapping, ByComponents>(state, 0.89 * stretch, stretch, 0.11 * stretch);
  CHECK_FALSE(state.sliding);
  CHECK(back.force.tangential == law.force(0.89 * stretch));  // elastic all the way
  const auto again = push<ReturnMapping, ByComponents>(state, law.depth(0.55), 0.89 * stretch, 1e-4);
  CHECK_FALSE(state.sliding);
  CHECK_RELATIVE(again.force.tangential, 0.55, test::ulps<double>(16));
}

TEST_CASE("return mapping: springs of merged regions push together, and a slip lets the surplus go first") {
  const double stretch = law.depth(0.2);
  SlipState<double> state;
  state.springs = 2;
  const auto stuck = push<ReturnMapping, ByComponents>(state, stretch, stretch, 0);
  CHECK_FALSE(state.sliding);
  CHECK_RELATIVE(stuck.force.tangential, 0.4, test::ulps<double>(16));
  CHECK(state.springs == 2);
  // 2 x 0.4 N is above the static limit, 0.6 N: 1.5 springs at the same stretch are not.
  const double further = law.depth(0.4);
  const auto slips = push<ReturnMapping, ByComponents>(state, further, further, 0);
  CHECK(state.sliding);
  CHECK(slips.stretch == further);
  CHECK_RELATIVE(state.springs, 1.5, test::ulps<double>(16));
  CHECK_RELATIVE(slips.force.tangential, 0.6, test::ulps<double>(16));
  // Far on, one spring is left at the sliding limit.
  double at = further;
  for (int i = 0; i < 20000; ++i) at = push<ReturnMapping, ByComponents>(state, at + 1e-6, at, 1e-6).stretch;
  CHECK(state.springs == 1);
  CHECK_RELATIVE(law.force(at), 0.3, 1e-6);
}

TEST_CASE("return mapping: strength that regions left is over the static limit after a stop") {
  const double stretch = law.depth(0.3);
  SlipState<double> state{true, 3.0, stretch};  // slides at three times its limit, 0.9 N
  (void)push<ReturnMapping, ByComponents>(state, 0.5 * stretch, stretch, 0);
  CHECK_FALSE(state.sliding);
  CHECK_RELATIVE(state.strength, 1.5, test::ulps<double>(16));  // the same 0.9 N over 0.6 N
}

TEST_CASE("return mapping: what is left of the static limit is that of the present load") {
  // f_max/f_slide is 2.8 at 0.2 N and 1 at 13 N, where a factor that is kept would give 10.9 N.
  const PowerLawFriction<double> fibre({.K = 0.56, .beta = 0.75, .mu_dynamic = 0.3});
  SlipState<double> state;
  double stretch = 0;
  for (const double normal_force : {0.2, 1.0, 4.0, 13.0, 1.0, 0.2}) {
    const auto now =
        ReturnMapping::advance(fibre, ByComponents{}, law,
                               {law.depth(normal_force), normal_force, stretch + 0.01, stretch, 1e-9}, state);
    stretch = now.stretch;
    CHECK(state.sliding);
    CHECK_RELATIVE(now.force.tangential, fibre.static_limit(normal_force), 1e-5);  // 1e-9 m of travel
  }
  for (int i = 0; i < 100; ++i)
    stretch = ReturnMapping::advance(fibre, ByComponents{}, law,
                                     {law.depth(0.2), 0.2, stretch + 1e-3, stretch, 1e-3}, state)
                  .stretch;
  CHECK(state.static_share == 0);
  CHECK_RELATIVE(law.force(stretch), 0.06, test::ulps<double>(16));
}

TEST_CASE("literal shift: as printed, D_t keeps its last value and friction drops at once") {
  SlipState<double> state;
  const double before = law.depth(0.59), trial = law.depth(0.61);
  const auto now = push<LiteralShift, ByComponents>(state, trial, before, trial - before);
  CHECK(state.sliding);
  CHECK(now.stretch == before);
  CHECK_RELATIVE(now.force.tangential, 0.3, test::ulps<double>(4));
}

TEST_CASE("no normal force: no friction, whatever the stretch") {
  for (const double stretch : {0.0, 1e-12, 1e-3}) {
    SlipState<double> state;
    const auto now = push<ReturnMapping, ByComponents>(state, stretch, 0, stretch, 0.0);
    CHECK(now.force.tangential == 0);
    CHECK(now.stretch == 0);
  }
}

TEST_CASE("skew rules agree for a linear law and differ by the cubic term otherwise") {
  const LinearForce<double> linear({.k = 500});
  const double depth = 2e-3, stretch = 1e-3;
  const auto parts = ByComponents::force(linear, depth, linear.force(depth), stretch);
  const auto radial = Radial::force(linear, depth, linear.force(depth), stretch);
  CHECK_RELATIVE(radial.normal, parts.normal, test::ulps<double>(8));
  CHECK_RELATIVE(radial.tangential, parts.tangential, test::ulps<double>(8));

  // At 45 degrees with c1 = 0 the radial force is |D|^2/D_n^2 = 2 times the component-wise one.
  const DuffingForce<double> cubic({.c1 = 0, .c3 = 1e8});
  const auto a = ByComponents::force(cubic, depth, cubic.force(depth), depth);
  const auto b = Radial::force(cubic, depth, cubic.force(depth), depth);
  CHECK_RELATIVE(b.normal / a.normal, 2.0, test::ulps<double>(16));
  CHECK_RELATIVE(b.tangential / a.tangential, 2.0, test::ulps<double>(16));
}

TEST_CASE("radial rule: a Coulomb contact slips at the friction angle") {
  SlipState<double> state{true, 1.0, 0.0};
  const double depth = law.depth(1.0);
  const auto now = push<ReturnMapping, Radial>(state, 10 * depth, 9 * depth, depth);
  CHECK_RELATIVE(now.stretch / depth, 0.3, test::ulps<double>(16));  // tan(phi) = mu_D
  CHECK_RELATIVE(now.force.tangential, 0.3 * now.force.normal, test::ulps<double>(16));
}

TEST_CASE("stretch() inverts force() for both skew rules") {
  const double depth = 1.5e-3, normal_force = law.force(depth);
  for (const double f : {1e-9, 1e-3, 0.4, 30.0}) {
    CHECK_RELATIVE(
        ByComponents::force(law, depth, normal_force, ByComponents::stretch(law, depth, f)).tangential, f,
        test::ulps<double>(64));
    // Bisection stops at 2^-60 of the bracket, which may be many times the small roots.
    CHECK_RELATIVE(Radial::force(law, depth, normal_force, Radial::stretch(law, depth, f)).tangential, f,
                   1e-9);
  }
}
