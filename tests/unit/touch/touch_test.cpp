// SPDX-License-Identifier: MIT

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/touch.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/response_meshes.hpp>

#include <reference/response_truth.hpp>

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <utility>

using namespace palpate;

namespace {
using V = Vec3<double>;
using Coulomb = CoulombFriction<double>;

Pose<double> at(const V& position) {
  Pose<double> pose;
  pose.translation = position;
  return pose;
}
MeshData<double> standing_box(const V& size, int n) {
  MeshData<double> mesh = test::box_mesh(size, n);
  for (V& v : mesh.vertices) v -= V(size.x() / 2, 0, size.z() / 2);
  return mesh;
}

// The body of the reference case ball_ellipsoid.
const ElasticBody& ellipsoid() {
  static const ElasticBody body(test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 16),
                                {.E = 1.5e6, .nu = 0.49, .fixed = below(-0.036), .vertices = 200});
  return body;
}
// Sizes of the case block_head.
const ElasticBody& block() {
  static const ElasticBody body(standing_box(V(0.08, 0.05, 0.06), 8),
                                {.E = 1e6, .nu = 0.49, .fixed = below(1e-6), .vertices = 200});
  return body;
}
using PointTouch = Touch<PointBall, Coulomb>;
PointTouch& point_on_ellipsoid() {
  static PointTouch touch(ellipsoid(), point_ball(0.015), Coulomb({.mu_static = 0.4, .mu_dynamic = 0.3}));
  touch.reset();
  return touch;
}
}  // namespace

TEST_CASE(
    "touch, a ball as one point: what the field answers when asked itself, and what finite elements have") {
  PointTouch& touch = point_on_ellipsoid();
  static_assert(noexcept(touch.tick(std::declval<const Pose<double>&>(), 1e-3))&& noexcept(
      touch.draw(VertexBuffer<float>())));
  ResponseTick<1> field(*ellipsoid().field());
  const double curvature = 0.04 / 0.0036 + 1 / 0.04;  // of the ellipsoid at its top
  for (const auto& [depth, reference] : test::truth_ball_force) {
    const auto felt = touch.tick(at(V(0, 0.055 - depth, 0)), 1e-3);
    CHECK(has(felt.status, Status::contact));
    REQUIRE(felt.contacts.size() == 1);
    const double asked =
        field.solve(SphereContact<double>{V(0, 0.04, 0), V::UnitY(), 0.015, curvature, depth}).force;
    MESSAGE("depth ", depth, ": felt ", felt.wrench.force.y(), " N, field ", asked, ", finite elements ",
            reference);
    // Code error: the law's two parameters, fitted to 9 mm, and the surface that the mesh stands for.
    CHECK_RELATIVE(felt.wrench.force.y(), asked, depth <= 0.009 ? 0.02 : 0.03);
    // And that of the model: 1.0 % with 600 vertices, 200 here.
    CHECK_RELATIVE(felt.wrench.force.y(), reference, 0.03);
    // The boundary element mesh is not symmetric, and a law that varies pushes towards where it is softer.
    CHECK(V(felt.wrench.force.x(), 0, felt.wrench.force.z()).norm() < 1e-3 * reference);
    CHECK(felt.wrench.torque.norm() < 1e-12);  // all of it acts at the ball's centre
  }
  CHECK(touch.fit().depth == 0.6 * 0.015);
  CHECK(touch.fit().law_spacing == ellipsoid().field()->mesh().length / 2);
  CHECK(touch.fit().worst_rms > 0);
}

TEST_CASE("touch, a ball as one point: anywhere on the body from any side, within 2 % of the field") {
  PointTouch& touch = point_on_ellipsoid();
  const Ellipsoid<double> exact({.axes = V(0.06, 0.04, 0.04)});
  ResponseTick<1> field(*ellipsoid().field());
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  double squares = 0;
  int count = 0;
  while (count < 100) {
    V direction;
    for (double& x : direction) x = normal(random);  // in this order with every compiler
    const auto p = exact.closest(direction.normalized().cwiseProduct(V(0.06, 0.04, 0.04)));
    // By the fixed region the stiffness rises within an edge.
    if (p.position.y() < -0.036 + ellipsoid().field()->mesh().length) continue;
    const double depth = 0.003 + 0.00005 * count++;
    const auto k = exact.curvature(p.position);
    const double asked =
        field.solve(SphereContact<double>{p.position, p.normal, 0.015, k.k1 + k.k2, depth}).force;
    touch.reset();
    const auto felt = touch.tick(at(p.position + (0.015 - depth) * p.normal), 1e-3);
    squares += std::pow(felt.wrench.force.dot(p.normal) / asked - 1, 2);
    const HertzForce<double> law = touch.law_at(p.position);
    CHECK_RELATIVE(law.force(depth), asked, 0.08);  // the worst of all positions
  }
  MESSAGE("rms ", std::sqrt(squares / count));
  CHECK(std::sqrt(squares / count) < 0.02);
}

TEST_CASE(
    "touch, a ball as one point on a block: flat faces within 2 % of the field, an edge as finite elements") {
  Touch touch(block(), point_ball(0.01));
  ResponseTick<1> field(*block().field());
  for (const V& p : {V(0, 0.05, 0), V(0.01, 0.05, 0.005), V(0.028, 0.05, 0)}) {
    for (const double depth : {0.001, 0.002, 0.004, 0.006}) {
      const double asked = field.solve(SphereContact<double>{p, V::UnitY(), 0.01, 0, depth}).force;
      // Near an edge the stiffness changes by a third over one edge of the boundary element mesh.
      CHECK_RELATIVE(touch.tick(at(p + V(0, 0.01 - depth, 0)), 1e-3).wrench.force.y(), asked,
                     p.x() > 0.02 ? 0.04 : 0.02);
    }
  }
  for (const auto& [depth, x, y] : test::truth_edge_ball_force) {
    const double felt = touch.tick(at(V(0.028, 0.06 - depth, 0)), 1e-3).wrench.force.y();
    MESSAGE("edge, depth ", depth, ": ", felt, " N, finite elements ", -y);
    CHECK_RELATIVE(felt, -y, 0.05);  // near an edge 200 vertices are few
  }
}

TEST_CASE("touch, a ball: as finite elements have it, pressed in, and beside an edge with its side force") {
  Touch top(ellipsoid(), ball(0.015));
  for (const auto& [depth, reference] : test::truth_ball_force) {
    top.reset();
    const V felt = top.tick(at(V(0, 0.055 - depth, 0)), 1e-3).wrench.force;
    MESSAGE("depth ", depth, ": ", felt.transpose(), " N, finite elements ", reference);
    // Measured: 3.0 % at 0.5 mm, where 8 points touch, 3.1 % at 12 mm, 0.8 of the radius, else 1 to 2.5 %.
    CHECK_RELATIVE(felt.y(), reference, 0.04);
  }
  Touch edge(block(), ball(0.01));
  for (const auto& [depth, x, y] : test::truth_edge_ball_force) {
    if (depth < 0.001) continue;  // 5 points
    edge.reset();
    const V felt = edge.tick(at(V(0.028, 0.06 - depth, 0)), 1e-3).wrench.force;
    MESSAGE("edge, depth ", depth, ": ", felt.transpose(), " N, finite elements ", -x, " ", -y);
    CHECK_RELATIVE(felt.y(), -y, 0.05);       // near an edge 200 vertices are few
    CHECK_ABSOLUTE(felt.x(), -x, 0.01 * -y);  // as the capsule's end below
  }
}

TEST_CASE("touch, a CAD model with rounded edges: its flat faces are met where they are") {
  MeshData<double> mesh = test::rounded_box_mesh(V(0.04, 0.025, 0.03), 0.003, 1);
  for (V& v : mesh.vertices) v.y() += 0.025;
  const ElasticBody rounded(mesh, {.E = 1e6, .nu = 0.49, .fixed = below(1e-6), .vertices = 200});
  Touch on_rounded(rounded, ball(0.01)), on_sharp(block(), ball(0.01));
  for (const double depth : {0.0005, 0.001, 0.003}) {
    const V position(0, 0.06 - depth, 0);
    on_rounded.reset(), on_sharp.reset();
    const double force = on_rounded.tick(at(position), 1e-3).wrench.force.y(),
                 sharp = on_sharp.tick(at(position), 1e-3).wrench.force.y();
    MESSAGE("depth ", depth, ": ", force, " N, with sharp edges ", sharp);
    // The face 0.01 mm out: 3 % at 0.5 mm. It bulged by 3.8 mm: 40 times the force.
    CHECK_RELATIVE(force, sharp, 0.04);
  }
}

// The case `ball_slid` of bench/truth/data/contact, 1 % off itself. What the ball pushes the block with: forces
// and torque about its centre.
TEST_CASE("touch, a ball that friction holds and that then slides: finite elements' force and torque") {
  const ElasticBody body(standing_box(V::Constant(0.1), 12),
                         {.E = 1e6, .nu = 0.49, .fixed = below(1e-6), .vertices = 200});
  Touch touch(body, ball(0.015), Coulomb({.mu_static = 0.4, .mu_dynamic = 0.4}));
  const auto move = [&](const V& from, const V& to) {
    Felt felt{};
    for (int i = 1; i <= 100; ++i) felt = touch.tick(at(from + i / 100. * (to - from)), 1e-3);
    return felt.wrench;
  };
  V from(0, 0.113, 0);
  (void)move(V(0, 0.115, 0), from);
  constexpr double truth[][4] = {{0.25e-3, 1.596, -18.694, 23.5e-3},
                                 {0.5e-3, 3.096, -18.686, 45.5e-3},
                                 {1e-3, 5.791, -18.678, 85.0e-3},
                                 {2e-3, 7.713, -18.634, 113.5e-3}};
  for (const auto& [x, along, down, torque] : truth) {
    const V to(x, 0.113, 0);
    const Wrench<double> felt = move(from, to);
    from = to;
    MESSAGE("at ", x, ": ", felt.force.transpose(), " N, torque ", felt.torque.z(), " N m");
    // Measured: 0.2 %; 0.1 to 0.8 %; 0.2 to 4.5 %.
    CHECK((felt.force + V(along, down, 0)).norm() < 0.01 * V(along, down, 0).norm());
    CHECK_RELATIVE(-felt.force.x(), along, 0.02);
    CHECK_RELATIVE(-felt.torque.z(), torque, 0.05);
  }
}

// The case `ball_large` of bench/truth/data/contact, off by 1 to 2 % itself.
TEST_CASE("touch, a ball larger than the body: points as near as the body asks for") {
  const ElasticBody body(test::ellipsoid_mesh(V(0.03, 0.02, 0.02), 16),
                         {.E = 1e6, .nu = 0.49, .fixed = below(-0.016), .vertices = 200});
  const MeshTool large = ball(0.04);
  Touch touch(body, large, Coulomb({.mu_static = 0.3, .mu_dynamic = 0.3}));
  Felt felt{};
  const auto move = [&](const V& from, const V& to) {
    for (int i = 1; i <= 100; ++i) felt = touch.tick(at(from + i / 100. * (to - from)), 1e-3);
  };
  move(V(0, 0.06, 0), V(0, 0.054, 0));
  MESSAGE(felt.points.size(), " points, ", felt.wrench.force.transpose(), " N");
  CHECK(felt.points.size() >= 20);                     // measured: 24; 7 with the ball's own spacing
  CHECK_RELATIVE(felt.wrench.force.y(), 94.99, 0.05);  // measured: 2.4 %
  move(V(0, 0.054, 0), V(0.004, 0.054, 0));
  MESSAGE(felt.wrench.force.transpose(), " N, torque ", felt.wrench.torque.z(), " N m");
  CHECK_RELATIVE(-felt.wrench.force.x(), 11.89, 0.08);   // measured: 6.8 %, model (docs/resolved.md)
  CHECK_RELATIVE(-felt.wrench.torque.z(), 0.613, 0.05);  // measured: 2.6 %
  CHECK_RELATIVE(touch.tool().spacing, large.finest, 1e-12);
  // Who tells the spacing gets it.
  Touch told(body, ball(0.04, {.spacing = large.spacing}));
  CHECK(told.tool().spacing == large.spacing);
  const auto& points = told.solver().tool();  // so few touch that the fine ones feel: by coarse ones, fewer
  const double per_coarse = double(points.fine().size()) / double(points.coarse().size());
  CHECK(double(told.tick(at(V(0, 0.054, 0)), 1e-3).points.size()) < 10 * per_coarse);
}

TEST_CASE("touch, a tool of many points: the fine ones are as many as can be") {
  const ElasticBody body(test::ellipsoid_mesh(V(0.03, 0.02, 0.02), 16),
                         {.E = 1e6, .nu = 0.49, .fixed = below(-0.016), .vertices = 200});
  const MeshTool many = ball(0.04, {.spacing = 1.7e-3});
  const Touch touch(body, many);
  CHECK(touch.tool().spacing == many.spacing);
  CHECK_RELATIVE(double(touch.solver().tool().coarse().size()), 6957, 0.01);  // 4 pi R^2 over spacing^2
  CHECK_RELATIVE(double(touch.solver().tool().fine().size()), 10000, 0.01);   // half of contact_samples' most
}

TEST_CASE("touch, a plate that touches lightly: the force hardly changes as it turns in place") {
  const ElasticBody body(test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 24),
                         {.E = 50e3, .nu = 0.45, .fixed = below(-0.03), .vertices = 300});
  Touch touch(body, box({0.06, 0.01, 0.06}));
  double sum = 0, sum2 = 0, points = 0;
  constexpr int turns = 24;
  for (int k = 0; k < turns; ++k) {
    Pose<double> X = at(V(0, 0.04 + 0.005 - 4e-4, 0));  // 1/100 of the body's radius deep
    X.rotation = Eigen::AngleAxis<double>(0.1 * k, V::UnitY()).toRotationMatrix();
    X.translation += V(0.003 * std::cos(k), 0, 0.003 * std::sin(k));
    touch.reset();
    const auto felt = touch.tick(X, 1e-3);
    points += double(felt.points.size());
    sum += felt.wrench.force.y(), sum2 += felt.wrench.force.y() * felt.wrench.force.y();
  }
  const double mean = sum / turns, scatter = std::sqrt(sum2 / turns - mean * mean) / mean;
  points /= turns;
  MESSAGE(points, " points, ", mean, " N, scatter ", scatter);
  CHECK(scatter <= 0.03);  // measured: 1.7 %; 13 with coarse points alone, of which two touch
}

TEST_CASE("touch: ticks and draws take no heap; what is drawn is the newest tick's") {
  PointTouch& touch = point_on_ellipsoid();
  const std::size_t n = ellipsoid().mesh().vertices().size();
  std::vector<float> p(3 * n), q(3 * n), other(3 * n);
  const VertexBuffer<float> out{.positions = p.data(), .normals = q.data()};
  const V top(0, 0.04, 0);
  std::size_t highest = 0;
  for (std::size_t v = 0; v < n; ++v)
    if ((ellipsoid().mesh().vertices()[v] - top).norm() < 1e-12) highest = v;
  const test::HeapCount heap;
  CHECK(touch.draw(out).vertices == n);  // undeformed
  CHECK_ABSOLUTE(p[3 * highest + 1], 0.04, 1e-8);
  (void)touch.tick(at(V(0, 0.055 - 0.004, 0)), 1e-3);
  (void)touch.tick(at(V(0.001, 0.055 - 0.004, 0)), 1e-3);
  const Moved<double> moved = touch.draw(out);
  CHECK(moved.vertices == n);
  CHECK(moved.status == Status::ok);
  CHECK(touch.draw(out).vertices == 0);  // up to date
  CHECK(touch.draw(VertexBuffer<float>{.positions = other.data()}).vertices == n);
  CHECK(heap.allocations() == 0);
  CHECK(other == p);
  // The surface rests on the ball, to a hundredth of the depth.
  CHECK_ABSOLUTE(p[3 * highest + 1], 0.036, 4e-5);
  // A normal at the bottom of the dent still points up.
  CHECK(q[3 * highest + 1] > 0.97f);
  // Dragged along x it stuck, so it was dragged as well.
  CHECK(p[3 * highest] > 0.0005f);
  touch.reset();
  CHECK(touch.draw(out).vertices == n);
  CHECK(touch.draw(VertexBuffer<float>{.positions = other.data()}).vertices == n);
  CHECK_ABSOLUTE(p[3 * highest + 1], 0.04, 1e-8);
}

TEST_CASE(
    "touch: bad poses give no force and no shape; a moving object gives the same in world coordinates") {
  PointTouch& touch = point_on_ellipsoid();
  const V position(0.01, 0.05, 0.005);
  const auto felt = touch.tick(at(position), 1e-3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(has(touch.tick(at(V(nan, 0, 0)), 1e-3).status, Status::invalid_pose));
  CHECK(touch.tick(at(V(nan, 0, 0)), 1e-3).wrench.force == V(V::Zero()));
  CHECK(touch.solver().contacts().empty());
  touch.reset();
  Pose<double> object;
  object.rotation = Eigen::AngleAxis<double>(0.7, V(1, 2, 3).normalized()).toRotationMatrix();
  object.translation = V(0.3, -0.1, 0.2);
  const Pose<double> tool{object.rotation, object * position};
  const WorldResult<double> world = touch.tick(tool, object, 1e-3);
  CHECK((world.tool.force - object.rotation * felt.wrench.force).norm() < 1e-9);  // rounding of 100 N
  CHECK((world.tool.force + world.object.force).norm() == 0);
}

TEST_CASE("touch, a cylinder's end pressed flat: the field's disc") {
  Touch touch(block(), cylinder(0.005, 0.02), Coulomb({.mu_static = 0.4, .mu_dynamic = 0.3}));
  ResponseTick<1> field(*block().field());
  for (const double depth : {0.001, 0.002, 0.004}) {
    const ResponseContact<double> disc{.position = V(0.005, 0.05, 0.005),
                                       .normal = V::UnitY(),
                                       .radius = 0.005,
                                       .displacement = V(0, -depth, 0)};
    V asked;
    field.solve(&disc, 1, &asked);
    touch.reset();
    const auto felt = touch.tick(at(V(0.005, 0.06 - depth, 0.005)), 1e-3);
    MESSAGE("depth ", depth, ": felt ", felt.wrench.force.y(), " N, field ", -asked.y());
    // Of first order they agree within 0.3 %. Each has a second order of its own, the points 0.5, 1.2 and 3.5
    // %, the disc 1.5 % at 4 mm, most of its radius.
    CHECK_RELATIVE(felt.wrench.force.y(), -asked.y(), depth < 0.003 ? 0.015 : 0.03);
    REQUIRE(felt.contacts.size() == 1);
    V sum = V::Zero();
    for (const PointContact<double>& point : felt.points) {
      CHECK(point.pressure > 0);
      CHECK(point.sticks);
      sum += point.force;
    }
    CHECK((sum - felt.wrench.force).norm() < 1e-9 * sum.norm());  // rounding
  }
}

TEST_CASE("touch, a capsule's end beside an edge: finite elements' ball, side force too") {
  // Of the capsule only the end touches: a ball.
  Touch touch(block(), capsule(0.01, 0.01, {.contact_area = 1e-4}));
  for (const auto& [depth, x, y] : test::truth_edge_ball_force) {
    if (depth < 0.002) continue;  // 12 points and fewer
    touch.reset();
    const V felt = touch.tick(at(V(0.028, 0.065 - depth, 0)), 1e-3).wrench.force;
    MESSAGE("depth ", depth, ": ", felt.x(), " ", felt.y(), " N, finite elements ", -x, " ", -y);
    CHECK_RELATIVE(felt.y(), -y, 0.05);  // near an edge 200 vertices are few
    CHECK_RELATIVE(felt.x(), -x, 0.3);   // 1 to 5 % of the force; -6 to +20 % here, +7 to +24 with 600
  }
}

TEST_CASE("touch, tools with faces: what is drawn rests on the tool, and is the newest tick's") {
  const std::size_t n = block().mesh().vertices().size();
  std::size_t middle = 0;
  const V top(0, 0.05, 0);
  for (std::size_t v = 0; v < n; ++v)
    if ((block().mesh().vertices()[v] - top).norm() < 1e-12) middle = v;
  for (const auto& tool : {box(V(0.02, 0.01, 0.02)), capsule(0.008, 0.01, {.contact_area = 5e-5}),
                           tool_mesh(standing_box(V(0.02, 0.02, 0.02), 3))}) {
    Touch touch(block(), tool, Coulomb({.mu_static = 0.4, .mu_dynamic = 0.3}));
    std::vector<float> p(3 * n), q(3 * n);
    const VertexBuffer<float> out{.positions = p.data(), .normals = q.data()};
    const V down(0, 0.05 - TriangleMesh<double>(tool.mesh).lower().y(), 0);
    const test::HeapCount heap;
    CHECK(touch.draw(out).vertices == n);  // undeformed
    CHECK_ABSOLUTE(p[3 * middle + 1], 0.05, 1e-8);
    (void)touch.tick(at(down - V(0, 0.002, 0)), 1e-3);
    const auto felt = touch.tick(at(down - V(-0.0003, 0.002, 0)), 1e-3);
    CHECK(felt.points.size() > 20);
    CHECK(touch.draw(out).vertices == n);
    CHECK(touch.draw(out).vertices == 0);  // up to date
    CHECK(heap.allocations() == 0);
    CHECK_ABSOLUTE(p[3 * middle + 1], 0.048, 1e-4);  // 5 % of the depth: some 40 points
    CHECK(p[3 * middle] > 0.0001f);                  // dragged along x it stuck
    touch.reset();
    CHECK(touch.draw(out).vertices == n);
    CHECK_ABSOLUTE(p[3 * middle + 1], 0.05, 1e-8);
  }
}

TEST_CASE("touch, two tools on one body: it gives way to both, and is drawn on both") {
  const std::size_t n = block().mesh().vertices().size();
  const double d = 0.002, half = block().mesh().upper().x(), y = 0.025;
  Pose<double> to_right, to_left;  // their lower sides, turned
  to_right.rotation = Eigen::AngleAxis<double>(std::numbers::pi / 2, V::UnitZ()).toRotationMatrix();
  to_left.rotation = Eigen::AngleAxis<double>(-std::numbers::pi / 2, V::UnitZ()).toRotationMatrix();
  const auto tool = box(V(0.02, 0.01, 0.02));
  const double reach = -TriangleMesh<double>(tool.mesh).lower().y();
  to_right.translation = V(-half - reach + d, y, 0);
  to_left.translation = V(half + reach - d, y, 0);
  using Jaw = Touch<MeshTool, Coulomb>;
  const auto pinch = [&](Jaw& left, Jaw& right, bool coupled) {
    double force = 0;
    for (int i = 0; i < 8; ++i) {
      if (coupled) left.set_beside(right.loads());
      force = left.tick(to_right, 1e-3).wrench.force.x();
      if (coupled) right.set_beside(left.loads());
      (void)right.tick(to_left, 1e-3);
    }
    return force;
  };
  const Coulomb friction({.mu_static = 0.4, .mu_dynamic = 0.3});
  Jaw left(block(), tool, friction), right(block(), tool, friction);
  const double alone = pinch(left, right, false);
  left.reset(), right.reset();
  const test::HeapCount heap;
  const double both = pinch(left, right, true);
  CHECK(heap.allocations() == 0);
  MESSAGE("alone ", alone, " N, coupled ", both, " N");
  CHECK(both / alone > 1.1);  // the body cannot give way to the other side
  std::vector<float> p(3 * n);
  (void)right.draw(VertexBuffer<float>{.positions = p.data()});
  for (std::size_t v = 0; v < n; ++v) {
    const V x = block().mesh().vertices()[v];
    if (std::abs(x.y() - y) > 0.005 || std::abs(x.z()) > 0.005 || std::abs(x.x()) < 0.999 * half) continue;
    CHECK_ABSOLUTE(std::abs(p[3 * v]), half - d, 1e-4);  // 5 % of the depth: some 40 points on each
  }
}

// The case `grasp` of bench/truth/data/contact: what each ball pushes the block with, by finite elements, 1
// %. A ball alone bends the block away, with 9.6 N where they are 2.5 mm deep; the other one pushes it back,
// by more than that.
TEST_CASE("touch, two balls hold a block and lift it: as finite elements have it") {
  const ElasticBody body(standing_box(V(0.04, 0.05, 0.04), 12),
                         {.E = 1e6, .nu = 0.49, .fixed = below(1e-6), .vertices = 200});
  using Finger = Touch<MeshTool, Coulomb>;
  const auto tool = ball(0.01, {.spacing = 1.2e-3});
  const Coulomb friction({.mu_static = 0.4, .mu_dynamic = 0.4});
  Finger left(body, tool, friction), right(body, tool, friction);
  const auto hold = [&](double x, double y) {  // half the distance of the balls' middles, their height
    left.set_beside(right.loads());
    const V on_left = -left.tick(at(V(-x, y, 0)), 1e-3).wrench.force;
    right.set_beside(left.loads());
    const V on_right = -right.tick(at(V(x, y, 0)), 1e-3).wrench.force;
    return std::pair(on_left, on_right);
  };
  const auto move = [&](double x, double y, double to_x, double to_y, const V& wanted) {
    const test::HeapCount heap;
    constexpr int ticks = 150;
    for (int i = 1; i < ticks; ++i)
      (void)hold(std::lerp(x, to_x, double(i) / ticks), std::lerp(y, to_y, double(i) / ticks));
    for (int i = 0; i < 6; ++i) (void)hold(to_x, to_y);
    const auto [on_left, on_right] = hold(to_x, to_y);
    CHECK(heap.allocations() == 0);
    MESSAGE(on_left.transpose(), " N, ", on_right.transpose(), " N");
    CHECK((on_left - wanted).norm() < 0.03 * wanted.norm());
    CHECK((on_right - V(-wanted.x(), wanted.y(), 0)).norm() < 0.03 * wanted.norm());
  };
  move(0.0302, 0.035, 0.029, 0.035, V(5.897, -0.219, 0));
  move(0.029, 0.035, 0.0275, 0.035, V(24.05, -1.33, 0));
  move(0.0275, 0.035, 0.0275, 0.0355, V(23.52, 2.44, 0));
  move(0.0275, 0.0355, 0.0275, 0.037, V(22.40, 9.50, 0));  // slides, at 0.42 of the normal force
}

TEST_CASE("touch, two threads: every drawn shape is that of one tick, and none comes twice or late") {
  PointTouch& touch = point_on_ellipsoid();
  const auto& vertices = ellipsoid().mesh().vertices();
  std::size_t top = 0;
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (vertices[v].y() > vertices[top].y()) top = v;
  std::vector<float> p(3 * vertices.size());
  const VertexBuffer<float> out{.positions = p.data()};
  (void)touch.draw(out);
  std::atomic<bool> done{false};
  std::thread servo([&] {
    for (int i = 0; i < 20000; ++i) (void)touch.tick(at(V(0, 0.055 - 1e-7 * i, 0)), 1e-3);
    done.store(true, std::memory_order_release);
  });
  int drawn = 0, late = 0;
  float height = 1;
  for (bool last = false; !last;) {
    last = done.load(std::memory_order_acquire);
    if (touch.draw(out).vertices == 0) continue;
    ++drawn;
    late += p[3 * top + 1] > height;  // the ball only goes down
    height = p[3 * top + 1];
  }
  servo.join();
  CHECK(late == 0);
  CHECK(drawn > 0);
  CHECK_ABSOLUTE(height, 0.038, 2e-5);  // on the ball, to a hundredth of the depth
}
