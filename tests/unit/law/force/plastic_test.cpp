// SPDX-License-Identifier: MIT
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/plastic.hpp>

#include <support/check.hpp>

#include <string>

using namespace palpate;
using palpate::test::ulps;

namespace {

using Putty = PlasticForce<LinearForce<double>>;
const LinearForce<double> spring({.k = 1000});

Putty::State pressed(const Putty& law, double depth) { return law.advance({}, depth, 1e-3); }

}  // namespace

TEST_CASE("plastic: below yield nothing stays; beyond it F follows the line, unloading the law, shifted") {
  const Putty putty(spring, {.yield_force = 2, .hardening = 200, .extent = 0.01});
  CHECK(pressed(putty, 2e-3).set == 0);  // law(2 mm) = F_y
  const Putty::State dent = pressed(putty, 7e-3);
  // By hand: Y(7 mm) = 2 + 200 * 5 mm = 3 N; 3 mm of it are elastic, 4 mm stay.
  CHECK_RELATIVE(putty.force(7e-3, dent), 3.0, ulps<double>(8));
  CHECK_RELATIVE(dent.set, 4e-3, ulps<double>(8));
  CHECK_RELATIVE(putty.force(5e-3, dent), 1.0, ulps<double>(32));  // 5 mm - 4 mm
  CHECK(putty.force(4e-3 - 1e-12, dent) == 0);
  CHECK(putty.stiffness(5e-3, dent) == 1000);
  CHECK_RELATIVE(putty.depth(1, dent), 5e-3, ulps<double>(8));
  CHECK_RELATIVE(putty.energy(7e-3, dent), 3.0 * 3.0 / 2000, ulps<double>(32));
  // Loaded again it is elastic up to where it was, then yields on.
  CHECK(putty.advance(dent, 6.9e-3, 1).set == dent.set);
  CHECK_RELATIVE(putty.force(12e-3, putty.advance(dent, 12e-3, 1)), 4.0, ulps<double>(8));
}

TEST_CASE("plastic: the set depends on the deepest point alone, not on the way or on dt") {
  const DuffingForce<double> stiffening({.c1 = 400, .c3 = 3e7});
  const PlasticForce<DuffingForce<double>> law(stiffening,
                                               {.yield_force = 1, .hardening = 100, .extent = 0.01});
  PlasticForce<DuffingForce<double>>::State way{};
  for (const double depth : {1e-3, 4e-3, 0.0, 2e-3, 6e-3, 5e-3}) way = law.advance(way, depth, depth);
  CHECK(way.set == law.advance({}, 6e-3, 1).set);
  // Return mapping: F is on the yield line.
  CHECK_RELATIVE(law.force(6e-3, way), 1 + 100 * (6e-3 - stiffening.depth(1)), ulps<double>(64));
}

TEST_CASE("plastic: what the user puts in and does not get back is F ds") {
  const Putty putty(spring, {.yield_force = 2, .hardening = 0, .extent = 0.01});
  Putty::State state{};
  double work = 0, before = 0, last = 0;
  const auto go = [&](double from, double to) {
    for (int i = 1; i <= 1000; ++i) {
      const double depth = from + (to - from) * i / 1000;
      state = putty.advance(state, depth, 1e-3);
      const double now = putty.force(depth, state);
      work += 0.5 * (before + now) * (depth - last);
      before = now;
      last = depth;
    }
  };
  go(0, 5e-3);
  go(5e-3, 0);
  CHECK_RELATIVE(work, 2 * 3e-3, 1e-5);  // F_y s by hand; the trapezoid cuts two corners of 2 N 5 um/8
}

TEST_CASE("plastic: a law that never reaches the yield force stays as it is") {
  const DuffingForce<double> softening({.c1 = 400, .c3 = -1e7});  // at most 0.97 N
  const PlasticForce<DuffingForce<double>> law(softening, {.yield_force = 2, .extent = 0.01});
  CHECK(law.advance({}, 0.1, 1).set == 0);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("plastic: bad parameters are refused by name and value") {
  const auto message = [](double yield, double hardening, double extent) {
    try {
      Putty(spring, {.yield_force = yield, .hardening = hardening, .extent = extent});
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message(1, 0, 0.01).empty());
  CHECK(message(0, 0, 0.01) == "PlasticForce: yield_force [N] must be > 0 and finite, got 0");
  CHECK(message(1, -1, 0.01) == "PlasticForce: hardening [N/m] must be >= 0 and finite, got -1");
  CHECK(message(1, 1000, 0.01) ==
        "PlasticForce: hardening [N/m] must be below the law's stiffness at the yield force, got 1000");
  CHECK(message(1, 0, 0) == "PlasticForce: extent [m] must be > 0 and finite, got 0");
}
#endif
