// SPDX-License-Identifier: MIT

#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/palpate.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace palpate;

namespace {

using V = Vec3<double>;
constexpr double radius = 0.03;

const Sphere<double> ball({.radius = radius});
const TriangleMesh<double> skin(ball.mesh(4000));

// The sphere with a smooth hill of height h about +y, 0.6 rad wide; h < 0: a dent.
std::vector<V> hill(double h) {
  std::vector<V> positions = skin.vertices();
  for (V& v : positions) {
    const V n = v.normalized();
    const double t = (std::max)(0.0, 1 - std::acos((std::min)(1.0, n.y())) / 0.6);
    v += h * t * t * (3 - 2 * t) * n;
  }
  return positions;
}

DeformedSurface<Sphere<double>> raised(double h) {
  DeformedSurface<Sphere<double>> body(ball, skin);
  body.update(hill(h));
  return body;
}

static_assert(ContactSurface<DeformedSurface<Sphere<double>>>);
static_assert(HasPenetrationBatch<DeformedSurface<Sphere<double>>> &&
              HasPenetrationBatch<DeformedSurface<MeshSurface<float>>>);
static_assert(ContactSurface<DeformedSurface<MeshSurface<float>>>);

}  // namespace

TEST_CASE("deformed surface: a tool above the undeformed body is found on a bulge, with its depth below it") {
  const double h = 0.004;
  const auto body = raised(h);
  // No vertex need be at the top: within one edge, 1.7 mm or 0.057 rad, the hill falls by 3 (0.057 / 0.6)^2 =
  // 2.7 %.
  CHECK_RELATIVE(body.highest_bulge(), h, 0.03);
  const V x(0, radius + 0.75 * h, 0);
  CHECK(!(ball.penetration(x).depth > 0));
  const auto in = body.penetration(x);
  CHECK_ABSOLUTE(in.depth, 0.25 * h, 0.03 * h);
  CHECK_ABSOLUTE((in.gradient - V::UnitY()).norm(), 0, 1e-2);
  CHECK(!(body.penetration(V(0, radius + 1.05 * h, 0)).depth > 0));
  CHECK(!(body.penetration(V(radius + 0.75 * h, 0, 0)).depth > 0));  // no bulge on this side

  ContactSolver<DeformedSurface<Sphere<double>>, LinearForce<double>> solver(
      {body, {}, LinearForce<double>({.k = 200}), {}, {}, {}});
  Pose<double> X;
  X.translation = x;
  CHECK(has(solver.tick(X).status, Status::contact));
  CHECK_RELATIVE(solver.tick(X).wrench.force.y(), 200 * in.depth,
                 1e-3);  // the gradient is the sphere's at x - b

  // The solver's object follows the shape, also where the pose has not moved.
  for (int i = 0; i < 3; ++i) (void)solver.tick(X);
  solver.mutable_object().update(skin.vertices());
  CHECK(!has(solver.tick(X).status, Status::contact));
}

TEST_CASE("deformed surface: a dent or no deformation leaves the undeformed depth, bit for bit") {
  const auto dented = raised(-0.004);
  const DeformedSurface<Sphere<double>> still(ball, skin);
  std::mt19937_64 random(7);
  for (int i = 0; i < 1000; ++i) {
    const V x = test::random_position(skin.data(), random);
    CHECK(dented.penetration(x).depth == ball.penetration(x).depth);
    CHECK(still.penetration(x).gradient == ball.penetration(x).gradient);
  }
}

TEST_CASE("deformed surface: every contact of the undeformed body is kept, and separation is safe") {
  const auto body = raised(0.003);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> size(0, 0.01);
  int more = 0, apart = 0;
  for (int i = 0; i < 20000; ++i) {
    const V x = test::random_position(skin.data(), random);
    const double own = ball.penetration(x).depth, now = body.penetration(x).depth;
    // A hill's sides lean, so x - b can be a little less deep than x: by b (1 - cos) of the lean across the
    // foot's normal and the radius, below 1e-4 of a radius here.
    CHECK(now >= own - 1e-4 * radius);
    more += now > 0 && !(own > 0);
    const double r = size(random);
    if (!body.separated(x, r)) continue;
    ++apart;
    const V to = x + r * V(size(random) - 0.005, size(random) - 0.005, size(random) - 0.005).normalized();
    CHECK(!(body.penetration(to).depth > 0));
  }
  CHECK(more > 50);
  CHECK(apart > 1000);
}

TEST_CASE("deformed surface: depth follows position and shape without a jump") {
  DeformedSurface<Sphere<double>> body(ball, skin);
  double before = 0;
  body.update(hill(0.004));
  for (int i = 0; i <= 2000; ++i) {  // across the hill at one height
    const double t = 2.2 * (i / 2000.0 - 0.5);
    const double depth = body.penetration((radius + 0.001) * V(std::sin(t), std::cos(t), 0)).depth;
    // Steps are 3.4e-5 m along the surface; the hill's slope is at most 1.5 * 0.004 / (0.6 radius) = 1/3, and
    // below its flanks the foot moves up to twice as fast as the point. The closest point alone jumps by 7e-5
    // m.
    if (i > 0) CHECK(std::abs(depth - before) < 3.4e-5 * 2 / 3);
    before = depth;
  }
  before = 0;
  for (int i = 0; i <= 100; ++i) {  // the hill rises by 4e-5 m a step
    body.update(hill(4e-5 * i));
    const double depth = body.penetration(V(0.002, radius, 0)).depth;
    CHECK(depth - before < 5e-5);
    CHECK(depth >= before - 1e-9);
    before = depth;
  }
  CHECK(before > 0.003);
}

TEST_CASE("deformed surface: many points at once are as each of them") {
  const MeshSurface<double> own(skin);
  DeformedSurface<MeshSurface<double>> on_mesh(own, skin);
  on_mesh.update(hill(0.004));
  std::mt19937_64 random(10);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto compare = [&](const auto& body) {
    int below = 0, apart = 0;
    for (int k = 0; k < 2000; ++k) {
      // A leaf's worth around a point near the surface, closer together than its triangles or not; some on
      // vertices.
      const V middle =
          V(uniform(random), 1, uniform(random)).normalized() * (radius + 0.003 * uniform(random));
      const double size = k % 3 == 0 ? 0.02 : 0.0005;
      PointBatch<double> x;
      for (std::size_t i = 0; i < batch_size; ++i) {
        V p = middle + size * V(uniform(random), uniform(random), uniform(random));
        if (k % 5 == 0 && i == 0) p = body.tree().vertices()[static_cast<std::size_t>(k)];
        if (k % 50 == 0 && i == 7) p.y() = std::numeric_limits<double>::quiet_NaN();
        x.x[i] = p.x(), x.y[i] = p.y(), x.z[i] = p.z();
      }
      PenetrationBatch<double> in;
      body.penetration(x, in);
      for (std::size_t i = 0; i < batch_size; ++i) {
        const auto one = body.penetration(V(x.x[i], x.y[i], x.z[i]));
        // Sums over the same triangles in another order; where a point is on a triangle's edge, either may
        // count.
        REQUIRE(std::abs(in.depth[i] - one.depth) <= 1e-14);
        if (!(one.depth > 1e-6)) continue;
        REQUIRE((V(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]) - one.gradient).norm() <= 1e-8);
        below += one.depth > own.penetration(V(x.x[i], x.y[i], x.z[i])).depth + 1e-4;
        apart += size > 0.001;
      }
    }
    CHECK(below > 1000);
    CHECK(apart > 1000);
  };
  compare(raised(0.004));
  compare(on_mesh);
  const DeformedSurface<Sphere<double>> still(ball, skin);
  PointBatch<double> x{};
  PenetrationBatch<double> in;
  x.y.fill(radius - 0.001);
  still.penetration(x, in);
  CHECK_RELATIVE(in.depth[3], 0.001, 1e-12);
  // Far away, and where sums overflow.
  for (const double far : {1.0, 1e200, 1.7e308}) {
    x.y.fill(far);
    on_mesh.penetration(x, in);
    CHECK(in.depth[0] == 0);
    CHECK(in.gradient_y[15] == 0);
  }
}

TEST_CASE("deformed surface: moving some vertices equals moving all, without heap") {
  const std::vector<V> to = hill(0.004);
  DeformedSurface<Sphere<double>> all(ball, skin), some(ball, skin);
  std::vector<std::uint32_t> which;
  std::vector<V> positions;
  for (std::uint32_t v = 0; v < to.size(); ++v) {
    if (to[v] == skin.vertices()[v]) continue;
    which.push_back(v);
    positions.push_back(to[v]);
  }
  CHECK(which.size() < to.size() / 4);
  const test::HeapCount heap;
  all.update(to);
  some.update(which, positions);
  std::mt19937_64 random(9);
  int differ = 0;
  for (int i = 0; i < 2000; ++i) {
    const V x = test::random_position(skin.data(), random);
    differ += all.penetration(x).depth != some.penetration(x).depth;
  }
  CHECK(heap.allocations() == 0);
  CHECK(differ == 0);
  CHECK(all.highest_bulge() == some.highest_bulge());
}

TEST_CASE("deformed surface: positions and queries that are not finite") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  DeformedSurface<Sphere<double>> body(ball, skin);
  std::vector<V> positions = hill(0.004);
  positions[5] = V(nan, 0, 0);
  body.update(positions);
  CHECK(is_finite(body.highest_bulge()));
  CHECK(body.penetration(V(nan, 0, 0)).depth == 0);
  CHECK(!body.separated(V(0, 0, 1), nan));
  CHECK(body.penetration(V(0, radius + 0.003, 0)).depth > 0);
}
