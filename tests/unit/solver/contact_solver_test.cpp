// SPDX-License-Identifier: MIT
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include "unit/solver/scene.hpp"

#include <limits>

using namespace palpate;
using namespace palpate::test;

TEST_CASE_TEMPLATE("a point pressed in: F equals equation (3)", S, float, double) {
  const Box<S> body({.half = Vec3<S>(S(0.05), S(0.02), S(0.05))});
  const DuffingForce<S> duffing({.c1 = S(40), .c3 = S(3e8)});
  ContactSolver<Box<S>, DuffingForce<S>> solver({.object = body, .tool = {}, .force = duffing});
  for (const double depth : {1e-6, 1e-4, 1e-3, 3e-3, 8e-3}) {
    Pose<S> X;
    X.translation = Vec3<S>(S(0.001), S(0.02) - S(depth), S(-0.002));
    // The depth that the rounded pose really has; equation (3) in long double.
    const long double D = static_cast<long double>(S(0.02)) - static_cast<long double>(X.translation.y());
    const long double F = static_cast<long double>(S(40)) * D + static_cast<long double>(S(3e8)) * D * D * D;
    const auto result = solver.tick(X);
    CHECK_RELATIVE(result.wrench.force.y(), F,
                   sizeof(S) == 8 ? 1e-14L : 1e-6L);  // asked for by the project's goals
    CHECK(result.wrench.force.x() == 0);
    CHECK(result.wrench.force.z() == 0);
    CHECK(result.status == Status::contact);
  }
}

TEST_CASE_TEMPLATE("a contact's depth is its deepest point's, a single point's is D", S, float, double) {
  const Box<S> body({.half = Vec3<S>(S(0.05), S(0.02), S(0.05))});
  const DuffingForce<S> duffing({.c1 = S(40), .c3 = S(3e8)});
  Pose<S> X;
  X.translation = Vec3<S>(S(0.001), S(0.0185), S(-0.002));
  ContactSolver<Box<S>, DuffingForce<S>> point({.object = body, .tool = {}, .force = duffing});
  (void)point.tick(X);
  REQUIRE(point.contacts().size() == 1);
  CHECK(point.contacts()[0].depth == -point.contacts()[0].displacement.y());

  using Ball = ContactSolver<Box<S>, DuffingForce<S>, Frictionless<S>, SingleRegion<AreaSharing>>;
  const TriangleMesh<S> mesh(Sphere<S>({.radius = S(0.004)}).mesh(200));
  Ball ball({.object = body,
             .tool = ToolPoints<S>(mesh, {.contact_area = S(1e-4)}, S(1e-3)),
             .force = duffing,
             .contacts = {}});
  X.translation.y() = S(0.0225);
  (void)ball.tick(X);
  REQUIRE(ball.contacts().size() == 1);
  S deepest = S(0);
  for (std::uint32_t i = 0; i < ball.tool().size(); ++i)
    deepest = std::max(deepest, body.penetration(X * ball.tool().point(i)).depth);
  const ContactState<S>& contact = ball.contacts()[0];
  S lowest = S(1);
  for (std::uint32_t i = 0; i < ball.tool().size(); ++i)
    lowest = std::min(lowest, (X * ball.tool().point(i)).y());
  CHECK_ABSOLUTE(contact.depth, std::max(deepest, contact.origin().y() - lowest), ulps<S>(8) * 0.02);
  CHECK(-ball.contacts()[0].displacement.y() < deepest);  // D carries the same force over the whole face
}

TEST_CASE("out of reach: zero wrench, no contact, no region") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> solver(
      {.object = egg, .tool = {}, .force = law, .friction = dry});
  const auto result = solver.tick(at(0, 0.0401, 0));
  CHECK(result.status == Status::ok);
  CHECK(result.wrench.force == V::Zero());
  CHECK(result.wrench.torque == V::Zero());
  CHECK(solver.contacts().empty());
}

TEST_CASE("a bad pose in mid-run: zero wrench, a status bit, recovery at the next good pose") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   inf = std::numeric_limits<double>::infinity();
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> solver(
      {.object = egg, .tool = {}, .force = law, .friction = dry});
  const Pose<double> good = at(0.001, 0.038, 0);
  const auto fresh = solver.tick(good);
  std::vector<Pose<double>> bad(7, good);
  bad[0].translation.x() = nan;
  bad[1].translation.z() = inf;
  bad[2].rotation(1, 2) = nan;
  bad[3].rotation.setZero();
  bad[4].rotation *= 1e200;
  bad[5].rotation.col(2) *= -1;  // a mirror image
  bad[6].translation.y() = 1e300;
  for (const Pose<double>& X : bad) {
    (void)solver.tick(at(0.002, 0.037, 0));
    const auto result = solver.tick(X);
    CHECK(result.status == Status::invalid_pose);
    CHECK(result.wrench.force == V::Zero());
    CHECK(result.wrench.torque == V::Zero());
    CHECK(solver.contacts().empty());
    const auto again = solver.tick(good);
    CHECK(again.status == Status::contact);
    CHECK(again.wrench.force == fresh.wrench.force);
  }
}

TEST_CASE("Fig. 10: signs of the force while a tool moves along the ellipsoid in +x") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>> solver(
      {.object = egg,
       .tool = {},
       .force = law,
       .friction = PowerLawFriction<double>({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3})});
  double highest = 0, x_of_highest = 1, first_normal_x = 0, last_normal_x = 0, first_friction_y = 0,
         last_friction_y = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double x = -0.03 + 1.5e-5 * i, z = 1e-6 * i;
    const V top = egg.raycast(V(x, 1, z), V(0, -1, 0)).position;
    (void)solver.tick(at(x, (top - 2e-3 * egg.normal(top)).y(), z));
    REQUIRE(solver.contacts().size() == 1);
    const ContactState<double>& c = solver.contacts()[0];
    if (c.mode != ContactMode::sliding || i < 400) continue;  // stuck at first, while the friction builds up
    const V normal = c.force - c.friction;
    CHECK(c.friction.x() < 0);
    CHECK(normal.y() > 0);
    if (first_normal_x == 0) first_normal_x = normal.x(), first_friction_y = c.friction.y();
    last_normal_x = normal.x();
    last_friction_y = c.friction.y();
    if (normal.y() > highest) highest = normal.y(), x_of_highest = x;
  }
  CHECK(first_normal_x < 0);
  CHECK(last_normal_x > 0);
  CHECK(std::abs(x_of_highest) < 0.002);  // largest at the top
  CHECK(first_friction_y * last_friction_y < 0);
}

TEST_CASE("a rate-dependent law uses dt, and only dt that makes sense") {
  const DampedForce<DuffingForce<double>> damped(law, {.damping = 1.0});
  ContactSolver<Box<double>, DampedForce<DuffingForce<double>>> solver(
      {.object = block, .tool = {}, .force = damped});
  (void)solver.tick(at(0, 0.019, 0), 1e-3);
  const auto pushed = solver.tick(at(0, 0.018, 0), 1e-3);  // 1 m/s inwards at 2 mm
  CHECK_RELATIVE(pushed.wrench.force.y(), damped.force(2e-3, 1.0),
                 1e-12);  // depth from 0.02 - y: 1e-14 relative
  CHECK(pushed.wrench.force.y() > law.force(2e-3));
  for (const double dt : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto result = solver.tick(at(0, 0.0175, 0), dt);
    CHECK(has(result.status, Status::invalid_step));
    CHECK_RELATIVE(result.wrench.force.y(), law.force(2.5e-3), 1e-12);
  }
}

TEST_CASE("a tool that flies in: the rate is no larger than takes it to its depth in one tick") {
  const DampedForce<DuffingForce<double>> damped(law, {.damping = 1.0});
  ContactSolver<Box<double>, DampedForce<DuffingForce<double>>, Frictionless<double>,
                SingleRegion<AreaSharing>>
      solver({.object = block, .tool = face(1, 1e-3, 1e-6), .force = damped});
  (void)solver.tick(at(0, 0.025, 0), 1e-3);
  const auto met = solver.tick(at(0, 0.0195, 0), 1e-3);  // 5.5 m/s, of 5.5 mm the last half into the body
  CHECK_RELATIVE(met.wrench.force.y(), damped.force(5e-4, 0.5), 1e-12);
}

TEST_CASE("force at the mass centre: the paper's form has no torque") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<AreaSharing>,
                NoDeformation<double>, AtMassCentre>
      paper({.object = egg, .tool = face(5, 1e-3, 1e-5), .force = law, .friction = dry});
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<AreaSharing>>
      full({.object = egg, .tool = face(5, 1e-3, 1e-5), .force = law, .friction = dry});
  for (int i = 0; i < 100; ++i) {
    const Pose<double> X = at(0.01 + 1e-5 * i, 0.0385, 0);
    const auto a = paper.tick(X), b = full.tick(X);
    CHECK(a.wrench.force == b.wrench.force);
    CHECK(a.wrench.torque == V::Zero());
    CHECK(b.wrench.torque.norm() > 0);
  }
}
