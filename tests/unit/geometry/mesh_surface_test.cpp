// SPDX-License-Identifier: MIT

#include <palpate/geometry/mesh_surface.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

using namespace palpate;

namespace {

constexpr std::uint64_t seed = 20240702;

template <Real S>
Vec3<S> random_direction(std::mt19937_64& random) {
  std::normal_distribution<S> normal;
  const S x = normal(random), y = normal(random), z = normal(random);
  return Vec3<S>(x, y, z).normalized();
}

struct Clicks {
  double flat = 0, shaded = 0, given = 0;  // largest |dF| / (k |dx|) of F = k d n
};

// Along circles' images inside the ellipsoid with the given axes, in steps of 1 um.
Clicks clicks(const MeshSurface<double>& body, const Vec3<double>& axes, double shrink) {
  using V = Vec3<double>;
  std::mt19937_64 random(seed);
  Clicks worst;
  for (int path = 0; path < 4; ++path) {
    const V a = random_direction<double>(random);
    const V b = tangential(random_direction<double>(random), a).normalized();
    V flat = V::Zero(), shaded = flat, given = flat, at = flat;
    for (int i = 0; i < 2500; ++i) {
      const double t = 1e-6 / axes.maxCoeff() * i;
      const V x = shrink * axes.cwiseProduct(std::cos(t) * a + std::sin(t) * b);
      const auto in = body.penetration(x);
      const auto foot = body.closest(x);
      REQUIRE(in.depth > 0);
      CHECK(in.depth == -foot.distance);
      const V f = in.depth * (foot.position - x).normalized(), s = in.depth * foot.normal,
              g = in.depth * in.gradient;
      if (i > 0) {
        const double step = (x - at).norm();
        worst.flat = (std::max)(worst.flat, (f - flat).norm() / step);
        worst.shaded = (std::max)(worst.shaded, (s - shaded).norm() / step);
        worst.given = (std::max)(worst.given, (g - given).norm() / step);
      }
      flat = f, shaded = s, given = g, at = x;
    }
  }
  return worst;
}

}  // namespace

TEST_CASE_TEMPLATE("mesh surface: distance, inside, depth and separation equal brute force", S, float,
                   double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  for (const auto& [name, mesh] : test::five_meshes<S>(300)) {
    INFO(std::string(name));
    const MeshSurface<S> body{TriangleMesh<S>(mesh)};
    const auto rounding = test::ulps<S>(8) * static_cast<long double>(body.upper().cwiseAbs().maxCoeff());
    for (int i = 0; i < 400; ++i) {
      const Vec3<S> x = test::random_position(mesh, random);
      const long double expected = test::brute_force_distance(mesh, x);
      const auto found = body.closest(x);
      CHECK_ABSOLUTE(found.distance, expected, rounding);
      CHECK_ABSOLUTE(found.normal.norm(), 1, test::ulps<S>(4));
      if (std::fabs(expected) > rounding) CHECK(body.inside(x) == (expected < 0));
      const auto in = body.penetration(x);
      CHECK_ABSOLUTE(in.depth, expected < 0 ? -expected : 0, rounding);
      if (in.depth > S(0)) CHECK(in.gradient.norm() <= S(1) + S(8) * std::numeric_limits<S>::epsilon());
      // Never claims too much, and is not idle: it decides to within its guard and rounding.
      const S r = static_cast<S>(std::fabs(expected)) * (i % 2 == 0 ? S(0.999L) : S(1.001L));
      const bool apart = body.separated(x, r);
      if (expected <= 0 || static_cast<long double>(r) > expected + rounding) CHECK(!apart);
      if (static_cast<long double>(r) * 1.0001L < expected - 4 * rounding) CHECK(apart);
    }
  }
}

TEST_CASE("mesh surface: an ellipsoid's depth converges with order 2, its direction with order 1") {
  using V = Vec3<double>;
  const Ellipsoid<double> exact({.axes = V(0.06, 0.04, 0.03)});
  double depth_before = 0, direction_before = 0, flat_before = 0;
  for (const std::size_t n : {488u, 1946u, 7778u}) {  // each with edges half as long
    const MeshSurface<double> body{TriangleMesh<double>(exact.mesh(n))};
    std::mt19937_64 random(seed);
    double depth = 0, direction = 0, flat = 0;
    for (int i = 0; i < 2000; ++i) {
      const V on = exact.params().axes.cwiseProduct(random_direction<double>(random));
      const V x = on - (0.5e-3 + 2.5e-3 * static_cast<double>(random() % 1000) / 1000) * exact.normal(on);
      const auto a = exact.penetration(x), b = body.penetration(x);
      depth += (a.depth - b.depth) * (a.depth - b.depth);
      direction += (a.gradient - b.gradient).squaredNorm();
      flat += ((body.closest(x).position - x).normalized() - a.gradient).squaredNorm();
    }
    if (depth_before > 0) {
      // Squared errors fall by 16 and 4; sampling and the next order leave 15 and 35 %.
      CHECK_RELATIVE(depth_before / depth, 16.0, 0.15);
      CHECK_RELATIVE(flat_before / flat, 4.0, 0.15);
      CHECK_RELATIVE(direction_before / direction, 4.0, 0.35);
    }
    CHECK(direction < 0.04 * flat);  // and is more than 5 times smaller than the triangles' own
    MESSAGE(n, " vertices: rms depth ", std::sqrt(depth / 2000), " m, direction ",
            std::sqrt(direction / 2000), ", of the triangles ", std::sqrt(flat / 2000));
    depth_before = depth, direction_before = direction, flat_before = flat;
  }
}

TEST_CASE("mesh surface: force over edges and vertices does not click") {
  using V = Vec3<double>;
  const Ellipsoid<double> exact({.axes = V(0.06, 0.04, 0.03)});
  for (const std::size_t n : {98u, 488u, 4706u}) {
    const MeshSurface<double> body{TriangleMesh<double>(exact.mesh(n))};
    CHECK(body.patches() == 1);
    for (const double depth : {0.05, 0.1, 0.2}) {
      const Clicks worst = clicks(body, exact.params().axes, 1 - depth);
      MESSAGE(n, " vertices, depth ", depth, " of the axes: largest |dF|/(k|dx|) flat ", worst.flat,
              ", interpolated ", worst.shaded, ", given ", worst.given);
      // An exact body's is 1 (the depth's change) and, for the turning, depth times curvature, below 1 here.
      CHECK(worst.given < 2);
      CHECK(worst.flat > 50);
    }
  }
}

TEST_CASE("mesh surface: a box's edges are sharp and its force turns over them, at every resolution") {
  using V = Vec3<double>;
  const V half(0.03, 0.02, 0.02);
  for (const std::size_t n : {8u, 400u}) {
    const MeshSurface<double> body{TriangleMesh<double>(Box<double>({.half = half}).mesh(n))};
    CHECK(body.patches() == 6);
    // Below the middle of a face: as the exact box. Interpolation over the edges would tilt it.
    const auto in = body.penetration(V(0.005, 0.018, -0.004));
    CHECK_RELATIVE(in.depth, 0.002, test::ulps<double>(16));  // rounding of coordinates ten times larger
    CHECK_ABSOLUTE((in.gradient - V::UnitY()).norm(), 0, test::ulps<double>(8));
    // On the bisector of two faces both count the same; at the centre of the square section four do.
    const auto edge = body.penetration(V(0, 0.018, 0.018));
    CHECK_ABSOLUTE((edge.gradient - V(0, 0.5, 0.5)).norm(), 0,
                   test::ulps<double>(64));  // weights of rounded distances
    CHECK_ABSOLUTE(body.penetration(V::Zero()).gradient.norm(), 0, test::ulps<double>(64));
    for (const double shrink : {0.75, 0.85, 0.95}) {
      const Clicks worst = clicks(body, half, shrink);
      CHECK(worst.given < 3);  // the turn over a right angle within the band of depths 1 : 2
    }
  }
}

TEST_CASE("mesh surface: the crease angle decides what is sharp") {
  const TriangleMesh<double> box(Box<double>({}).mesh(8));
  CHECK(MeshSurface<double>(box, {.crease = 1.57}).patches() == 6);  // its edges turn by pi / 2
  CHECK(MeshSurface<double>(box, {.crease = 1.58}).patches() == 1);
  CHECK(MeshSurface<double>(TriangleMesh<double>(Sphere<double>({}).mesh(98)), {.crease = 0}).patches() > 90);
}

TEST_CASE_TEMPLATE("mesh surface: touching from inside and outside, at faces, edges and vertices", S, float,
                   double) {
  const MeshData<S> mesh = test::blob<S>(200);
  const MeshSurface<S> body{TriangleMesh<S>(mesh)};
  const S size = body.upper().cwiseAbs().maxCoeff();
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3<S>, 3> p{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    for (const Vec3<S>& on : {p[0], Vec3<S>((p[0] + p[1]) / S(2)), Vec3<S>((p[0] + p[1] + p[2]) / S(3))}) {
      const auto found = body.closest(on);
      CHECK_ABSOLUTE(found.distance, 0, test::ulps<S>(4) * static_cast<long double>(size));
      // A step along the interpolated normal, far above the rounding.
      const S step = S(1e-3) * size;
      CHECK(body.closest(on + step * found.normal).distance > S(0));
      CHECK(body.penetration(on - step * found.normal).depth > S(0));
    }
  }
}

TEST_CASE_TEMPLATE("mesh surface: beside a needle's edges and tips is outside", S, float, double) {
  // Its faces meet at sharp angles: beyond an edge one of its two faces alone has that point inside.
  const MeshData<S> needle{.vertices = {{S(0), S(0), S(0)},
                                        {S(0.01), S(0), S(0)},
                                        {S(0), S(0.01), S(0)},
                                        {S(0.003), S(0.003), S(0.1)}},
                           .triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const MeshSurface<S> body{TriangleMesh<S>(needle)};
  std::array<Vec3<S>, 4> n;
  for (std::size_t t = 0; t < 4; ++t) {
    const auto& [a, b, c] = needle.triangles[t];
    n[t] =
        (needle.vertices[b] - needle.vertices[a]).cross(needle.vertices[c] - needle.vertices[a]).normalized();
  }
  const S h = S(0.002);
  const auto check = [&](const Vec3<S>& at, Vec3<S> away) {
    away.normalize();
    const SurfacePoint<S> found = body.closest(at + h * away);
    CHECK_ABSOLUTE(found.distance, static_cast<long double>(h), test::ulps<S>(8) * 0.1L);  // x is rounded
    CHECK_ABSOLUTE((found.position - at).norm(), 0, test::ulps<S>(64) * 0.1L);
    CHECK(!body.inside(at + h * away));
  };
  for (std::uint32_t v = 0; v < 4; ++v) {
    for (std::size_t t = 0; t < 4; ++t) {
      const auto& corners = needle.triangles[t];
      if (std::find(corners.begin(), corners.end(), v) == corners.end()) continue;
      Vec3<S> away = S(0.9) * n[t];  // and a little of the other two that meet at v
      for (std::size_t other = 0; other < 4; ++other) {
        const auto& its = needle.triangles[other];
        if (other != t && std::find(its.begin(), its.end(), v) != its.end()) away += S(0.05) * n[other];
      }
      check(needle.vertices[v], away);
      for (std::size_t other = 0; other < 4; ++other) {  // edges: the two corners both faces have
        if (other == t) continue;
        Vec3<S> middle = Vec3<S>::Zero();
        for (const std::uint32_t c : corners) {
          const auto& its = needle.triangles[other];
          if (std::find(its.begin(), its.end(), c) != its.end()) middle += needle.vertices[c] / S(2);
        }
        check(middle, S(0.95) * n[t] + S(0.05) * n[other]);
      }
    }
  }
}

TEST_CASE_TEMPLATE("mesh surface: rays, reach and measures", S, float, double) {
  const Box<S> exact({.half = Vec3<S>(S(0.03), S(0.02), S(0.01))});
  const MeshSurface<S> body{TriangleMesh<S>(exact.mesh(200))};
  CHECK_RELATIVE(body.reach(), 0.01, 1e-3);                           // the ray starts 1e-4 of an edge inside
  CHECK_RELATIVE(body.volume(), exact.volume(), test::ulps<S>(100));  // a sum of 400 terms
  const auto hit = body.raycast(Vec3<S>(S(0.1), S(0.001), S(0.002)), Vec3<S>(S(-2), S(0), S(0)));
  REQUIRE(hit.hit);
  CHECK_RELATIVE(hit.t, 0.035, test::ulps<S>(8));
  CHECK_ABSOLUTE(hit.position.x(), 0.03, test::ulps<S>(1));
  CHECK(!body.raycast(Vec3<S>(S(0.1), S(0), S(0)), Vec3<S>::UnitX()).hit);
}

TEST_CASE_TEMPLATE("mesh surface: queries that are not finite or absurd", S, float, double) {
  const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity();
  const MeshSurface<S> body{TriangleMesh<S>(Sphere<S>({.radius = S(0.03)}).mesh(300))};
  for (const Vec3<S>& bad : {Vec3<S>(nan, S(0), S(0)), Vec3<S>(S(0), -inf, S(0)), Vec3<S>(S(0), S(0), nan)}) {
    CHECK(body.closest(bad).distance == (std::numeric_limits<S>::max)());
    CHECK(is_finite(body.closest(bad).position));
    CHECK(body.penetration(bad).depth == S(0));
    CHECK(!body.inside(bad));
    CHECK(!body.separated(bad, S(0)));
    CHECK(!body.raycast(bad, Vec3<S>::UnitX()).hit);
    CHECK(!body.raycast(Vec3<S>::UnitX(), bad).hit);
  }
  CHECK(!body.separated(Vec3<S>::UnitX(), nan));
  CHECK(!body.separated(Vec3<S>::UnitX(), S(-1)));
  for (const S far : {S(1e3), S(1e18), S(1e37), (std::numeric_limits<S>::max)()}) {
    const auto found = body.closest(Vec3<S>(S(0), far, S(0)));
    CHECK_ABSOLUTE(found.position.y(), 0.03, 1e-3);  // the top, to the length of an edge
    CHECK_RELATIVE(found.distance, far, 1e-4);       // less the radius
  }
}

TEST_CASE_TEMPLATE("mesh surface: many points at once are as one by one, close together or not", S, float,
                   double) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<S> uniform(S(-1), S(1));
  int touching = 0;
  for (const auto& [name, data] : test::five_meshes<S>(2000)) {
    INFO(name);
    const MeshSurface<S> body{TriangleMesh<S>(data)};
    const S size = (body.upper() - body.lower()).maxCoeff();
    for (int k = 0; k < 200; ++k) {
      const Vec3<S> about = data.vertices[random() % data.vertices.size()];
      const S spread = size * (k % 4 == 0 ? S(1) : k % 4 == 1 ? S(0.1L) : S(0.01L));
      PointBatch<S> x;
      for (std::size_t i = 0; i < batch_size; ++i) {
        x.x[i] = about.x() + spread * uniform(random);
        x.y[i] = about.y() + spread * uniform(random);
        x.z[i] = about.z() + spread * uniform(random);
      }
      if (k % 5 == 0) x.y[3] = std::numeric_limits<S>::quiet_NaN();
      if (k % 7 == 0) x.z[8] = std::numeric_limits<S>::infinity();
      x.x[15] = x.x[14], x.y[15] = x.y[14], x.z[15] = x.z[14];
      PenetrationBatch<S> in;
      body.penetration(x, in);
      for (std::size_t i = 0; i < batch_size; ++i) {
        const Penetration<S> one = body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
        // The same formulas in another order.
        CHECK_ABSOLUTE(in.depth[i], one.depth, test::ulps<S>(8) * static_cast<long double>(size));
        const Vec3<S> g(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
        // Of up to 64 triangles, in another order; beside an edge the blend of two faces turns by the
        // rounding of positions over the depth.
        const S turn = one.depth > S(0) ? size / one.depth : S(0);
        CHECK_ABSOLUTE((g - one.gradient).norm(), 0,
                       test::ulps<S>(64) + test::ulps<S>(1) * static_cast<long double>(turn));
        touching += one.depth > S(0);
      }
    }
  }
  CHECK(touching > 2000);
}

TEST_CASE("mesh surface: no heap in a query, and the same bits for the same input") {
  const MeshSurface<double> body{TriangleMesh<double>(test::blob<double>(2000))};
  const MeshSurface<double> box{TriangleMesh<double>(Box<double>({}).mesh(500))};
  std::mt19937_64 random(seed);
  const test::HeapCount heap;
  int differ = 0;
  for (const MeshSurface<double>* b : {&body, &box}) {
    for (int i = 0; i < 500; ++i) {
      const Vec3<double> x =
          0.04 * random_direction<double>(random) * static_cast<double>(random() % 1000) / 1000;
      const auto p = b->penetration(x), q = b->penetration(x);
      differ += p.depth != q.depth || p.gradient != q.gradient;
      PenetrationBatch<double> in;
      PointBatch<double> batch;
      batch.x.fill(x.x()), batch.y.fill(x.y()), batch.z.fill(x.z());
      b->penetration(batch, in);
      (void)b->closest(x);
      (void)b->separated(x, 0.001);
      (void)b->raycast(x, x);
    }
  }
  CHECK(heap.allocations() == 0);
  CHECK(differ == 0);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("mesh surface: a bad crease is refused with its value") {
  try {
    const MeshSurface<double> body(TriangleMesh<double>(Box<double>({}).mesh(8)), {.crease = -1});
    FAIL("accepted");
  } catch (const SetupError& error) {
    CHECK(std::string(error.what()) == "MeshSurface: crease [rad] must be in [0, pi], got -1");
  }
}
#endif
