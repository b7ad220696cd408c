// SPDX-License-Identifier: MIT
// Force laws with memory under regions that feel each other through the body.
#include <palpate/geometry/box.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include <support/pins.hpp>

#include <random>
#include <string>

using namespace palpate;
using V = Vec3<double>;

namespace {

const Box<double> block({.half = V(0.05, 0.05, 0.05)});
using Spring = LinearForce<double>;
using Duffing = DuffingForce<double>;
const Spring spring({.k = 1000});
const PlasticForce<Spring> putty(spring, {.yield_force = 2, .hardening = 200, .extent = 4e-3});
const PlasticForce<Duffing> dough(Duffing({.c1 = 300, .c3 = 1e8}),
                                  {.yield_force = 0.5, .hardening = 100, .extent = 4e-3});
const RelaxingForce<Spring> gel(spring, {.terms = {{{0.6, 0.1}}}, .extent = 4e-3});
const RelaxingForce<Duffing, 2> flesh(Duffing({.c1 = 300, .c3 = 1e8}),
                                      {.terms = {{{0.3, 0.02}, {0.4, 0.3}}}, .extent = 4e-3});

template <class Law, class Coupling = CompliantRegions<>>
auto pins(const Law& law) {
  return ContactSolver<Box<double>, Law, Frictionless<double>, Regions<4, AreaSharing>, NoDeformation<double>,
                       AtContact, Coupling>({.object = block,
                                             .tool = test::pins(3e-3, {-5e-3, 5e-3}),
                                             .force = law,
                                             .contacts = {.distance = 1.3e-3}});
}

/// With the pins' tips `depth` [m] inside, rocked about z and shifted along x.
Pose<double> at(double depth, double rock = 0, double shift = 0) {
  Pose<double> X;
  X.rotation = test::rotation_about<double>(V::UnitZ(), rock);
  X.translation = V(shift, 0.05 - depth, 0);
  return X;
}

/// What the tool did to the hand, by the trapezoidal rule [J].
template <class Solver>
struct Work {
  Solver solver;
  Pose<double> last = at(-1);
  Wrench<double> before{};
  double done = 0, gross = 0;

  Wrench<double> go(const Pose<double>& X, double dt) {
    const Wrench<double> now = solver.tick(X, dt).wrench;
    const Mat3<double> turn = X.rotation * last.rotation.transpose();
    const double step =
        0.5 * (now.force + before.force).dot(X.translation - last.translation) +
        0.25 * (now.torque + before.torque)
                   .dot(V(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)));
    done += step;
    gross += std::abs(step);
    last = X, before = now;
    return now;
  }
};

template <class Law>
void check_one_pin(const Law& law) {
  auto coupled = pins(law);
  auto alone = pins<Law, IndependentRegions>(law);
  for (int i = 0; i <= 400; ++i) {  // the left pin only, in and out and in
    const Pose<double> X = at(-2.5e-3 + 3e-3 * std::sin(0.03 * i), 0.6);
    const auto felt = coupled.tick(X, 1e-3), expected = alone.tick(X, 1e-3);
    CHECK(coupled.contacts().size() <= 1);
    CHECK_RELATIVE(felt.wrench.force.y(), expected.wrench.force.y(), 1e-12);
    CHECK_RELATIVE(felt.wrench.torque.z(), expected.wrench.torque.z(), 1e-12);
  }
  CHECK(alone.contacts().size() == 1);
}

/// A path that presses, rocks and shifts at random, from out of the body to out of it.
template <class Law>
void check_gains_nothing(const std::string& name, const Law& law) {
  std::mt19937_64 random(20050616);  // fixed seed
  std::uniform_real_distribution<double> any(-1, 1);
  double most = -1, lost = 0;
  for (int path = 0; path < 30; ++path) {
    const double second = std::pow(10, 1.5 * any(random));  // a path takes 0.03 to 30 s
    const double tau = 6.28318530717958648, turns = 2 + path % 4, p = tau * any(random),
                 q = tau * any(random);
    const double deep = 1.5e-3 + 1e-3 * any(random), rock = 0.2 * any(random);
    Work<decltype(pins(law))> work{pins(law)};
    constexpr int steps = 3000;
    for (int i = 0; i <= steps; ++i) {
      const double t = double(i) / steps, in = std::sin(0.5 * tau * t);
      work.go(at(-2e-3 + (2e-3 + deep) * in + 1e-3 * in * std::sin(turns * tau * t + p),
                 rock * in * std::sin((turns + 1) * tau * t + q), 1e-3 * std::sin(tau * t)),
              second / steps);
    }
    REQUIRE(work.before.force.norm() == 0);
    most = (std::max)(most, work.done / work.gross);
    lost = (std::min)(lost, work.done / work.gross);
  }
  MESSAGE(name, ": of the work that goes in and out, the hand gets at most ", most, ", least ", lost);
  CHECK(most <= 1e-5);  // where nothing yields what is left is the trapezoid's square of the step
  CHECK(lost < -0.1);   // it is a path on which the law loses energy
}

}  // namespace

TEST_CASE("a single pin on a body with memory: the coupling changes nothing") {
  check_one_pin(putty);
  check_one_pin(dough);
  check_one_pin(gel);
  check_one_pin(flesh);
}

TEST_CASE("two pins yield at their own force, and each contact's depth is what its own force presses") {
  auto coupled = pins(putty);
  const auto press = [&](double depth) { return coupled.tick(at(depth), 1e-3).wrench.force.y(); };
  // Elastic: the coupling of laws without memory.
  auto elastic = pins(spring);
  CHECK_RELATIVE(press(2e-3), elastic.tick(at(2e-3)).wrench.force.y(), 1e-9);
  CHECK(press(2e-3) < 2 * 2);  // below yield, where pins that do not feel each other yield
  for (int i = 0; i <= 100; ++i) (void)press(2e-3 + 5e-5 * i);
  double force = 0;
  for (int i = 0; i < 60; ++i) force = press(7e-3);  // a tick's set follows the force of the one before
  REQUIRE(coupled.contacts().size() == 2);
  for (const auto& c : coupled.contacts()) {
    CHECK_RELATIVE(c.normal_force, force / 2, 1e-9);
    CHECK_RELATIVE(c.normal_force, 2 + 200 * (-c.own_displacement().y() - 2e-3), 1e-9);  // on the line Y
    CHECK_RELATIVE(-c.displacement.y(), 7e-3, 1e-9);
  }
  // Both are in a dent now: without contact above its bottom.
  const double set = -coupled.contacts()[0].own_displacement().y() - force / 2 / 1000;
  CHECK(press(0.99 * set) == 0);
  CHECK(press(1.01 * set) > 0);
}

TEST_CASE("closed paths of two pins on a body with memory give nothing to the hand") {
  check_gains_nothing("putty", putty);
  check_gains_nothing("dough", dough);
  check_gains_nothing("gel", gel);
  check_gains_nothing("flesh", flesh);
}

TEST_CASE("closed paths within two dents: no work is left, and none appears") {
  Work<decltype(pins(dough))> work{pins(dough)};
  for (int i = 0; i <= 200; ++i) (void)work.solver.tick(at(2e-5 * i, 0.02 * std::sin(0.1 * i)), 1e-3);
  double worst = 0;
  for (const double rock : {0.0, 0.02, -0.03}) {
    work.done = work.gross = 0;
    for (int i = 0; i <= 4000; ++i) {
      const double t = 6.28318530717958648 * i / 4000;
      const Pose<double> X = at(2.6e-3 + 6e-4 * std::cos(t), rock * std::sin(2 * t), 1e-3 * std::sin(t));
      if (i == 0) work.before = work.solver.tick(X, 1e-3).wrench, work.last = X;
      work.go(X, 1e-3);
    }
    worst = (std::max)(worst, std::abs(work.done) / work.gross);
  }
  MESSAGE("left of the work that goes in and out: ", worst);
  CHECK(worst <= 1e-5);  // the trapezoid's square of the step, (2 pi/4000)^2, where points join and leave
}

TEST_CASE("half the time step gives the same force") {
  const auto force = [](const auto& law, int steps) {
    auto solver = pins(law);
    double up = 0;
    for (int i = 0; i <= steps; ++i) {
      const double t = double(i) / steps;
      up = solver.tick(at(3e-3 * std::sin(2.5 * t), 0.1 * std::sin(5 * t)), 0.3 / steps).wrench.force.y();
    }
    return up;
  };
  const auto check = [&](const auto& law) {
    const double coarse = force(law, 300), fine = force(law, 600), finest = force(law, 1200);
    CHECK(std::abs(fine - coarse) <= 5e-3 * std::abs(finest));
    CHECK(std::abs(finest - fine) <= 0.7 * std::abs(fine - coarse) + 1e-9);  // first order in the step
  };
  check(putty);
  check(dough);
  check(gel);
  check(flesh);
}

TEST_CASE("no heap in a tick of coupled regions with memory") {
  auto solver = pins(flesh);
  (void)solver.tick(at(1e-3), 1e-3);
  const test::HeapCount heap;
  for (int i = 0; i < 100; ++i) (void)solver.tick(at(1e-3 + 1e-5 * i), 1e-3);
  CHECK(heap.allocations() == 0);
}
