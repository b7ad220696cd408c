// SPDX-License-Identifier: MIT
#include <palpate/calibrate/response_map.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/solver/contact_solver.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

#include <random>

using namespace palpate;
using V = Vec3<double>;

namespace {
SurfacePoint<double> somewhere(const Ellipsoid<double>& body, std::mt19937& random) {
  std::normal_distribution<double> normal;
  V direction;
  for (double& x : direction) x = normal(random);  // in this order with every compiler
  return body.closest(direction.normalized().cwiseProduct(body.params().axes));
}
}  // namespace

TEST_CASE("a tool on a fitted map feels what the field answers, anywhere on the body") {
  const V axes(0.06, 0.04, 0.04);
  const Ellipsoid<double> body({.axes = axes});
  const ResponseField field(test::ellipsoid_mesh(axes, 8), [](const V& p) { return p.y() <= -0.03; },
                            {.E = 1e5, .nu = 0.5, .mesh = {.vertices = 150}, .threads = 1});
  const double a = 0.005, depth = 0.004;
  const auto fitted =
      response_map(field, body, {.radius = a, .depth = depth, .spacing = field.mesh().length / 3});
  CHECK(fitted.worst_rms < 0.02);  // as in response_curve_test.cpp
  ContactSolver<Ellipsoid<double>, DuffingMap<double>> solver(
      {.object = body, .tool = {}, .force = fitted.map});
  ResponseTick<1> tick(field);
  const double beside =
      -0.03 + field.mesh().length;   // by the fixed region the stiffness rises within an edge
  CHECK(fitted.where.y() < beside);  // the worst fit is there
  std::mt19937 random(5);
  double squares = 0, least = 1e9, most = 0;
  int count = 0;
  while (count < 200) {
    const auto at = somewhere(body, random);
    if (at.position.y() < beside) continue;
    const double d = depth * (0.25 + 0.75 * count / 200);
    const ResponseContact<double> contact{
        .position = at.position, .normal = at.normal, .radius = a, .displacement = -d * at.normal};
    V F;
    tick.solve(&contact, 1, &F);
    const double felt =
        solver.tick({Mat3<double>::Identity(), at.position - d * at.normal}).wrench.force.norm();
    const double error = felt / -F.dot(at.normal) - 1;
    squares += error * error;
    least = (std::min)(least, felt / d);
    most = (std::max)(most, felt / d);
    ++count;
  }
  CHECK(most >
        1.2 * least);  // the body is not equally stiff everywhere, so that there is something to follow
  // The fits' 0.2 %, and what the map misses of a field that is itself linear over an edge.
  CHECK(std::sqrt(squares / count) < 0.005);
  CHECK_THROWS_AS((void)response_map(field, body, {.radius = a, .depth = 0, .spacing = 0.01}), SetupError);
  CHECK_THROWS_AS((void)response_map(field, body, {.radius = -a, .depth = depth, .spacing = 0.01}),
                  SetupError);
  CHECK_THROWS_AS((void)response_map(field, body, {.radius = a, .depth = depth, .spacing = 0}), SetupError);
}

TEST_CASE("a ball on a fitted map feels what the field answers to a contact that grows") {
  const V axes(0.06, 0.04, 0.04);
  const Ellipsoid<double> body({.axes = axes});
  const ResponseField field(test::ellipsoid_mesh(axes, 8), [](const V& p) { return p.y() <= -0.03; },
                            {.E = 1e5, .nu = 0.5, .mesh = {.vertices = 150}, .threads = 1});
  const double ball = 0.012, depth = 0.006;
  const auto fitted =
      ball_response_map(field, body, {.radius = ball, .depth = depth, .spacing = field.mesh().length / 3});
  // The worst is within the fixed region, where compliances are bounded and a curve has a kink.
  CHECK(fitted.worst_rms < 0.2);  // 0.17 met
  ContactSolver<Ellipsoid<double>, HertzMap<double>> solver(
      {.object = body, .tool = {}, .force = fitted.map});
  ResponseTick<1> tick(field);
  const double beside =
      -0.03 + field.mesh().length;  // by the fixed region the stiffness rises within an edge
  CHECK(fitted.where.y() < beside);
  std::mt19937 random(5);
  double squares = 0;
  int count = 0;
  while (count < 200) {
    const auto at = somewhere(body, random);
    if (at.position.y() < beside) continue;
    const double d = depth * (0.25 + 0.75 * count / 200);
    const auto k = body.curvature(at.position);
    const double asked =
        tick.solve(SphereContact<double>{at.position, at.normal, ball, k.k1 + k.k2, d}).force;
    const double felt =
        solver.tick({Mat3<double>::Identity(), at.position - d * at.normal}).wrench.force.norm();
    squares += std::pow(felt / asked - 1, 2);
    ++count;
  }
  MESSAGE("rms ", std::sqrt(squares / count), ", worst fit ", fitted.worst_rms);
  CHECK(std::sqrt(squares / count) < 0.005);  // the fits' 0.7 % at worst
  CHECK_THROWS_AS((void)ball_response_map(field, body, {.radius = ball, .depth = -1, .spacing = 0.01}),
                  SetupError);
  CHECK_THROWS_AS((void)ball_response_map(field, body, {.radius = 0, .depth = depth, .spacing = 0.01}),
                  SetupError);
}

TEST_CASE(
    "a ball's law on a slender body of few elements: fitted to as much depth as is a law's, not refused") {
  const V axes(0.008, 0.08, 0.012);
  const Ellipsoid<double> body({.axes = axes});
  const ResponseField field(test::ellipsoid_mesh(axes, 8), [](const V& p) { return p.y() <= -0.064; },
                            {.E = 1e5, .nu = 0.49, .mesh = {.vertices = 40}, .threads = 1});
  const double ball = 0.02, depth = 0.012;
  const auto fitted = ball_response_map(
      field, body, {.radius = ball, .depth = depth, .spacing = field.mesh().length, .points = 10});
  // Up to 0.6 of the radius the worst curve is a law's to 1.16 only, which was an error. 0.45.
  CHECK(fitted.worst_rms < 1);
  ContactSolver<Ellipsoid<double>, HertzMap<double>> solver(
      {.object = body, .tool = {}, .force = fitted.map});
  const auto half_space = PowerLawForce<double>::hertz_sphere(field.E(), field.nu(), ball);
  std::mt19937 random(5);
  double most = 0;
  bool grows = true;
  for (int i = 0; i < 100; ++i) {
    const auto at = somewhere(body, random);
    if (std::abs(at.position.y()) > 0.05)
      continue;  // the fixed end; the tip, where 2 mm are half of the radius
    double before = 0;
    for (double d : {0.0005, 0.001, 0.002}) {
      const double felt =
          solver.tick({Mat3<double>::Identity(), at.position - d * at.normal}).wrench.force.norm();
      grows = grows && felt > before;
      before = felt;
      most = (std::max)(most, felt / half_space.force(d));
    }
  }
  MESSAGE("worst fit ", fitted.worst_rms, ", most of a half-space's force ", most);
  CHECK(grows);
  CHECK(most < 1);  // 0.13: the body gives way, and its curvature makes the contact narrower
}
