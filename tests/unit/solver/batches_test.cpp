// SPDX-License-Identifier: MIT
// Surfaces that measure a leaf's points at once, or two leaves', beside one that is asked point by point.
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/paths.hpp>
#include "unit/solver/scene.hpp"

using namespace palpate;
using namespace palpate::test;

namespace {

/// A surface that is asked point by point.
struct PointByPoint {
  using Scalar = double;
  Superellipsoid<double> body;
  SurfacePoint<double> closest(const V& x) const noexcept { return body.closest(x); }
  Penetration<double> penetration(const V& x) const noexcept { return body.penetration(x); }
  bool separated(const V& c, double r) const noexcept { return body.separated(c, r); }
  double reach() const noexcept { return body.reach(); }
};
static_assert(HasPenetrationBatch<Superellipsoid<double>, 2 * batch_size> &&
              !HasPenetrationBatch<PointByPoint>);

}  // namespace

TEST_CASE(
    "two leaves at once: the same force as point by point, for any number of leaves, the last one full or "
    "not") {
  const Superellipsoid<double> pill({.axes = V(0.06, 0.04, 0.04), .e1 = 0.3, .e2 = 0.7});
  for (const int n : {1, 3, 4, 5, 6, 7, 8, 9, 12}) {  // 1 to 9 leaves
    const ToolPoints<double> tool = face(n, 1e-3, 4e-5);
    const auto compare = [&](auto contacts) {
      using Contacts = decltype(contacts);
      ContactSolver<Superellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Contacts> at_once(
          {.object = pill, .tool = tool, .force = law, .friction = dry, .contacts = contacts});
      ContactSolver<PointByPoint, DuffingForce<double>, CoulombFriction<double>, Contacts> single(
          {.object = {pill}, .tool = tool, .force = law, .friction = dry, .contacts = contacts});
      int touching = 0;
      for (int i = 0; i < 60; ++i) {
        Pose<double> X = at(0.0004 * i, 0.0385 + 1e-4 * (i % 7), 0.001);
        X.rotation = test::rotation_about<double>(V(0, 0, 1), 0.02 * (i % 11));
        const auto a = at_once.tick(X), b = single.tick(X);
        REQUIRE(a.status == b.status);
        // A few roundings of 60 mm, by the slope of the forces' sum.
        REQUIRE((a.wrench.force - b.wrench.force).norm() <= 1e-12 * (1 + b.wrench.force.norm()));
        REQUIRE((a.wrench.torque - b.wrench.torque).norm() <= 1e-13 * (1 + b.wrench.force.norm()));
        touching += has(a.status, Status::contact) ? 1 : 0;
      }
      CHECK(touching > 10);
    };
    INFO("points ", n * n);
    compare(SingleRegion<AreaSharing>{});
    compare(Regions<4, AreaSharing>{.distance = 1.5e-3});
  }
}
