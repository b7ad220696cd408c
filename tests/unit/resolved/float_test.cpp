// SPDX-License-Identifier: MIT
// Contact resolved at the tool's points with float as the scalar: what double gives, and the same bits again.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <reference/rigid_sphere.hpp>
#include <support/bowl.hpp>
#include <support/check.hpp>
#include <support/paths.hpp>
#include <support/response_fields.hpp>

#include <cstring>

using namespace palpate;
using namespace palpate::test;

namespace {

constexpr double R = 0.015, E = 1e6, nu = 0.5;

template <Real S>
ToolPoints<S> as(const SurfaceSamples<double>& samples) {
  SurfaceSamples<S> out;
  for (const auto& x : samples.points) out.points.push_back(x.cast<S>());
  for (const auto& a : samples.vector_areas) out.vector_areas.push_back(a.cast<S>());
  for (const double a : samples.areas) out.areas.push_back(static_cast<S>(a));
  return ToolPoints<S>(out, {.contact_area = S(1e-4)});
}
const SurfaceSamples<double>& ball() {
  static const auto made = contact_samples(TriangleMesh<double>(ball_cap(R, 9e-3)), 0.0016);
  return made;
}

template <Real S, FrictionLaw F = Frictionless<S>>
auto on_half_space(ToolPoints<S> tool, F friction = {}) {
  using Elastic = ElasticContact<S, HalfSpace>;
  return ContactSolver<Box<S>, Elastic, F, ContactPoints<128>>(
      {.object = Box<S>({.half = Vec3<S>(S(0.5), S(0.5), S(0.5)), .centre = Vec3<S>(0, S(-0.5), 0)}),
       .tool = std::move(tool),
       .force = Elastic({.compliance = HalfSpace({.E = E, .nu = nu})}),
       .friction = friction});
}
template <Real S>
auto with_friction() {
  return on_half_space<S>(as<S>(ball()), CoulombFriction<S>({.mu_static = S(0.4), .mu_dynamic = S(0.3)}));
}
template <Real S>
auto on_ellipsoid() {
  static const auto field = std::make_shared<const ResponseField>(ellipsoid_field(0.49, 150));
  using Elastic = ElasticContact<S, ResponseCompliance>;
  return ContactSolver<Ellipsoid<S>, Elastic, CoulombFriction<S>, ContactPoints<128>>(
      {.object = Ellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04))}),
       .tool = as<S>(ball()),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<S>({.mu_static = S(0.4), .mu_dynamic = S(0.3)})});
}

/// Pressed by 1.2 mm, rolled 0.6 mm aside, turned, lifted; the height is over a plane or the ellipsoid's top.
Pose<float> pose_at(int i, double height) {
  const double t = i / 100., down = 1.2e-3 * std::sin(std::numbers::pi * t);
  Pose<float> X;
  X.translation = Vec3<double>(6e-4 * t, height - down, -3e-4 * t * t).cast<float>();
  X.rotation = rotation_about<double>(Vec3<double>(0.3, 0.8, 0.52).normalized(), 0.05 * t).cast<float>();
  return X;
}

/// Both at poses that float can hold. Each solves to 1e-4 of the depths (`tolerance`): they may differ by
/// twice that. Measured: 2.5e-5 of the force at most, 4e-5 of force times radius.
template <class Wide, class Narrow>
void compare(Wide wide, Narrow narrow, double height) {
  Narrow again = narrow;
  double force = 0, torque = 0, most = 0;
  bool same = true;
  for (int i = 0; i <= 100; ++i) {
    const Pose<float> X = pose_at(i, height);
    Pose<double> X_wide;
    X_wide.rotation = Eigen::Quaternion<double>(X.rotation.cast<double>()).normalized().toRotationMatrix();
    X_wide.translation = X.translation.cast<double>();
    const auto w = wide.tick(X_wide);
    const auto n = narrow.tick(X), m = again.tick(X);
    same &= std::memcmp(&n.wrench, &m.wrench, sizeof n.wrench) == 0 && n.status == m.status;
    force = (std::max)(force, (n.wrench.force.template cast<double>() - w.wrench.force).norm());
    torque = (std::max)(torque, (n.wrench.torque.template cast<double>() - w.wrench.torque).norm());
    most = (std::max)(most, w.wrench.force.norm());
  }
  CHECK(same);
  CHECK(most > 5);
  CHECK(force <= 2e-4 * most);
  CHECK(torque <= 2e-4 * R * most);
}

}  // namespace

TEST_CASE("float: a ball on a half-space without friction and with") {
  compare(on_half_space<double>(as<double>(ball())), on_half_space<float>(as<float>(ball())), 0);
  compare(with_friction<double>(), with_friction<float>(), 0);
}

TEST_CASE("float: a ball on an ellipsoid with a response field, with friction") {
  compare(on_ellipsoid<double>(), on_ellipsoid<float>(), 0.04);
}

TEST_CASE("float: points made from a mesh in float give the exact sphere's force within 1 %") {
  auto solver = on_half_space<float>(
      ToolPoints<float>(contact_samples(TriangleMesh<float>(mesh_cast<float>(ball_cap(R, 9e-3))), 0.0012f),
                        {.contact_area = 1e-4f}));
  Pose<float> X;
  for (const double d : {5e-4, 1e-3, 1.5e-3}) {
    X.translation.y() = static_cast<float>(-d);
    CHECK_RELATIVE(solver.tick(X).wrench.force.y(), rigid_sphere_force(R, d, E / (1 - nu * nu)), 0.01);
  }
}
