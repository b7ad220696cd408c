// SPDX-License-Identifier: MIT
#include <palpate/contact/region_sum.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <random>

using namespace palpate;

namespace {

template <class S>
void check_same(const PointForce<S>& point, const RegionSum<S>& sum) {
  // A gradient is taken for a unit vector as it is within 4 epsilon of one (8 of its square); the rest is for
  // the roundings of a root, divisions and products on either side.
  constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
  CHECK(point.force == sum.force);
  CHECK(point.torque == sum.torque);
  CHECK(point.deepest == sum.deepest);
  CHECK(point.points == sum.points);
  CHECK(point.area() == sum.area());
  CHECK((point.normal() - sum.normal()).norm() <= rounding);
  CHECK(std::abs(point.normal_force() - sum.normal_force()) <= rounding * sum.normal_force());
  CHECK((point.centre() - sum.centre()).norm() <= rounding * sum.centre().norm());
}

}  // namespace

TEST_CASE_TEMPLATE("a point's force is a region's of one point, to rounding", S, float, double) {
  std::mt19937 random(7);
  std::uniform_real_distribution<S> any(S(-1), S(1));
  const auto vector = [&] { return Vec3<S>(any(random), any(random), any(random)); };
  for (int i = 0; i < 1000; ++i) {
    CAPTURE(i);
    const Vec3<S> x = vector(), arm = vector();
    Vec3<S> gradient = unit_or<S>(vector(), Vec3<S>::UnitX());
    if (i % 3 == 0) gradient *= std::abs(any(random));  // over an edge
    if (i % 100 == 1) gradient.setZero();
    const S depth = std::abs(any(random)), f = i % 50 == 2 ? S(0) : std::abs(any(random));
    PointForce<S> point;
    RegionSum<S> sum;
    point.add(x, arm, gradient, depth, f, S(0));
    sum.add(x, arm, gradient, depth, f, S(0));
    check_same(point, sum);
    point.scale(S(1.5));
    sum.scale(S(1.5));
    check_same(point, sum);
  }
}
