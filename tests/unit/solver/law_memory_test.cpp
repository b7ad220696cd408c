// SPDX-License-Identifier: MIT
// Force laws with memory in the solver: states of regions, kept where a contact ended, carried over mergers.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/geometry/triangle_mesh.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/relaxing.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/solver/make_solver.hpp>

#include <support/check.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace palpate;
using V = Vec3<double>;

namespace {

const Box<double> block({.half = V(0.05, 0.02, 0.05)});
using Spring = LinearForce<double>;
const Spring spring({.k = 1000});
using Putty = PlasticForce<Spring>;
const Putty putty(spring, {.yield_force = 2, .hardening = 200, .extent = 4e-3});
using Gel = RelaxingForce<Spring>;
const Gel gel(spring, {.terms = {{{0.6, 0.1}}}, .extent = 4e-3});

/// With its tip, or its face, `depth` [m] inside, turned about z by `tilt` [rad].
Pose<double> at(double x, double depth, double tilt = 0) {
  Pose<double> X;
  X.rotation = Eigen::AngleAxisd(tilt, V::UnitZ()).toRotationMatrix();
  X.translation = V(x, 0.02 - depth, 0);
  return X;
}

ToolPoints<double> face(int n, double spacing) {
  std::vector<V> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      points.emplace_back(spacing * (i - 0.5 * (n - 1)), 0, spacing * (j - 0.5 * (n - 1)));
  return ToolPoints<double>(points, std::vector<double>(points.size(), spacing * spacing),
                            {.contact_area = n * n * spacing * spacing});
}

/// Two pins 20 mm apart.
ToolPoints<double> pins() {
  return ToolPoints<double>({V(-0.01, 0, 0), V(0.01, 0, 0)}, {1e-6, 1e-6}, {.contact_area = 1e-6});
}

}  // namespace

TEST_CASE("a dent stays: met again where it is, not elsewhere, and not after reset()") {
  ContactSolver<Box<double>, Putty> solver({.object = block, .tool = {}, .force = putty});
  const auto press = [&](double x, double depth) { return solver.tick(at(x, depth), 1e-3).wrench.force.y(); };
  CHECK_RELATIVE(press(0, 7e-3), 3.0, 1e-12);  // 2 N + 200 N/m 5 mm: 4 mm stay
  CHECK(press(0, -1e-3) == 0);
  REQUIRE(solver.contacts().size() == 1);  // the dent, in which nothing touches
  CHECK(solver.contacts()[0].points == 0);
  CHECK(solver.contacts()[0].force.norm() == 0);
  CHECK_RELATIVE(-solver.contacts()[0].displacement.y(), 4e-3, 1e-12);
  CHECK((solver.contacts()[0].origin() - V(0, 0.02, 0)).norm() < 1e-12);
  CHECK(press(1e-3, 3e-3) == 0);  // above the bottom of the dent
  REQUIRE(solver.contacts().size() == 1);
  CHECK_RELATIVE(-solver.contacts()[0].displacement.y(), 4e-3,
                 1e-12);  // the shape that is drawn keeps the dent
  CHECK_RELATIVE(press(0, 5e-3), 1.0, 1e-12);
  Pose<double> bad = at(0, 5e-3);
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  CHECK(has(solver.tick(bad, 1e-3).status, Status::invalid_pose));
  CHECK_RELATIVE(press(0, 5e-3), 1.0, 1e-12);  // a bad pose does not mend the body
  (void)press(0, -1e-3);
  CHECK_RELATIVE(press(0.02, 1.5e-3), 1.5, 1e-12);
  solver.reset();
  CHECK_RELATIVE(press(0, 1.5e-3), 1.5, 1e-12);
}

TEST_CASE("a dent that stays is drawn when the tool has left; without memory the shape is at rest again") {
  const Ellipsoid<double> egg({.axes = {0.03, 0.02, 0.02}});
  const MeshData<double> mesh = egg.mesh(400);
  std::vector<V> ends;
  for (const auto& point : extremal_points(egg)) ends.push_back(point.position);
  using Beams = RegionSkeletons<Skeleton<double>>;
  using Shape = BeamSkeletonDeformation<Beams, PhongInterpolation<double>>;
  const Shape shape(
      Beams(Skeleton<double>(ends, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                             VolumePreserving<double>({.volume = egg.volume()}))),
      PhongInterpolation<double>(make_partition(egg, mesh)), AreaNeighbourhood<double>({}), mesh,
      {.fixed = V(0, -0.02, 0)});
  const auto top =
      static_cast<std::size_t>(std::max_element(mesh.vertices.begin(), mesh.vertices.end(),
                                                [](const V& a, const V& b) { return a.y() < b.y(); }) -
                               mesh.vertices.begin());
  std::vector<double> positions(3 * mesh.vertices.size());
  const VertexBuffer<double> out{.positions = positions.data()};
  /// How far the vertex under the tool stays down, and whether all others are where they were at rest.
  const auto left_down = [&](auto solver, double& down, bool& at_rest) {
    solver.draw_rest(out);
    const std::vector<double> rest = positions;
    for (const double depth : {-1e-3, 4e-3, 7e-3, -1e-3, -2e-3}) {
      (void)solver.tick(at(0, depth), 1e-3);
      (void)solver.draw(solver.contacts(), out);
    }
    down = rest[3 * top + 1] - positions[3 * top + 1];
    at_rest = positions == rest;
    solver.reset();
    (void)solver.draw(solver.contacts(), out);
    CHECK(positions == rest);
  };
  double down = 0;
  bool at_rest = true;
  left_down(make_solver(egg, PointTool<double>{}, putty, Frictionless<double>{}, SinglePoint{}, shape), down,
            at_rest);
  CHECK_RELATIVE(down, 4e-3, 1e-5);  // the mesh's vertex is at the axis' end to 1e-9 m
  CHECK_FALSE(at_rest);
  left_down(make_solver(egg, PointTool<double>{}, spring, Frictionless<double>{}, SinglePoint{}, shape), down,
            at_rest);
  CHECK(down == 0);
  CHECK(at_rest);
}

TEST_CASE("held still, the force relaxes: a law with memory has no tick that repeats the last one") {
  ContactSolver<Box<double>, Gel> solver({.object = block, .tool = {}, .force = gel});
  (void)solver.tick(at(0, 5e-3), 1e-9);  // a step
  double t = 1e-9;
  for (int i = 0; i < 300; ++i) {
    const double F = solver.tick(at(0, 5e-3), 1e-3).wrench.force.y();
    t += 1e-3;
    CHECK_RELATIVE(F, 5 * (0.4 + 0.6 * std::exp(-t / 0.1)), 1e-7);  // the step took 1e-8 of the law's time
  }
  const auto still = solver.tick(at(0, 5e-3), std::numeric_limits<double>::quiet_NaN());
  CHECK(has(still.status, Status::invalid_step));
  CHECK_RELATIVE(still.wrench.force.y(), 5 * (0.4 + 0.6 * std::exp(-t / 0.1)), 1e-7);
}

TEST_CASE("a flat region is the law itself, at every size of its mesh") {
  for (const int n : {1, 3, 10}) {
    ContactSolver<Box<double>, Putty, Frictionless<double>, SingleRegion<AreaSharing>> solver(
        {.object = block, .tool = face(n, 0.01 / n), .force = putty});
    CHECK_RELATIVE(solver.tick(at(0, 7e-3), 1e-3).wrench.force.y(), 3.0, 1e-9);
    CHECK_RELATIVE(solver.tick(at(0, 5e-3), 1e-3).wrench.force.y(), 1.0, 1e-9);
    CHECK(std::abs(solver.tick(at(0, 3.9e-3), 1e-3).wrench.force.y()) < 1e-12);
  }
}

TEST_CASE("under a mesh's pressure too a flat region is the law itself, and a tilting one has a potential") {
  const ToolPoints<double> stamp(TriangleMesh<double>(Box<double>({.half = V(5e-3, 5e-3, 5e-3)}).mesh(400)),
                                 {.contact_area = 1e-4});
  ContactSolver<Box<double>, Putty, Frictionless<double>, SingleRegion<>> solver(
      {.object = block, .tool = stamp, .force = putty});
  ContactSolver<Box<double>, Spring, Frictionless<double>, SingleRegion<>> elastic(
      {.object = block, .tool = stamp, .force = spring});
  const auto share = [&](double depth) {
    const Pose<double> X = at(0, depth - 5e-3);
    return solver.tick(X, 1e-3).wrench.force.y() / elastic.tick(X).wrench.force.y();
  };
  CHECK_RELATIVE(share(7e-3), 3.0 / 7, 1e-9);
  CHECK_RELATIVE(share(5e-3), 1.0 / 5, 1e-9);
  Wrench<double> last{};
  double tilt = 0, depth = 0, work = 0, gross = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double t = 6.28318530717958648 * i / 4000, d = 5.2e-3 + 5e-4 * std::sin(t), phi = 0.1 * std::cos(t);
    const Wrench<double> now = solver.tick(at(0, d - 5e-3, phi), 1e-3).wrench;
    if (i > 0) {
      const double done = -0.5 * (now.force.y() + last.force.y()) * (d - depth) +
                          0.5 * (now.torque.z() + last.torque.z()) * (phi - tilt);
      work += done;
      gross += std::abs(done);
    }
    last = now, depth = d, tilt = phi;
  }
  CHECK(std::abs(work) <=
        1e-4 * gross);  // points that the force's slope jumps at: 4000 steps and 400 vertices
}

TEST_CASE("each region has its own state: what one pin has dented the other has not") {
  ContactSolver<Box<double>, Putty, Frictionless<double>, Regions<4, AreaSharing>> solver(
      {.object = block, .tool = pins(), .force = putty, .contacts = {.distance = 2e-3}});
  (void)solver.tick(at(0, 0.0, 0.7), 1e-3);  // the left one 6.4 mm deep
  REQUIRE(solver.contacts().size() == 1);
  for (int i = 0; i < 10; ++i) (void)solver.tick(at(0, -0.01), 1e-3);
  (void)solver.tick(at(0, 1.5e-3), 1e-3);
  REQUIRE(solver.contacts().size() == 2);
  double dented = 0, fresh = 0;
  for (const auto& c : solver.contacts()) (c.centre.x() < 0 ? dented : fresh) = c.normal_force;
  CHECK(dented == 0);
  CHECK_RELATIVE(fresh, 1.5, 1e-12);
}

TEST_CASE("closed paths in 3 degrees of freedom within a dent: no work is left, tilting or not") {
  ContactSolver<Box<double>, Putty, Frictionless<double>, SingleRegion<AreaSharing>> solver(
      {.object = block, .tool = face(9, 1e-3), .force = putty});
  (void)solver.tick(at(0, 6e-3), 1e-3);
  std::mt19937_64 random(20050616);  // fixed seed
  std::uniform_real_distribution<double> part(-1, 1), phase(0, 6.28);
  double worst = 0;
  for (int path = 0; path < 20; ++path) {
    double a[4], p[4];
    for (int k = 0; k < 4; ++k) a[k] = part(random), p[k] = phase(random);
    Wrench<double> last{};
    double depth = 0, tilt = 0, work = 0, gross = 0;
    constexpr int steps = 4000;
    for (int i = 0; i <= steps; ++i) {
      const double t = 6.28318530717958648 * i / steps;
      const double d = 4.6e-3 + 4e-4 * (a[0] * std::sin(t + p[0]) + a[1] * std::sin(2 * t + p[1]));
      const double phi = 0.1 * (a[2] * std::sin(t + p[2]) + a[3] * std::sin(3 * t + p[3]));
      const Wrench<double> now = solver.tick(at(0, d, phi), 1e-3).wrench;
      if (i > 0) {
        const double done = -0.5 * (now.force.y() + last.force.y()) * (d - depth) +
                            0.5 * (now.torque.z() + last.torque.z()) * (phi - tilt);
        work += done;
        gross += std::abs(done);
      }
      last = now;
      depth = d;
      tilt = phi;
    }
    worst = (std::max)(worst, std::abs(work) / gross);
  }
  CHECK(worst <= 1e-5);  // the trapezoid's square of the step, (2 pi/4000)^2, where points join and leave
}

TEST_CASE("regions with dents that merge and split: the force goes on, and rocking gives nothing back") {
  // Two feet and a bridge 0.2 mm above their soles: two regions when pressed in less than that, one when
  // more.
  std::vector<V> points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(5e-4 * i, std::abs(i) > 4 ? 0 : 2e-4, 0);
  const ToolPoints<double> feet(points, std::vector<double>(points.size(), 2.5e-7), {.contact_area = 2e-6});
  const Putty soft(spring, {.yield_force = 0.02, .hardening = 100, .extent = 1e-3});
  ContactSolver<Box<double>, Putty, Frictionless<double>, Regions<4, AreaSharing>> solver(
      {.object = block, .tool = feet, .force = soft, .contacts = {.distance = 6e-4}});
  double work = 0, least = 0, jump = 0, depth = 0, tilt = 0;
  Wrench<double> last{};
  std::size_t regions = 0, changes = 0;
  const auto go = [&](double to_depth, double to_tilt) {
    const double from = depth, from_tilt = tilt;
    for (int i = 1; i <= 2000; ++i) {
      const double d = from + (to_depth - from) * i / 2000,
                   phi = from_tilt + (to_tilt - from_tilt) * i / 2000;
      const Wrench<double> now = solver.tick(at(0, d, phi), 1e-3).wrench;
      work += -0.5 * (now.force.y() + last.force.y()) * (d - depth) +
              0.5 * (now.torque.z() + last.torque.z()) * (phi - tilt);
      if (solver.contacts().size() != regions && regions * solver.contacts().size() > 0) {
        ++changes;
        jump = (std::max)(jump, std::abs(now.force.y() - last.force.y()));
      }
      regions = solver.contacts().size();
      last = now, depth = d, tilt = phi;
    }
    // Work on the user is -work; he has none of it left where the tool is out.
    least = (std::min)(least, -work);
  };
  double per_turn = 0;
  for (int turn = 0; turn < 5; ++turn) {
    const double before = work;
    go(3e-4, 0);
    go(2.5e-4, 0.02);
    go(1.5e-4, 0.02);
    go(2.5e-4, -0.02);
    go(1.2e-4, 0);
    go(-1e-4, 0);
    per_turn = -(work - before);  // what the user put in
    CHECK(per_turn >= -1e-9);     // of 5e-5 J that go in and out
  }
  CHECK(changes > 10);
  // A tick's motion, 2e-7 m, times 1000 N/m and the 2.6 nominal areas of the tool.
  CHECK(jump <= 5e-4);
}
