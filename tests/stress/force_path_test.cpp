// SPDX-License-Identifier: MIT

/// @file Attacks on the force path that once worked: friction that pays the user at each merger of regions,
/// rate terms that jump with the clustering or beyond a law's maximum, and a radial skew that forgets part of
/// the normal force.

#include <palpate/geometry/box.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/saturated.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

using namespace palpate;
using V = Vec3<double>;

namespace {

const Box<double> block({.half = V(0.05, 0.02, 0.05)});
const LinearForce<double> spring({400});

Pose<double> at(double x, double depth) {
  Pose<double> X;
  X.translation = V(x, 0.02 - depth, 0);
  return X;
}

/// Two feet and a bridge 0.2 mm above their soles: two regions when pressed in less than that, one when more.
ToolPoints<double> two_feet() {
  std::vector<V> points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(5e-4 * i, std::abs(i) > 4 ? 0 : 2e-4, 0);
  return ToolPoints<double>(points, std::vector<double>(points.size(), 2.5e-7), {.contact_area = 2e-6});
}

}  // namespace

TEST_CASE("friction pays nothing for merging regions: forward as two regions, back as one, six times") {
  ContactSolver<Box<double>, LinearForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>> solver(
      {.object = block,
       .tool = two_feet(),
       .force = spring,
       .friction = CoulombFriction<double>({.mu_static = 1, .mu_dynamic = 0.9}),
       .contacts = {.distance = 6e-4}});
  constexpr double two = 1.6e-4, one = 2.6e-4;  // depths
  double x = 0, depth = one, force = 0, work = 0, most = 0, jump = 0;
  std::size_t regions = 0, changes = 0;
  const auto go = [&](double to_x, double to_depth, int ticks) {
    const double from_x = x, from_depth = depth;
    for (int i = 1; i <= ticks; ++i) {
      const double next = from_x + (to_x - from_x) * i / ticks;
      depth = from_depth + (to_depth - from_depth) * i / ticks;
      (void)solver.tick(at(next, depth));
      double now = 0;
      for (const auto& c : solver.contacts()) now += c.friction.x();
      // Trapezoid: exact for a linear spring between changes of the regions.
      work += 0.5 * (force + now) * (next - x);
      most = (std::max)(most, work);
      if (solver.contacts().size() != regions) {
        ++changes;
        jump = (std::max)(jump, std::abs(now - force));
      }
      regions = solver.contacts().size();
      force = now;
      x = next;
    }
  };
  go(0, one, 1);
  go(1e-4, one, 200);
  for (int cycle = 0; cycle < 6; ++cycle) {
    const double start = x;
    go(start, two, 100);
    go(start + 3e-5, two, 100);
    go(start + 3e-5, one, 100);
    go(start - 2.7e-5, one, 100);
  }
  CHECK(changes > 10);
  CHECK(jump <=
        1e-15);  // the regions change while x rests and the contact sticks: nothing but rounding of 0.1 N
  CHECK(most <= 1e-18);  // rounding of the 2e-6 J that go in and out
}

TEST_CASE("a rate term does not see regions merge: at constant speed the force follows the depth") {
  using Damped = DampedForce<LinearForce<double>>;
  ContactSolver<Box<double>, Damped, Frictionless<double>, Regions<4, AreaSharing>> solver(
      {.object = block,
       .tool = two_feet(),
       .force = Damped(spring, {.damping = 10}),
       .contacts = {.distance = 6e-4}});
  ContactSolver<Box<double>, LinearForce<double>, Frictionless<double>, Regions<4, AreaSharing>> still(
      {.object = block, .tool = two_feet(), .force = spring, .contacts = {.distance = 6e-4}});
  for (int i = 0; i < 300; ++i) {  // 1 mm/s inwards, at 1 kHz
    const Pose<double> X = at(0, 1e-6 * (i + 0.5));
    const double F = solver.tick(X, 1e-3).wrench.force.y(), F0 = still.tick(X).wrench.force.y();
    if (i == 0) continue;  // without a pose before there is no rate
    CHECK_RELATIVE(F, F0 * (1 + 1.5 * 10 * 1e-3),
                   1e-9);  // the rate is a difference of positions: 1e-17 / 1e-6
  }
}

TEST_CASE("beyond a law's maximum a resting tool has no rate, and radial skew keeps the whole normal force") {
  using Capped = SaturatedForce<LinearForce<double>>;
  const Capped capped(spring, {.limit = 0.1});
  const ToolPoints<double> big({V::Zero()}, {3e-6}, {.contact_area = 1e-6});  // three times the law's share
  ContactSolver<Box<double>, DampedForce<Capped>, Frictionless<double>, SingleRegion<AreaSharing>> damped(
      {.object = block, .tool = big, .force = DampedForce<Capped>(capped, {.damping = 1})});
  ContactSolver<Box<double>, Capped, CoulombFriction<double, ReturnMapping, Radial>,
                SingleRegion<AreaSharing>>
      radial({.object = block,
              .tool = big,
              .force = capped,
              .friction =
                  CoulombFriction<double, ReturnMapping, Radial>({.mu_static = 0.5, .mu_dynamic = 0.4})});
  for (int i = 0; i < 3; ++i) CHECK_RELATIVE(damped.tick(at(0, 2e-3), 1e-3).wrench.force.y(), 0.3, 1e-12);
  CHECK_RELATIVE(radial.tick(at(0, 2e-3)).wrench.force.y(), 0.3, 1e-12);
  // 1 um aside: F changes by at most the law's stiffness times that, and not to a third.
  CHECK_ABSOLUTE(radial.tick(at(1e-6, 2e-3)).wrench.force.y(), 0.3, 400 * 1e-6);
}
