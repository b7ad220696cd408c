// SPDX-License-Identifier: MIT

// Tools that are pushed past the middle of a thin part: they are not pushed out on the other side.

#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>

#include <numbers>
#include <random>

#include "unit/solver/scene.hpp"

using namespace palpate;
using test::V;

namespace {

const Box<double> plate({.half = V(0.02, 0.001, 0.02)});  // 2 mm thick
const LinearForce<double> spring({.k = 600});

MeshSurface<double> plate_mesh() { return MeshSurface<double>(TriangleMesh<double>(plate.mesh(8))); }

ToolPoints<double> pin() {
  return ToolPoints<double>(
      TriangleMesh<double>(Cylinder<double>({.radius = 0.0015, .half_height = 0.01}).mesh(600)),
      {.contact_area = std::numbers::pi * 0.0015 * 0.0015}, 0.4e-3);
}

/// What is felt on the way straight through, the tool's lowest point from above the plate to below it.
struct Through {
  double largest = 0, least = 0, step = 0, at_the_end = 0, work = 0;
  bool reported = false, reported_early = false;
};

template <class Solver>
Through push(Solver& solver, double lowest, double tilt = 0) {
  constexpr int ticks = 600;
  Through through;
  double before = 0;
  for (int i = 0; i <= ticks; ++i) {
    Pose<double> X = test::at(0.003, 0.0012 - lowest - 2.6e-3 * i / ticks, 0.002);
    X.rotation = Eigen::AngleAxisd(tilt, V::UnitX()).toRotationMatrix();
    const auto felt = solver.tick(X);
    const double up = felt.wrench.force.y();
    through.largest = (std::max)(through.largest, up);
    through.least = (std::min)(through.least, up);
    through.step = (std::max)(through.step, std::abs(up - before));
    through.work += (up + before) / 2 * 2.6e-3 / ticks;
    const bool deep = 2.6e-3 * i / ticks > 0.0012 - 1e-5;  // the lowest point is at the middle
    if (has(felt.status, Status::beyond_reach)) (deep ? through.reported : through.reported_early) = true;
    if (2.6e-3 * i / ticks < 0.0021) through.at_the_end = up;  // still inside
    before = up;
  }
  return through;
}

void check_through(const Through& through, double largest) {
  CHECK(through.reported);
  CHECK_FALSE(through.reported_early);
  CHECK(through.least > -1e-9);                // never pushed on
  CHECK(through.largest > largest);            // but held on the way in
  CHECK(std::abs(through.at_the_end) < 1e-9);  // faded before it is out
  // A tick is 4.3 um, 2.6 mN; the blended force falls three times as fast, and fades four times as fast.
  CHECK(through.step < 4 * 600 * 4.4e-6);
  CHECK(through.work > 0);
}

}  // namespace

TEST_CASE("a point pushed through a plate is not pushed out on the other side, and the status says so") {
  ContactSolver<Box<double>, LinearForce<double>> box({.object = plate, .tool = {}, .force = spring});
  // Depth is blended over both faces from a third of the thickness on, and so is its gradient, to 0 at the
  // middle: the force has its largest value, 0.68 k times half the thickness, before it.
  check_through(push(box, 0), 0.39);
  ContactSolver<MeshSurface<double>, LinearForce<double>> mesh(
      {.object = plate_mesh(), .tool = {}, .force = spring});
  check_through(push(mesh, 0), 0.39);
  // Out of the plate, all is forgotten: from below it is pushed down.
  const auto from_below = mesh.tick(test::at(0.003, -0.0009, 0.002));
  CHECK(from_below.wrench.force.y() < 0);
  CHECK_FALSE(has(from_below.status, Status::beyond_reach));
}

TEST_CASE_TEMPLATE("so is a pin, whatever the topology", Contacts, SingleRegion<>, SingleRegion<AreaSharing>,
                   Regions<2>, Regions<2, AreaSharing>) {
  Contacts contacts{};
  if constexpr (ClusteredTopology<Contacts>) contacts.distance = 1e-3;
  // Nearly upright, the deepest point changes over from one side of the pin to the other at the middle.
  for (const double tilt : {0.0, 1e-12, 1e-6, 1e-3, 0.2}) {
    ContactSolver<MeshSurface<double>, LinearForce<double>, CoulombFriction<double>, Contacts> solver(
        {.object = plate_mesh(),
         .tool = pin(),
         .force = spring,
         .friction = test::dry,
         .contacts = contacts});
    const double lowest = -0.01 * std::cos(tilt) - 0.0015 * std::sin(tilt);
    const Through through = push(solver, lowest, tilt);
    INFO("tilt ", tilt, ", largest ", through.largest, ", least ", through.least, ", step ", through.step);
    CHECK(through.reported);
    CHECK_FALSE(through.reported_early);
    CHECK(through.least > -1e-9);
    CHECK(through.work > 0);
    CHECK(through.largest > 0.4);
    // A tick is 4.3 um, 2.6 mN of the face; the walls of the other sharings push six times as much.
    CHECK(through.step < 8 * 600 * 4.4e-6);
  }
}

TEST_CASE("a tool that is pushed about inside a thin part gains no energy") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int path = 0; path < 40; ++path) {
    ContactSolver<MeshSurface<double>, LinearForce<double>> solver(
        {.object = plate_mesh(), .tool = {}, .force = spring});
    V x(0, 0.0011, 0), goal = x;
    V force = V::Zero();
    double gained = 0, most = 0;
    for (int i = 0; i < 4000; ++i) {
      if (i % 200 == 0) goal = V(0.002 * any(random), 0.0011 * any(random), 0.002 * any(random));
      if (i >= 3800) goal.y() = 0.0015;  // out
      const V to = x + (goal - x) * 0.03;
      const V now = solver.tick(test::at(to.x(), to.y(), to.z())).wrench.force;
      gained += (force + now).dot(to - x) / 2;
      most = (std::max)(most, now.norm());
      force = now;
      x = to;
    }
    REQUIRE(force.norm() == 0);  // it is out
    // The trapezium's error where contact begins and ends: half a step's force over a step, some ten times.
    CHECK(gained < 1e-6);
  }
}

TEST_CASE("a tool that slides round an edge is not taken for one that is pushed through") {
  // Round the rim of the plate, 0.2 mm deep, and round the edges of a prism of 60 degrees.
  ContactSolver<MeshSurface<double>, LinearForce<double>> solver(
      {.object = plate_mesh(), .tool = {}, .force = spring});
  const double deep = 0.0002;
  const V path[] = {V(0, 0.001 - deep, 0), V(0.02 - deep, 0.001 - deep, 0), V(0.02 - deep, deep - 0.001, 0),
                    V(0, deep - 0.001, 0)};
  for (int leg = 0; leg < 3; ++leg) {
    for (int i = 0; i < 1000; ++i) {
      const V x = path[leg] + (path[leg + 1] - path[leg]) * (i / 1000.0);
      const auto felt = solver.tick(test::at(x.x(), x.y(), x.z()));
      CHECK(felt.status == Status::contact);
      CHECK(felt.wrench.force.norm() > 0.6 * 600 * deep);  // less over the rim, where depth is blended
    }
  }
  MeshData<double> prism;
  for (const double z : {-0.02, 0.02})
    for (const V& v : {V(-0.01, 0, z), V(0.01, 0, z), V(0, 0.01 * std::numbers::sqrt3, z)})
      prism.vertices.push_back(v);
  prism.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  ContactSolver<MeshSurface<double>, LinearForce<double>> ridge(
      {.object = MeshSurface<double>(TriangleMesh<double>(prism)), .tool = {}, .force = spring});
  for (int i = -500; i <= 500; ++i) {  // over the ridge at the top, which is cut at half its depth there
    const double x = 1e-6 * i;
    const auto felt = ridge.tick(test::at(x, 0.01 * std::numbers::sqrt3 - 2e-3, 0.001));
    CHECK(felt.status == Status::contact);
    CHECK(felt.wrench.force.x() * x >= 0);
  }
}
