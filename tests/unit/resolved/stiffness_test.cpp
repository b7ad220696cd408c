// SPDX-License-Identifier: MIT
// The 6 x 6 tangent of a resolved contact: against closed forms of a ball on a half-space.
#include <palpate/geometry/box.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/solver/largest_stiffness.hpp>

#include <doctest/doctest.h>

#include <support/bowl.hpp>
#include <support/check.hpp>

using namespace palpate;
using namespace palpate::test;

namespace {
using V = Vec3<double>;
constexpr double E = 1e6, nu = 0.5, R = 8e-3, mu = E / (2 * (1 + nu));

template <class Friction>
auto solver_of(const Friction& friction) {
  using Elastic = ElasticContact<double, HalfSpace>;
  return ContactSolver<Box<double>, Elastic, Friction, ContactPoints<256>>(
      {.object = Box<double>({.half = V(0.1, 0.1, 0.1), .centre = V(0, -0.1, 0)}),
       .tool = ToolPoints<double>(contact_samples(TriangleMesh<double>(ball_cap(R, 6e-3)), 6e-4),
                                  {.contact_area = 1e-4, .centre_of_mass = V(0, R, 0)}),
       .force = Elastic({.compliance = HalfSpace({.E = E, .nu = nu})}),
       .friction = friction});
}
}  // namespace

TEST_CASE("the stiffness of a ball that sticks: along, across, about the normal and about its centre") {
  const auto solver = solver_of(CoulombFriction<double>({.mu_static = 5, .mu_dynamic = 5}));
  auto state = solver.initial_state(), scratch = solver.initial_state();
  const double d = 1e-3;
  Pose<double> X;
  for (int i = 1; i <= 20; ++i) {
    X.translation = V(0, -d * i / 20, 0);
    (void)solver.evaluate(X, 1e-3, state);
  }
  const auto K = stiffness(solver, X, state, scratch);
  // A disc of the contact's size that sticks [johnson1985]; a of a sphere to second order [sneddon1965].
  const double a = std::sqrt(R * d * (1 - d / (3 * R))), normal = 2 * E / (1 - nu * nu) * a,
               across = 16. / 3 * mu * a, twist = 16. / 3 * mu * a * a * a;
  // Some 40 points, 1 %, and the step, 1 %.
  CHECK_RELATIVE(K(1, 1), normal, 0.02);
  CHECK_RELATIVE(K(0, 0), across, 0.02);
  CHECK_RELATIVE(K(2, 2), across, 0.02);
  CHECK_RELATIVE(K(4, 4), twist, 0.05);  // as the cube of a
  // About the ball's centre: what is across acts at the contact, between R - d and R away.
  const double arm = K(5, 0) / K(0, 0);
  CHECK(arm > R - d);
  CHECK(arm < R);
  CHECK_RELATIVE(K(5, 5), arm * arm * K(0, 0), 0.02);
  CHECK_RELATIVE(K(0, 5), K(5, 0), 0.02);  // symmetric while all sticks
}

TEST_CASE("the stiffness of a ball without friction, and the largest on the way down") {
  const auto solver = solver_of(Frictionless<double>{});
  Press<double> press{.along = -V::UnitY(), .travel = 1e-3, .max_force = 100};
  press.steps = 20;
  press.from.translation = V(0, 1e-5, 0);
  const double d = 1e-3 - 1e-5, a = std::sqrt(R * d * (1 - d / (3 * R)));
  // It rises with the depth; nothing resists across or about the centre, but for the points' positions.
  const LargestStiffness<double> most = largest_stiffness(solver, press);
  CHECK_RELATIVE(most.translation, 2 * E / (1 - nu * nu) * a, 0.02);
  CHECK(most.rotation < 0.05 * most.translation * R * R);
}
