// SPDX-License-Identifier: MIT

#include <palpate/device/servo_chain.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/solver/largest_stiffness.hpp>
#include <palpate/solver/make_solver.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace palpate;

namespace {

using V = Vec3<double>;
using Point = ContactSolver<Box<double>, LinearForce<double>>;

constexpr double k = 300;  // N/m

/// A point over a box whose top is y = 0.
Point floor_of(double stiffness) {
  return Point({.object = Box<double>({.half = V(1, 1, 1)}),
                .tool = {},
                .force = LinearForce<double>({.k = stiffness})});
}
Pose<double> above(double y) {
  Pose<double> X;
  X.translation.y() = 1 + y;
  return X;
}

template <class Chain>
void arm(Chain& chain) {
  for (int i = 0; i < 1100; ++i) (void)chain.tick(above(1e-3), 1e-3);
  REQUIRE(chain.limits().armed());
}

}  // namespace

TEST_CASE("servo chain: a slow press of a soft scene reaches the motors as the solver gives it") {
  Point solver = floor_of(k);
  ServoChain<Point> chain(solver, {});
  arm(chain);
  for (int i = 0; i <= 500; ++i) {
    const test::HeapCount heap;
    const auto out = chain.tick(above(-1e-5 * i), 1e-3);
    const auto allocations = heap.allocations();
    CHECK(allocations == 0);
    CHECK(out.wrench.force == out.result.wrench.force);
    CHECK_ABSOLUTE(out.wrench.force.y(), k * 1e-5 * i, 1e-11);
    CHECK(out.passivity == 1);
  }
}

TEST_CASE("servo chain: absent parts cost no byte, and what they leave out is passed on") {
  using Bare = ServoChain<Point, NoVirtualCoupling<double>, NoLimits<double>, NoPassivityControl<double>>;
  struct Least {
    Point* solver;
    Bare::Params params;
    Pose<double> last;
  };
  CHECK(sizeof(Bare) == sizeof(Least));
  Point solver = floor_of(1e5);
  Bare chain(solver, {});
  CHECK_RELATIVE(chain.tick(above(-0.01), 1e-3).wrench.force.y(), 1000, 1e-12);
}

TEST_CASE("servo chain: a jump is what the motion does not explain") {
  struct Fixture {
    Point solver = floor_of(k);
    ServoChain<Point> chain;
    Fixture() : chain(solver, {.stiffness = k}) { arm(chain); }
  };
  Fixture moved;  // 5 mm in a tick: faster than any hand, but explained
  CHECK(moved.chain.tick(above(-4e-3), 1e-3).gate == (GateStatus::armed));
  Fixture changed;  // the scene gets ten times as stiff under a resting tool
  (void)changed.chain.tick(above(-4e-3), 1e-3);
  changed.solver.set_force_law(LinearForce<double>({.k = 10 * k}));
  const auto out = changed.chain.tick(above(-4e-3), 1e-3);
  CHECK(out.gate == GateStatus::jump);
  CHECK(out.wrench.force == V::Zero());
}

TEST_CASE("servo chain: torque goes only where there are motors for it, and counts only then") {
  const auto torque = [](bool has_torque) {
    Point solver({.object = Box<double>({.half = V(1, 1, 1)}),
                  .tool = {.tip = V(0.02, 0, 0)},
                  .force = LinearForce<double>({.k = k})});
    ServoChain<Point> chain(solver, {.has_torque = has_torque});
    arm(chain);
    Wrench<double> w;
    for (int i = 0; i <= 100; ++i) w = chain.tick(above(-1e-5 * i), 1e-3).wrench;
    CHECK_ABSOLUTE(w.force.y(), k * 1e-3, 1e-12);
    return w.torque.z();
  };
  CHECK(torque(false) == 0);
  CHECK_RELATIVE(torque(true), 0.02 * k * 1e-3, 1e-9);
}

TEST_CASE(
    "servo chain: with a virtual coupling the hand feels both in series, at any scale of the workspace") {
  for (const double scale : {1.0, 3.0}) {
    Point solver = floor_of(5000);
    using Chain = ServoChain<Point, VirtualCoupling<double>>;
    Chain chain(solver, {.mapping = {.scale = scale},
                         .coupling = {.stiffness = 400,
                                      .rotational_stiffness = 1,
                                      .contact_stiffness = 5000,
                                      .contact_rotational_stiffness = 1}});
    const auto stylus = [&](double y) {
      Pose<double> X;
      X.translation.y() = (1 + y) / scale;
      return X;
    };
    for (int i = 0; i < 1100; ++i) (void)chain.tick(stylus(1e-3), 1e-3);
    double force = 0;
    for (int i = 0; i <= 3000; ++i)
      force = chain.tick(stylus(-2e-3 * (std::min)(1.0, i / 2000.0)), 1e-3).wrench.force.y();
    CHECK_RELATIVE(force, 2e-3 * 400 * 5000 / 5400, 1e-9);
  }
}

TEST_CASE("servo chain: a bad pose gives zero, disarms, and 1 s of free air brings the force back") {
  Point solver = floor_of(k);
  ServoChain<Point> chain(solver, {});
  arm(chain);
  CHECK(chain.tick(above(-1e-4), 1e-3).wrench.force.y() > 0);
  Pose<double> bad = above(-1e-3);
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  const auto out = chain.tick(bad, 1e-3);
  CHECK(out.wrench.force == V::Zero());
  CHECK(has(out.gate, GateStatus::disarmed));
  CHECK(chain.tick(above(-1e-4), 1e-3).wrench.force == V::Zero());
  arm(chain);
  CHECK(chain.tick(above(-1e-4), 1e-3).wrench.force.y() > 0);
}

TEST_CASE("servo chain: bad parameters are named") {
  Point solver = floor_of(k);
  const auto message = [&](ServoChain<Point>::Params p) -> std::string {
    try {
      ServoChain<Point> chain(solver, p);
    } catch (const SetupError& e) {
      return e.what();
    }
    return "";
  };
  CHECK(message({.mapping = {.scale = 0}}).find("mapping.scale must be > 0, got 0") != std::string::npos);
  CHECK(message({.stiffness = -1}).find("stiffness [N/m] must be >= 0") != std::string::npos);
  CHECK(message({.device = {.delay = -1}}).find("delay") != std::string::npos);
  CHECK(message({.limits = {.max_force = 0}}).find("max_force") != std::string::npos);
}

TEST_CASE("largest stiffness: that of the law at the given force, or of the deepest point of the press") {
  const Point linear = floor_of(k);
  Pose<double> from = above(1e-3);
  const V down = -V::UnitY();
  // Differences over 6e-6 of a depth of 50 um, at positions of 1 m: rounding of 1e-16 over 3e-10.
  CHECK_RELATIVE(
      largest_stiffness(linear, {.from = from, .along = down, .travel = 0.01, .max_force = 1}).translation, k,
      1e-6);
  // F = a D^3: 3 a D^2 = 3 a^(1/3) F^(2/3) at F; the steps are half a percent of the travel.
  const auto cubic = make_solver(Box<double>({.half = V(1, 1, 1)}), PointTool<double>{},
                                 PowerLawForce<double>({.k = 1e6, .p = 3}));
  CHECK_RELATIVE(
      largest_stiffness(cubic, {.from = from, .along = down, .travel = 0.02, .max_force = 2}).translation,
      3 * std::cbrt(1e6) * std::pow(2.0, 2.0 / 3), 0.02);
  CHECK(
      largest_stiffness(linear, {.from = from, .along = down, .travel = 1e-4, .max_force = 1}).translation ==
      0);
  CHECK_THROWS_AS((void)largest_stiffness(linear, {.from = from, .along = down, .travel = 0, .max_force = 1}),
                  SetupError);
  CHECK_THROWS_AS(
      (void)largest_stiffness(linear, {.from = from, .along = V::Zero(), .travel = 1, .max_force = 1}),
      SetupError);
}
