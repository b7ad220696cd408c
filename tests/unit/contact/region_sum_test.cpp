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

TEST_CASE_TEMPLATE("a leaf's points at once have the sum of the points one by one; torque is arm x force", S,
                   float, double) {
  std::mt19937 random(8);
  std::uniform_real_distribution<S> any(S(-1), S(1));
  const Vec3<S> mass(S(0.25), S(-0.5), S(0.75));
  LeafSum<S> leaves(mass);
  RegionSum<S> single;
  for (int leaf = 0; leaf < 3; ++leaf) {
    PointBatch<S> x{};
    PenetrationBatch<S> in{};
    typename LeafSum<S>::List f{}, per_area{};
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Vec3<S> p(any(random), any(random), any(random));
      const Vec3<S> g = Vec3<S>(any(random), any(random), any(random)).normalized();
      x.x[i] = p.x(), x.y[i] = p.y(), x.z[i] = p.z();
      in.gradient_x[i] = g.x(), in.gradient_y[i] = g.y(), in.gradient_z[i] = g.z();
      per_area[i] = S(2);
      const bool touches = i % 3 != 0;
      in.depth[i] = touches ? std::abs(any(random)) : S(-0.5);
      f[i] = touches ? std::abs(any(random)) : S(0);
      if (touches) single.add(p, p - mass, g, in.depth[i], f[i], S(0.5));
    }
    leaves.add(x, in, f, per_area);
  }
  const RegionSum<S> all = leaves.total();
  constexpr S rounding =
      S(64) * std::numeric_limits<S>::epsilon();  // of sums of some twenty numbers of order 1
  CHECK((all.force - single.force).norm() <= rounding);
  CHECK((all.torque - single.torque).norm() <= rounding);
  CHECK((all.moment - single.moment).norm() <= rounding);
  CHECK(std::abs(all.magnitude - single.magnitude) <= rounding * S(8));
  CHECK(std::abs(all.spread - single.spread) <= rounding * S(8));
  CHECK(all.deepest == single.deepest);
  CHECK(all.position == single.position);
  CHECK(all.points == single.points);

  RegionSum<S> one;  // 2 N along x, 3 m above the centre of mass: 6 N m about y
  one.add(Vec3<S>(S(0), S(0), S(3)), Vec3<S>(S(0), S(0), S(3)), Vec3<S>::UnitX(), S(1), S(2), S(1));
  CHECK(one.torque == Vec3<S>(S(0), S(6), S(0)));
  one.add(Vec3<S>(S(0), S(0), S(-1)), Vec3<S>(S(2), S(0), S(0)));  // -2 N m about y: (0,0,-1) x (2,0,0)
  CHECK(one.torque == Vec3<S>(S(0), S(4), S(0)));
  CHECK(EnergySum<S>{}.weight() == S(0));  // of no point
}
