// SPDX-License-Identifier: MIT
// A body that is pressed is more compliant sideways, as a column towards buckling.
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/response_compliance.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <array>
#include <cmath>
#include <memory>
#include <utility>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
constexpr double radius = 0.01, height = 0.04;  // of the ball; of the post

/// A ball over the top of the post of the case `post_dragged` of bench/truth/data/contact.
auto on_post(double friction) {
  using Elastic = ElasticContact<double, ResponseCompliance>;
  static const Cylinder<double> post(
      {.radius = 0.012, .half_height = height / 2, .centre = V(0, height / 2, 0)});
  static const auto field = std::make_shared<const ResponseField>(
      post.mesh(3000), [](const V& x) { return x.y() <= 1e-9; },
      ResponseField::Params{.E = 5e5, .nu = 0.45, .mesh = {.vertices = 200}});
  return ContactSolver<Cylinder<double>, Elastic, CoulombFriction<double>, ContactPoints<256>>(
      {.object = post,
       .tool = ToolPoints<double>(
           contact_samples(TriangleMesh<double>(Sphere<double>({.radius = radius}).mesh(2000)), 1.2e-3),
           {.contact_area = 1e-5}),
       .force = Elastic({.compliance = ResponseCompliance(field)}),
       .friction = CoulombFriction<double>({.mu_static = friction, .mu_dynamic = friction})});
}
/// Of the ball's middle, `aside` along x, its lowest point `deep` in the post's top.
V middle(double aside, double deep) { return {aside, height + radius - deep, 0}; }

/// Along a line; returns the last wrench, and adds the work done on the hand.
Wrench<double> move(auto& solver, const V& from, const V& to, int steps, double& work) {
  Wrench<double> before, felt;
  Pose<double> X;
  for (int i = 0; i <= steps; ++i) {
    X.translation = from + double(i) / steps * (to - from);
    felt = solver.tick(X, 1e-3).wrench;
    if (i > 0) work += (before.force + felt.force).dot(to - from) / (2 * steps);
    before = felt;
  }
  return felt;
}

}  // namespace

TEST_CASE("a post that is pressed and dragged aside: as stiff as finite elements have it") {
  auto solver = on_post(0.8);
  double work = 0;
  const HeapCount heap;
  V at = middle(0, -1e-4);
  const auto go = [&](const V& to) { return move(solver, std::exchange(at, to), to, 100, work); };
  (void)go(middle(0, 0.003));
  const Wrench<double> felt = go(middle(0.0015, 0.003)), far = go(middle(0.004, 0.003));
  CHECK(heap.allocations() == 0);
  for (const auto& w : {felt, far}) MESSAGE(w.force.transpose(), " N, ", w.torque.transpose(), " N m");
  // Measured: -1 % (600 vertices: the same); 33 % too stiff without the sway.
  CHECK_RELATIVE(-felt.force.x(), 0.317, 0.04);
  CHECK_RELATIVE(-far.force.x(), 0.857, 0.04);
  CHECK_RELATIVE(far.force.y(), 8.555, 0.03);
  // Measured: -3, -2 %; -17 % where the surface does not turn.
  CHECK_RELATIVE(-felt.torque.z(), 6.83e-3, 0.05);
  CHECK_RELATIVE(-far.torque.z(), 17.83e-3, 0.05);
}

TEST_CASE("dragged under a small load and back under a large one, or the other way: no work is won") {
  for (const auto& [first, second] : {std::array{0.001, 0.003}, std::array{0.003, 0.001}}) {
    CAPTURE(first);
    auto solver = on_post(5);  // it sticks
    constexpr double aside = 0.002;
    double come = 0;
    (void)move(solver, middle(0, -0.001), middle(0, first), 400, come);
    const std::array path{middle(0, first), middle(aside, first), middle(aside, second), middle(0, second)};
    for (int round = 0; round < 2; ++round) {
      double won = 0, all = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        double leg = 0;
        (void)move(solver, path[k], path[(k + 1) % 4], 400, leg);
        won += leg, all += std::abs(leg);
      }
      MESSAGE("won ", won, " J of ", all, " J");
      CHECK(won < 1e-4 * all);  // the solve's tolerance; 6e-3 without the sway, one way
    }
  }
}

TEST_CASE("a tick goes on from the last one: few iterations where a tool drags the body along") {
  auto solver = on_post(0.8);
  double work = 0;
  (void)move(solver, middle(0, -1e-4), middle(0, 0.003), 100, work);
  int iterations = 0;
  constexpr int ticks = 200;
  Pose<double> X;
  for (int i = 1; i <= ticks; ++i) {
    X.translation = middle(2e-5 * i, 0.003);
    (void)solver.tick(X, 1e-3);
    iterations += solver.state().residual().iterations;
  }
  MESSAGE(iterations);
  CHECK(iterations <= 4 * ticks);  // measured: 487 to 605; 1,764 where what goes on does not know of the sway
}
