// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/geometry/extremal_points.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace palpate;
using palpate::test::ulps;

namespace {

template <class Body>
void check_points(const Body& body, std::size_t count) {
  using S = typename Body::Scalar;
  const auto points = extremal_points(body);
  REQUIRE(points.size() == count);
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  const S size = (body.upper() - body.lower()).norm();
  for (const auto& point : points) {
    // On the surface: a few rounding errors of the body's size.
    CHECK_ABSOLUTE(body.closest(point.position).distance / size, 0, ulps<S>(16));
    CHECK_ABSOLUTE(point.normal.norm(), 1, ulps<S>(4));
    CHECK(point.normal.dot(point.position - middle) > S(0));
    // Every mirror image is one of the points, normal and all.
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<S> image = point.position - middle, normal = point.normal;
      image[axis] = -image[axis], normal[axis] = -normal[axis];
      const bool found = std::any_of(points.begin(), points.end(), [&](const auto& other) {
        return (other.position - middle - image).norm() <= S(ulps<S>(16)) * size &&
               (other.normal - normal).norm() <= S(ulps<S>(64));
      });
      CHECK(found);
    }
  }
}

struct MyBody {  // a user's own surface with its own points
  using Scalar = double;
};
[[maybe_unused]] std::vector<ExtremalPoint<double>> extremal_points(const MyBody&) {
  return {{Vec3<double>::UnitX(), Vec3<double>::UnitX()}};
}

static_assert(HasExtremalPoints<MyBody> && HasExtremalPoints<Box<float>> &&
              HasExtremalPoints<Superellipsoid<double>>);
static_assert(!HasExtremalPoints<int>);

}  // namespace

TEST_CASE_TEMPLATE("extremal points lie on the surface and share its mirror symmetries", S, float, double) {
  const Vec3<S> centre(S(0.01), S(-0.02), S(0.03));
  check_points(Box<S>({.half = {S(0.03), S(0.02), S(0.01)}, .centre = centre}), 8);
  check_points(Ellipsoid<S>({.axes = {S(0.03), S(0.02), S(0.01)}, .centre = centre}), 6);
  check_points(Ellipsoid<S>({.axes = {S(0.03), S(0.02), S(0.02)}, .centre = centre}), 6);
  check_points(Sphere<S>({.radius = S(0.03), .centre = centre}), 6);
  check_points(Cylinder<S>({.radius = S(0.02), .half_height = S(0.03), .centre = centre}), 8);
  check_points(
      Superellipsoid<S>({.axes = {S(0.03), S(0.02), S(0.02)}, .e1 = S(0.5), .e2 = S(0.7), .centre = centre}),
      14);
}

TEST_CASE("box: the points are the vertices, to the bit") {
  const Box<double> box({.half = {0.03, 0.02, 0.01}});
  const auto points = extremal_points(box);
  for (unsigned i = 0; i < 8; ++i) {
    CHECK(points[i].position ==
          Vec3<double>((i & 1u) ? 0.03 : -0.03, (i & 2u) ? 0.02 : -0.02, (i & 4u) ? 0.01 : -0.01));
  }
}

TEST_CASE("ellipsoid: the points do not jump as two axes become equal") {
  const auto a = extremal_points(Ellipsoid<double>({.axes = {0.03, 0.02 * (1 + 1e-12), 0.02}}));
  const auto b = extremal_points(Ellipsoid<double>({.axes = {0.03, 0.02 * (1 - 1e-12), 0.02}}));
  for (std::size_t i = 0; i < 6; ++i) CHECK((a[i].position - b[i].position).norm() <= 1e-13);
}

TEST_CASE("shading normals: the surface's own where it is smooth, no jump over a box's edge") {
  const Ellipsoid<double> ellipsoid({.axes = {0.03, 0.02, 0.01}});
  const Vec3<double> p = ellipsoid.point(0.1, 0.3);
  CHECK(shading_normal(ellipsoid, p) == ellipsoid.closest(p).normal);
  const Box<double> box({.half = {0.03, 0.02, 0.02}});
  const Vec3<double> a = shading_normal(box, Vec3<double>(0.01, 0.02, 0.02 * (1 - 1e-9)));
  const Vec3<double> b = shading_normal(box, Vec3<double>(0.01, 0.02 * (1 - 1e-9), 0.02));
  CHECK((a - b).norm() <= 1e-7);  // slope 7 in units of the body, over 1e-9
  // Half way to the edge the face's own normal to less than 1 degree.
  CHECK(shading_normal(box, Vec3<double>(0.015, 0.02, 0.01)).y() > 0.9998);
  CHECK(
      shading_normal(Cylinder<double>({.radius = 0.02, .half_height = 0.03}), Vec3<double>(0, 0.03, 0)).y() ==
      1.0);
}
