// SPDX-License-Identifier: MIT

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/geometry/superellipsoid.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace palpate;

namespace {

using V = Vec3<double>;
static_assert(ContactSurface<SampledSurface<MeshSurface<float>>>);
static_assert(HasPenetrationBatch<SampledSurface<MeshSurface<float>>>);
static_assert(ContactSurface<SampledSurface<Ellipsoid<double>>>);
static_assert(ContactSurface<SampledSurface<Superellipsoid<double>>>);

V random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random), y = normal(random), z = normal(random);
  return V(x, y, z).normalized();
}

}  // namespace

TEST_CASE("sampled surface: an ellipsoid's depth converges with order 3, its direction with order 2") {
  const Ellipsoid<double> exact({.axes = V(0.06, 0.04, 0.03)});
  double depth_before = 0, direction_before = 0;
  for (const double w : {4e-3, 2e-3, 1e-3}) {
    const SampledSurface<Ellipsoid<double>> body(exact, {.spacing = w});
    std::mt19937_64 random(3);
    double depth = 0, direction = 0;
    for (int i = 0; i < 4000; ++i) {
      const V on = exact.params().axes.cwiseProduct(random_direction(random));
      const V x = on - (1e-3 + 2e-3 * static_cast<double>(random() % 1000) / 1000) * exact.normal(on);
      const auto a = exact.penetration(x), b = body.penetration(x);
      depth += (a.depth - b.depth) * (a.depth - b.depth);
      direction += (a.gradient - b.gradient).squaredNorm();
    }
    MESSAGE("w = ", w, " m: rms depth ", std::sqrt(depth / 4000), " m, direction ",
            std::sqrt(direction / 4000));
    if (depth_before > 0) {
      // Squared errors fall by at least 64 and 16; a quarter less where the next order still counts (w / R =
      // 0.2).
      CHECK(depth_before / depth > 48);
      CHECK(direction_before / direction > 12);
    }
    depth_before = depth, direction_before = direction;
  }
}

TEST_CASE("sampled surface: depth stays within 1.62 spacings of the mesh's, whatever its edges") {
  for (const auto& [name, mesh] : test::five_meshes<double>(100)) {
    const MeshSurface<double> exact{TriangleMesh<double>(mesh)};
    const double w = 2e-3;
    const SampledSurface<MeshSurface<double>> body(exact, {.spacing = w});
    std::mt19937_64 random(4);
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
      const V x = test::random_position(mesh, random);
      const double d = exact.closest(x).distance, depth = body.penetration(x).depth;
      worst = (std::max)(worst, std::abs(depth - (std::max)(-d, 0.0)));
    }
    INFO(std::string(name));
    MESSAGE(std::string(name), ": largest difference ", worst, " m at a spacing of ", w);
    CHECK(worst <= 1.62 * w);
  }
}

TEST_CASE("sampled surface: the gradient is the depth's derivative, and turns without a jump") {
  const Box<double> box({.half = V(0.02, 0.015, 0.01)});
  const MeshData<double> coarse = box.mesh(8);
  const MeshSurface<double> mesh{TriangleMesh<double>(box.mesh(200))};
  const SampledSurface<MeshSurface<double>> body(mesh, {.spacing = 1.5e-3});
  std::mt19937_64 random(5);
  int inside = 0;
  for (int i = 0; i < 3000; ++i) {
    const V x = test::random_position(coarse, random);
    const auto in = body.penetration(x);
    if (!(in.depth > 1e-5)) continue;
    ++inside;
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
      const auto more = body.penetration(x + h * V::Unit(k)), less = body.penetration(x - h * V::Unit(k));
      // Depth is in float: 0.02 m to 2e-9 m, over 2e-6 m. Second derivatives are below 2 / w, so h adds 1e-3.
      CHECK_ABSOLUTE((less.depth - more.depth) / (2 * h), in.gradient[k], 4e-3);
      CHECK((more.gradient - less.gradient).norm() < 2 * h * 12 / 1.5e-3);
    }
  }
  CHECK(inside > 500);
}

TEST_CASE_TEMPLATE("sampled surface: many points at once are as one by one", S, float, double) {
  const MeshSurface<S> mesh{TriangleMesh<S>(test::blob<S>(500))};
  const SampledSurface<MeshSurface<S>> body(mesh, {.spacing = S(1.5e-3)});
  const Vec3<S> middle = (mesh.lower() + mesh.upper()) / S(2), half = (mesh.upper() - mesh.lower()) / S(2);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<S> uniform(S(-1), S(1));
  int inside = 0, outside = 0;
  for (int k = 0; k < 500; ++k) {
    // Within the body, about its box, and past the grid's rim.
    const S reach = k % 3 == 0 ? S(0.8) : k % 3 == 1 ? S(1.05) : S(2);
    PointBatch<S> x;
    for (std::size_t i = 0; i < batch_size; ++i) {
      x.x[i] = middle.x() + reach * half.x() * uniform(random);
      x.y[i] = middle.y() + reach * half.y() * uniform(random);
      x.z[i] = middle.z() + reach * half.z() * uniform(random);
    }
    x.y[3] = std::numeric_limits<S>::quiet_NaN();
    x.z[8] = std::numeric_limits<S>::infinity();
    x.x[11] = (std::numeric_limits<S>::max)();
    PenetrationBatch<S> in;
    body.penetration(x, in);
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Penetration<S> one = body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
      // Sums of 27 samples in float, and in S = float a position rounded to a few parts in 1e5 of a spacing.
      const long double rounding = test::ulps<float>(64) * static_cast<long double>(half.maxCoeff());
      CHECK_ABSOLUTE(in.depth[i], one.depth, rounding);
      if (!(static_cast<long double>(one.depth) > rounding)) {
        ++outside;
        continue;
      }
      ++inside;
      const Vec3<S> g(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
      CHECK_ABSOLUTE((g - one.gradient).norm(), 0,
                     4 * rounding / 1.5e-3L);  // of a spline as wide as a spacing
    }
    CHECK(in.depth[3] == S(0));
    CHECK(in.depth[8] == S(0));
    CHECK(in.depth[11] == S(0));
  }
  CHECK(inside > 1000);
  CHECK(outside > 1000);
}

TEST_CASE("sampled surface: separation never hides a contact and decides where it matters") {
  const MeshSurface<double> mesh{TriangleMesh<double>(test::blob<double>(500))};
  const SampledSurface<MeshSurface<double>> body(mesh, {.spacing = 1.5e-3});
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  int apart = 0, near = 0;
  for (int i = 0; i < 20000; ++i) {
    const V x = 0.12 * (V(unit(random), unit(random), unit(random)) - V::Constant(0.5));
    const double r = 0.03 * unit(random) * unit(random);
    if (body.separated(x, r)) {
      ++apart;
      CHECK(!(body.penetration(x + r * unit(random) * random_direction(random)).depth > 0));
    } else if (mesh.separated(x, r + 13.2e-3) && (x.array() > mesh.lower().array()).all() &&
               (x.array() < mesh.upper().array()).all()) {
      // A block's middle is within 3.5 spacings, which counts twice, and the margin is 1.63: 8.7 spacings.
      ++near;
    }
  }
  CHECK(apart > 5000);
  CHECK(near == 0);
}

TEST_CASE_TEMPLATE("sampled surface: small balls beside the body are apart, and none that touches is", S,
                   float, double) {
  // w is larger than the balls: what is known of the distance is the field itself, not its nodes.
  constexpr S w = S(2e-3L);
  const SampledSurface<Ellipsoid<S>> body(Ellipsoid<S>({.axes = {S(0.03L), S(0.02L), S(0.02L)}}),
                                          {.spacing = w});
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const SurfacePoint<S> at = body.closest(Vec3<S>((0.03 * random_direction(random)).template cast<S>()));
    const S r = static_cast<S>(1e-4 + 1.5e-3 * unit(random));
    CHECK(body.separated(at.position + S(2) * r * at.normal, r));
    const Vec3<S> near = at.position + static_cast<S>(1.2 * unit(random)) * r * at.normal;
    if (!(body.penetration(near - r * at.normal).depth > S(0))) continue;
    ++touching;
    CHECK(!body.separated(near, r));
  }
  CHECK(touching > 1000);
}

TEST_CASE_TEMPLATE("sampled surface: queries that are not finite, heap, and the same bits", S, float,
                   double) {
  const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity();
  const SampledSurface<Ellipsoid<S>> body(Ellipsoid<S>({.axes = Vec3<S>(S(0.03), S(0.02), S(0.02))}),
                                          {.spacing = S(2e-3)});
  const test::HeapCount heap;
  for (const S bad : {nan, inf, -inf}) {
    CHECK(body.penetration(Vec3<S>(bad, S(0), S(0))).depth == S(0));
    CHECK(!body.separated(Vec3<S>(S(0), bad, S(0)), S(0)));
  }
  CHECK(!body.separated(Vec3<S>::Zero(), nan));
  CHECK(!body.separated(Vec3<S>::UnitX(), S(-1)));
  CHECK(body.separated(Vec3<S>(S(1e30), S(0), S(0)), S(1)));
  CHECK(body.penetration(Vec3<S>::Zero()).depth > S(0.018));
  CHECK(body.penetration(Vec3<S>(S(0.029), S(0), S(0))).depth ==
        body.penetration(Vec3<S>(S(0.029), S(0), S(0))).depth);
  CHECK(heap.allocations() == 0);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("sampled surface: spacings that are refused") {
  const auto refusal = [](double w) -> std::string {
    try {
      const SampledSurface<Ellipsoid<double>> body(Ellipsoid<double>({.axes = V(0.03, 0.02, 0.02)}),
                                                   {.spacing = w});
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal(0) == "SampledSurface: spacing [m] must be > 0, got 0");
  CHECK(refusal(1e-5) == "SampledSurface: spacing [m] asks for more than 50 million nodes, got 1e-05");
  CHECK(refusal(1e-300) == "SampledSurface: spacing [m] asks for more than 50 million nodes, got 1e-300");
}
#endif
