// SPDX-License-Identifier: MIT
#include <palpate/response/response_contact.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;

const V axes(0.06, 0.04, 0.04);
ResponseField ellipsoid(double nu) {
  return ResponseField(test::ellipsoid_mesh(axes, 10), [](const V& p) { return p.y() <= -0.03; },
                       {.E = 1e5, .nu = nu, .mesh = {.vertices = 140}, .threads = 1});
}
// Forty degrees from the top.
SphereContact<double> on_flank(double depth) {
  const V position(0.06 * std::sin(0.7), 0.04 * std::cos(0.7), 0),
      weight = axes.cwiseProduct(axes).cwiseInverse(), normal = position.cwiseProduct(weight).normalized();
  return {.position = position, .normal = normal, .radius = 0.012, .curvature = 45, .depth = depth};
}
Eigen::VectorXd shape(ResponseTick<1>& tick, const ResponseDisplay& display, double depth) {
  Eigen::VectorXd u(3 * Eigen::Index(display.size()));
  (void)tick.solve(on_flank(depth));
  tick.displace(display, u.data(), 3);
  return u;
}
}  // namespace

TEST_CASE(
    "a ball: what is not linear is of second order in depth, in field and force, but for a surface that is "
    "drawn in; along the normal it moves by its depth") {
  for (const double nu : {0.0, 0.3, 0.5}) {
    const ResponseField field = ellipsoid(nu);
    std::vector<V> points{on_flank(0).position};
    for (const V& p : field.mesh().vertices) points.push_back(p);
    const ResponseDisplay display(field, points);
    ResponseTick<1> tick(field), linear(field, {.second_order = false});
    double last = 0;
    for (const double depth : {0.25e-3, 1e-3, 4e-3}) {
      const Eigen::VectorXd u = shape(tick, display, depth), v = shape(linear, display, depth);
      CHECK(u.allFinite());
      CHECK_RELATIVE(-u.head<3>().dot(on_flank(0).normal), depth, 1e-3);  // it slides sideways, too: 4e-4 met
      const PressedSphere felt = tick.solve(on_flank(depth));
      // x a/R of the depth, 1/R = 1/0.012 + 45/2
      const double drawn_in = SecondOrder{}.at(nu).sphere_drawn_in * felt.radius * (1 / 0.012 + 22.5),
                   size = (u - v).norm() / v.norm(),
                   force = felt.force / linear.solve(on_flank(depth)).force - 1;
      CHECK(std::abs(force - 1.5 * drawn_in) < 15 * depth);  // 14 per metre met
      // Loads of second order go with d, what is across the normal with F, as d^(3/2): 4 to 8. A surface that
      // is drawn in goes with the root of d.
      if (last > 0) CHECK((size > (nu < 0.5 ? 2 : 4) * last && size < 8 * last));
      last = size;
    }
  }
}

TEST_CASE("a ball where the body leans: it is pushed across in proportion to its force, along the surface") {
  const ResponseField field = ellipsoid(0.49);
  ResponseTick<1> tick(field), linear(field, {.second_order = false});
  double last = 0;
  for (const double depth : {0.5e-3, 2e-3}) {
    const SphereContact<double> in = on_flank(depth);
    const PressedSphere out = tick.solve(in);
    CHECK(std::abs(out.across.dot(in.normal)) < 1e-12 * out.force);            // a rounding
    CHECK_RELATIVE(-out.on_body(in.normal).dot(in.normal), out.force, 1e-12);  // a rounding
    const double by_force = out.across.norm() / out.force / out.force;
    if (last > 0) CHECK_RELATIVE(by_force, last, 0.02);  // w is a mean over a contact that grows: 0.007 met
    last = by_force;
    CHECK(linear.solve(in).across.norm() < 1e-12 * out.force);
  }
}

TEST_CASE("a ball: absurd curvatures and depths end in bounded forces and fields") {
  const ResponseField field = ellipsoid(0.49);
  const ResponseDisplay display(field, field.mesh().vertices);
  ResponseTick<1> tick(field);
  std::vector<double> u(3 * display.size());
  for (const double curvature : {-1e9, -200.0, 0.0, 1e9})
    for (const double depth : {1e-9, 1e-3, 0.1, 1e5}) {
      SphereContact<double> in = on_flank(depth);
      in.curvature = curvature;
      const auto out = tick.solve(in);
      CHECK(out.across.norm() <= 0.25 * (1 + 1e-12) * out.force);  // its bound, rounded
      CHECK((is_finite(out.force) && out.force >= 0 && is_finite(out.stiffness) && out.radius >= 0));
      tick.displace(display, u.data(), 3);
      // The field is bounded by 4 d on the boundary element mesh's vertices, which are all that are drawn.
      for (const double x : u) CHECK(std::abs(x) < 4.5 * depth);
    }
  CHECK(tick.solve(on_flank(std::numeric_limits<double>::quiet_NaN())).force == 0);
  CHECK(tick.solve(on_flank(-1e-3)).force == 0);
}
