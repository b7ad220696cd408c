// SPDX-License-Identifier: MIT
// A budget of time: what a tick costs at most, and a tool that keeps it. Times themselves are in
// bench/growth.
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/solver/largest_work.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/paths.hpp>
#include "unit/solver/scene.hpp"

#include <type_traits>

using namespace palpate;
using namespace palpate::test;

namespace {

const TriangleMesh<double> ball(Sphere<double>({.radius = 5e-3}).mesh(1000));
const TriangleMesh<double> cube(Box<double>({.half = V(5e-3, 5e-3, 5e-3)}).mesh(1000));

template <class Contacts>
using Touch = ContactSolver<Box<double>, LinearForce<double>, Frictionless<double>, Contacts>;
const LinearForce<double> spring({.k = 800});

}  // namespace

TEST_CASE("the largest work is the cost of a touching point times the tool's points") {
  const Touch<SingleRegion<>> touch(
      {.object = block, .tool = ToolPoints<double>(ball, {.contact_area = 2e-5}), .force = spring});
  const LargestWork work = largest_work(touch, at(0, 0.012, 0));
  CHECK(work.points == touch.tool().size());
  CHECK(work.per_point > 0);
  CHECK(work.time() == static_cast<double>(work.points) * work.per_point);
  for (const std::size_t most : {1ul, 37ul, 1000ul}) {
    const std::size_t within = work.points_within((static_cast<double>(most) + 0.5) * work.per_point);
    CHECK(within == most);
  }
  CHECK(work.points_within(1e-3 * work.per_point) == 1);
  CHECK_THROWS_AS((void)work.points_within(0), SetupError);
  CHECK_THROWS_AS((void)largest_work(touch, at(0, 1, 0)), SetupError);  // nothing touches there
}

TEST_CASE("a tool made for a budget keeps it in points, and every tick says that it is coarse") {
  const ToolPoints<double> fine(ball, {.contact_area = 2e-5});
  const LargestWork work{fine.size(), 10e-9};
  Touch<Coarse<SingleRegion<>>> touch(
      {.object = block, .tool = CoarseTool<double>(fine, work.points_within(2e-6)), .force = spring});
  CHECK(touch.tool().size() <= 200);
  const auto free = touch.tick(at(0, 0.03, 0));
  CHECK(free.status == Status::coarsened);
  const auto inside = touch.tick(at(0, 0.01, 0));
  CHECK(inside.status == (Status::contact | Status::coarsened));
  CHECK(touch.contacts()[0].points == touch.tool().size());
}

TEST_CASE("a tool that keeps its points has the bits of one without a budget, and no status bit") {
  const ToolPoints<double> fine(ball, {.contact_area = 2e-5});
  Touch<SingleRegion<>> touch({.object = block, .tool = fine, .force = spring});
  Touch<Coarse<SingleRegion<>>> same(
      {.object = block, .tool = CoarseTool<double>(fine, 5000), .force = spring});
  for (int i = 0; i < 50; ++i) {
    const Pose<double> X = at(1e-4 * i, 0.025 - 1e-4 * i, 0);
    const auto a = touch.tick(X), b = same.tick(X);
    CHECK(a.wrench.force == b.wrench.force);
    CHECK(a.wrench.torque == b.wrench.torque);
    CHECK(a.status == b.status);
  }
}

TEST_CASE("1,000 points made 200 keep the force of a ball and a cube as docs/solver.md says") {
  const auto error = [](const TriangleMesh<double>& mesh, double depth, double tilt) {
    const ToolPoints<double> fine(mesh, {.contact_area = 2e-5});
    Touch<SingleRegion<>> touch({.object = block, .tool = fine, .force = spring});
    Touch<Coarse<SingleRegion<>>> coarse(
        {.object = block, .tool = CoarseTool<double>(fine, 200), .force = spring});
    double worst = 0;
    for (int turn = 0; turn < 12; ++turn) {
      Pose<double> X;
      X.rotation = rotation_about<double>(V::UnitY(), 0.5 * turn) * rotation_about<double>(V::UnitX(), tilt);
      double lowest = 0;
      for (const V& p : fine.points()) lowest = (std::min)(lowest, (X.rotation * p).y());
      X.translation = V(0, 0.02 - lowest - depth, 0);
      const V F = touch.tick(X).wrench.force;
      worst = (std::max)(worst, (coarse.tick(X).wrench.force - F).norm() / F.norm());
    }
    return worst;
  };
  struct Case {
    const char* name;
    const TriangleMesh<double>* mesh;
    double depth, tilt, bound;
  };
  // An edge is 2 mm from the next points of its faces: what is less deep is seen by the edge's points alone.
  for (const Case& c :
       {Case{"ball, 0.5 mm", &ball, 0.5e-3, 0.3, 0.02}, Case{"ball, 1 mm", &ball, 1e-3, 0.3, 0.02},
        Case{"ball, 2 mm", &ball, 2e-3, 0.3, 0.01}, Case{"cube, flat, 0.5 mm", &cube, 0.5e-3, 0, 0.002},
        Case{"cube, flat, 2 mm", &cube, 2e-3, 0, 0.002}, Case{"cube, edge, 1 mm", &cube, 1e-3, 0.35, 0.3},
        Case{"cube, edge, 2 mm", &cube, 2e-3, 0.35, 0.06}}) {
    const double found = error(*c.mesh, c.depth, c.tilt);
    INFO(c.name, ": ", found);
    CHECK(found <= c.bound);
  }
}
