// SPDX-License-Identifier: MIT
#include <palpate/calibrate/response_map.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/surface/ellipsoid.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

#include <random>

using namespace palpate;
using V = Vec3<double>;

TEST_CASE("a tool on a fitted map feels what the field answers, anywhere on the body") {
  const V axes(0.06, 0.04, 0.04);
  const Ellipsoid<double> body({.axes = axes});
  const ResponseField field(test::ellipsoid_mesh(axes, 8), [](const V& p) { return p.y() <= -0.03; },
                            {.E = 1e5, .nu = 0.5, .mesh = {.vertices = 150}, .threads = 1});
  const double a = 0.005, depth = 0.004;
  const auto fitted = response_map<Ellipsoid<double>>(
      field, body, {.radius = a, .depth = depth, .spacing = field.mesh().length / 3});
  CHECK(fitted.worst_rms < 0.02);  // as in response_curve_test.cpp
  ContactSolver<Ellipsoid<double>, DuffingMap<double>> solver({body, {}, fitted.map, {}, {}});
  ResponseTick<1> tick(field);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  double squares = 0, least = 1e9, most = 0;
  int count = 0;
  while (count < 200) {
    const auto at =
        body.closest(V(normal(random), normal(random), normal(random)).normalized().cwiseProduct(axes));
    if (at.position.y() < -0.025) continue;  // beside the fixed region the stiffness rises within an edge
    const double d = depth * (0.25 + 0.75 * count / 200);
    const ResponseContact<double> contact{
        .place = at.position, .normal = at.normal, .radius = a, .displacement = -d * at.normal};
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
  CHECK(std::sqrt(squares / count) < 0.01);
  CHECK_THROWS_AS(
      (void)response_map<Ellipsoid<double>>(field, body, {.radius = a, .depth = 0, .spacing = 0.01}),
      SetupError);
  CHECK_THROWS_AS(
      (void)response_map<Ellipsoid<double>>(field, body, {.radius = -a, .depth = depth, .spacing = 0.01}),
      SetupError);
  CHECK_THROWS_AS(
      (void)response_map<Ellipsoid<double>>(field, body, {.radius = a, .depth = depth, .spacing = 0}),
      SetupError);
}
