// SPDX-License-Identifier: MIT
// A body that is fixed at next to nothing, so that its response is no elastic body's: bounded, and said so.
#include <palpate/geometry/box.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/bowl.hpp>
#include <support/check.hpp>
#include <support/response_fields.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

using namespace palpate;
using namespace palpate::test;

namespace {
using V = Vec3<double>;

/// Displacement by a point's own load; the second is drawn to what presses on it.
constexpr float response[2] = {1, -2};
}  // namespace

TEST_CASE("a response that is not positive definite is seen, without friction and with it") {
  constexpr std::size_t stride = 16;
  AlignedList<float> d;
  d.resize(stride);
  d[0] = d[1] = 1e-3f;
  detail::PressureLists pressures;
  pressures.resize(stride);
  const auto apply = [](const float* q, float* u) {
    for (std::size_t i = 0; i < 2; ++i) u[i] = response[i] * q[i];
  };
  CHECK_FALSE(detail::solve_pressures(2, pressures, d.data(), 1e-7f, 50, apply).is_convex);

  detail::FrictionLists loads;
  loads.resize(stride);
  detail::VectorList m;
  m.resize(stride);
  for (std::size_t i = 0; i < 2; ++i) m.set(i, Vec3<float>::UnitY()), loads.per_mu[i] = 1;
  const auto apply_all = [](const detail::VectorList& P, detail::VectorList& u) {
    for (std::size_t i = 0; i < 2; ++i) u.set(i, response[i] * P[i]);
  };
  const auto mu = [](float) { return 0.3f; };
  const Mat3<float> none = Mat3<float>::Zero();
  CHECK_FALSE(
      detail::solve_loads(2, loads, m, m, d.data(), {1, 1, none}, 1e-7f, 50, apply_all, mu).is_convex);
}

TEST_CASE("a plate that stands on a corner: no force beyond a half-space's, wherever it is pressed") {
  constexpr double E = 1e5, nu = 0.49, R = 6e-3, deep = 2e-3;
  const V size(0.1, 0.1, 0.005);
  MeshData<double> mesh = box_mesh(size, 20);
  const auto field = std::make_shared<const ResponseField>(
      mesh, [](const V& p) { return p.y() <= 1e-3 && p.x() <= 0.0126; },
      ResponseField::Params{.E = E, .nu = nu, .mesh = {.vertices = 100}, .threads = 1});
  using Elastic = ElasticContact<double, ResponseCompliance>;
  ContactSolver<Box<double>, Elastic, CoulombFriction<double>, ContactPoints<128>> solver(
      {.object = Box<double>({.half = size / 2, .centre = size / 2}),
       .tool = ToolPoints<double>(contact_samples(TriangleMesh<double>(ball_cap(R, 5e-3)), 8e-4),
                                  {.contact_area = 1e-4}),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = 0.3, .mu_dynamic = 0.3})});
  const double stiffness = 2 * E / (1 - nu * nu) * std::sqrt(R),  // over the root of the depth
      hertz = 2. / 3 * stiffness * std::pow(deep, 1.5);
  bool finite = true, said = false;
  double largest = 0, work = 0, spent = 0, first = 0, jump = 0;
  for (int position = 0; position < 25; ++position) {
    Pose<double> X;
    X.rotation = Eigen::Quaterniond::FromTwoVectors(V::UnitY(), V::UnitZ()).toRotationMatrix();
    solver.reset();
    V before = V::Zero();
    bool near_only = false;
    for (int i = 0; i <= 400; ++i) {
      const double pressed = deep * (1 - std::abs(i - 200) / 200.);
      const V x(0.01 + 0.02 * (position % 5), 0.01 + 0.02 * (position / 5), size.z() - pressed);
      const auto felt = solver.tick({X.rotation, x}, 1e-3);
      const V force = felt.wrench.force;
      finite &= is_finite(force) && is_finite(felt.wrench.torque);
      largest = (std::max)(largest, force.norm());
      const bool was = near_only;
      near_only |= has(felt.status, Status::near_field_only);
      said |= near_only;
      // Over what a tick's depth does to a ball on a half-space; in all ticks, from a quarter of `deep` on.
      if (near_only && !was)
        first = (std::max)(first, (force - before).norm() / (stiffness * std::sqrt(pressed) * deep / 200));
      if (near_only)
        jump = (std::max)(jump, (force - before).norm() /
                                    (stiffness * std::sqrt((std::max)(pressed, deep / 4)) * deep / 200));
      if (i > 0) {
        const double done = (force + before).z() / 2 * (i <= 200 ? -1 : 1) * deep / 200;
        work += done, spent += std::abs(done);
      }
      before = force;
    }
  }
  CHECK(finite);
  CHECK(largest <= hertz);  // measured: 0.95 of it
  CHECK(said);
  // Measured: 1.07, by more points than a ball's, for the plate bends. 1.4 were w's slope lost among points
  // that press or points held only when they are looked at, 1.6 were those pressed at once that it kept out,
  // 2.2 were the contact not where the last tick had moved it.
  CHECK(jump <= 1.25);
  CHECK(first <= 1);  // measured: 0.75
  CHECK(work <= 0);
}
