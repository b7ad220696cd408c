// SPDX-License-Identifier: MIT

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/grown_surface.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/shared_surface.hpp>
#include <palpate/geometry/sphere.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace palpate;

namespace {
using V = Vec3<double>;
static_assert(ContactSurface<GrownSurface<Ellipsoid<float>>> && SampledBody<GrownSurface<Ellipsoid<double>>>);
static_assert(ContactSurface<SharedSurface<MeshSurface<double>>> &&
              SampledBody<SharedSurface<MeshSurface<double>>> &&
              HasPenetrationBatch<SharedSurface<MeshSurface<double>>>);
static_assert(HasCurvature<SharedSurface<Sphere<double>>> &&
              !HasCurvature<SharedSurface<MeshSurface<double>>>);
}  // namespace

TEST_CASE("grown surface: a sphere grown by r is the sphere of radius R + r") {
  const Sphere<double> exact({.radius = 0.05});
  const GrownSurface<Sphere<double>> grown(Sphere<double>({.radius = 0.03}), 0.02);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> at(-0.07, 0.07);
  for (int i = 0; i < 500; ++i) {
    const double x = at(random), y = at(random), z = at(random);
    const V p(x, y, z);
    const auto l = grown.penetration(p), r = exact.penetration(p);
    CHECK_ABSOLUTE(l.depth, r.depth, 1e-16);                           // rounding of 0.05
    if (r.depth > 0) CHECK((l.gradient - r.gradient).norm() < 1e-12);  // rounding over the distance to r
    CHECK_ABSOLUTE(grown.closest(p).distance, exact.closest(p).distance, 1e-16);
    CHECK((grown.closest(p).position - exact.closest(p).position).norm() < 1e-13);
    CHECK(grown.separated(p, 0.01) == exact.separated(p, 0.01));
  }
  CHECK(grown.upper() == V::Constant(0.05));
  CHECK(grown.lower() == V::Constant(-0.05));
  CHECK(grown.reach() == 0.05);
}

TEST_CASE("grown surface: a ball pressed on a box is as deep as its centre says, also over an edge") {
  const GrownSurface<Box<double>> grown(Box<double>({.half = V(0.05, 0.04, 0.05)}), 0.01);
  CHECK_ABSOLUTE(grown.penetration(V(0, 0.048, 0)).depth, 0.002, 1e-17);
  CHECK((grown.penetration(V(0, 0.048, 0)).gradient - V::UnitY()).norm() < 1e-14);
  const V beside = V(0.05, 0.04, 0) + 0.009 * V(0.6, 0.8, 0);
  CHECK_ABSOLUTE(grown.penetration(beside).depth, 0.001, 1e-16);
  CHECK((grown.penetration(beside).gradient - V(0.6, 0.8, 0)).norm() < 1e-12);
  // On the box's surface the direction is its normal, and nothing divides by the distance.
  CHECK(grown.penetration(V(0.01, 0.04, 0.01)).depth == 0.01);
  CHECK(grown.penetration(V(0.01, 0.04, 0.01)).gradient == V(V::UnitY()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(grown.penetration(V(nan, 0, 0)).depth == 0);
  CHECK(!grown.separated(V(0, 1, 0), -1.0));
  CHECK_THROWS_AS(GrownSurface<Box<double>>(grown.body(), 0), SetupError);
}

TEST_CASE("shared surface: the body's own answers, and one body in memory") {
  const auto sphere = std::make_shared<const Sphere<double>>(Sphere<double>::Params{.radius = 0.03});
  const SharedSurface<Sphere<double>> shared(sphere), copy = shared;
  CHECK(&copy.body() == sphere.get());
  const V x(0.01, 0.02, -0.005);
  CHECK(copy.closest(x).position == sphere->closest(x).position);
  CHECK(copy.penetration(x).depth == sphere->penetration(x).depth);
  CHECK(copy.reach() == sphere->reach());
  CHECK(copy.lower() == sphere->lower());
  CHECK(copy.separated(V(0, 0.05, 0), 0.01));
  CHECK(copy.curvature(V(0.03, 0, 0)).k1 == sphere->curvature(V(0.03, 0, 0)).k1);
}
