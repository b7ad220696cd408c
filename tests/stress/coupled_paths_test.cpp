// SPDX-License-Identifier: MIT

/// @file Regions coupled by compliance: energy over closed paths of pins and of a wide tool.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/paths.hpp>
#include <support/pins.hpp>

#include <cstdio>
#include <numbers>
#include <vector>

using namespace palpate;
using V = Vec3<double>;

namespace {

constexpr double a = 3e-3;  // of a pin [m]
constexpr double two_pi = 2 * std::numbers::pi;

template <class Body, class Coupling, class Sharing = AreaSharing>
using Solver = ContactSolver<Body, DuffingForce<double>, Frictionless<double>, Regions<16, Sharing>,
                             NoDeformation<double>, AtContact, Coupling>;

struct Work {
  double closed = 0, largest = 0;  // of the whole path, and of any part from its beginning [J]
};
/// Work of the tool's wrench along `path(t)`, t in [0, 1], by the trapezoidal rule.
template <class S, class Path>
Work work(S solver, const Path& path, int steps) {
  Work sum;
  Pose<double> last = path(0);
  Wrench<double> before = solver.tick(last).wrench;
  for (int i = 1; i <= steps; ++i) {
    const Pose<double> X = path(double(i) / steps);
    const Wrench<double> now = solver.tick(X).wrench;
    const Mat3<double> turn = X.rotation * last.rotation.transpose();
    const V angle(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1));
    sum.closed += 0.5 * (now.force + before.force).dot(X.translation - last.translation) +
                  0.25 * (now.torque + before.torque).dot(angle);
    sum.largest = (std::max)(sum.largest, std::abs(sum.closed));
    last = X;
    before = now;
  }
  return sum;
}

/// Presses, rocks and shifts at once, and comes back.
struct Loop {
  double height, press, rock, shift;
  Pose<double> operator()(double t) const {
    Pose<double> X;
    X.rotation = test::rotation_about<double>(V::UnitZ(), rock * std::sin(two_pi * t)) *
                 test::rotation_about<double>(V::UnitX(), 0.5 * rock * std::cos(two_pi * 2 * t));
    X.translation = V(shift * std::sin(two_pi * t + 1), height - press * std::cos(two_pi * t),
                      shift * std::cos(two_pi * t));
    return X;
  }
};

template <class Sharing = AreaSharing, class Body>
void check_loops(const char* name, const Body& body, const ToolPoints<double>& tool, const Loop& loop) {
  const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});
  const auto of = [&](auto coupling, int steps) {
    return work(Solver<Body, decltype(coupling), Sharing>(
                    {.object = body, .tool = tool, .force = law, .contacts = {.distance = 0.4 * a}}),
                loop, steps);
  };
  const Work alone = of(IndependentRegions{}, 4000), coarse = of(CompliantRegions<>{}, 1000),
             fine = of(CompliantRegions<>{}, 4000);
  std::printf(
      "%-24s closed path: independent %10.3g J of %.3g, coupled %10.3g J of %.3g (4,000 steps), %10.3g "
      "(1,000)\n",
      name, alone.closed, alone.largest, fine.closed, fine.largest, coarse.closed);
  CHECK(fine.largest > 1e-5);                  // there is something to lose
  CHECK(fine.largest < 0.99 * alone.largest);  // and the coupling takes part
  CHECK(std::abs(fine.closed) <= 1e-5 * fine.largest);
  CHECK(std::abs(fine.closed) <= 0.2 * std::abs(coarse.closed) + 1e-9 * fine.largest);
}

}  // namespace

TEST_CASE("closed paths of coupled pins and of a wide tool: no energy but the path's own discretization") {
  const Box<double> box({.half = V(0.05, 0.05, 0.05)});
  const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.05)});
  const auto two = test::pins(a, {-5e-3, 5e-3});
  check_loops("two pins, press", box, two, {0.0495, 2e-3, 0, 0});
  check_loops("two pins, press and rock", box, two, {0.049, 1e-3, 0.15, 0});
  check_loops("two pins, all", egg, two, {0.0385, 1e-3, 0.2, 4e-3});
  check_loops("four pins, all", egg, test::pins(a, {-15e-3, -5e-3, 5e-3, 15e-3}), {0.038, 2e-3, 0.1, 4e-3});
  const Sphere<double> ball({.radius = 0.02});
  const ToolPoints<double> wide(TriangleMesh<double>(ball.mesh(3000)), {.contact_area = 1e-5});
  check_loops("a wide ball, all", egg, wide, {0.0575, 1e-3, 0.3, 4e-3});
}
