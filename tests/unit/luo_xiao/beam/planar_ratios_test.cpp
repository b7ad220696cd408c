// SPDX-License-Identifier: MIT
// (6)-(8) as printed: right in the plane, and where it has no solution.
#include "unit/luo_xiao/beam/reference.hpp"

#include <palpate/luo_xiao/beam/skeleton.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <algorithm>

using namespace palpate;
using palpate::test::L;
using palpate::test::VecL;

namespace {

constexpr std::uint64_t seed = 20050609;
using Planar = Skeleton<double, EulerBernoulli<double>, VolumePreserving<double>, PlanarRatios>;

Planar make(const std::vector<Vec3<double>>& points) {
  return Planar(points, EulerBernoulli<double>(IsotropicElasticity<double>({})),
                VolumePreserving<double>({.volume = 1e-4}));
}

Planar::Load share(const Planar& planar, const Vec3<double>& position, const Vec3<double>& F,
                   const Vec3<double>& D) {
  Planar::Load load;
  planar.share({.position = position, .force = F, .displacement = D}, load);
  return load;
}

std::vector<Vec3<double>> cube() {
  std::vector<Vec3<double>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(Vec3<double>(i & 1 ? 0.03 : -0.03, i & 2 ? 0.06 : 0, i & 4 ? 0.03 : -0.03));
  return points;
}

std::vector<Vec3<double>> ellipsoid() {
  return {{-0.03, 0.02, 0}, {0.03, 0.02, 0}, {0, 0, 0}, {0, 0.04, 0}, {0, 0.02, -0.02}, {0, 0.02, 0.02}};
}

}  // namespace

TEST_CASE("in a plane of any attitude: forces are the 2 x 2 system's, ratios hold, the sum is F") {
  std::mt19937_64 random(seed);
  int solved = 0, wrong_direction = 0;
  for (int round = 0; round < 1000; ++round) {
    const Mat3<double> R = test::random_rotation(random);
    const auto flat = [&](double size) {
      const Vec3<double> v = test::random_vector<double>(random, size);
      return Vec3<double>(v.x(), v.y(), 0);
    };
    std::vector<Vec3<double>> points;
    for (int i = 0; i < 3 + round % 8; ++i) points.push_back(R * flat(0.03));
    const Vec3<double> D = R * flat(0.001), F = D * 100;  // the paper's: F along D
    const auto load = share(make(points), Vec3<double>::Zero(), F, D);
    if (!load.shared) continue;
    ++solved;
    // Reference: two multipliers by Cramer's rule, in the plane's own coordinates.
    VecL a = VecL::Zero(), b = VecL::Zero();
    const auto parts = [&](const Vec3<double>& e) {
      const VecL arm = -e.cast<L>(), x = arm.normalized(), along = x * x.dot(D.cast<L>());
      return std::pair<VecL, VecL>(along / arm.norm(),
                                   (D.cast<L>() - along) / (arm.norm() * arm.norm() * arm.norm()));
    };
    for (const auto& e : points) a += parts(e).first, b += parts(e).second;
    const VecL n = R.col(2).cast<L>(), f = F.cast<L>();
    const L det = n.dot(a.cross(b)), cx = n.dot(f.cross(b)) / det, cy = n.dot(a.cross(f)) / det;
    if (cx < 0 || cy < 0) ++wrong_direction;
    VecL sum = VecL::Zero();
    // The columns may be within 1e-6 of each other in direction: digits are lost by that sine.
    const L lost = a.norm() * b.norm() / std::fabs(det), tolerance = 1e-13L * lost * lost * f.norm();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto [x, y] = parts(points[i]);
      CHECK((load.beams[i].force.cast<L>() - cx * x - cy * y).norm() <= tolerance);
      sum += load.beams[i].force.cast<L>();
    }
    CHECK((sum - f).norm() <= tolerance);
  }
  MESSAGE("planar skeletons solved: ", solved, " of 1000; a beam pushes in the wrong direction in ",
          wrong_direction);
  CHECK(solved >= 990);
}

TEST_CASE("rank test: symmetric about the load the solution is not unique, and no force is given") {
  const Vec3<double> down(0, -1, 0);
  // The paper's own cases: the top of the cube's centre, the ellipsoid's pole; and a plane fan symmetric
  // about D.
  CHECK_FALSE(share(make(cube()), Vec3<double>(0, 0.06, 0), down, down * 1e-3).shared);
  CHECK_FALSE(share(make(ellipsoid()), Vec3<double>(0, 0.04, 0), down, down * 1e-3).shared);
  CHECK_FALSE(
      share(make({{-0.03, 0, 0}, {0.03, 0, 0}, {0, -0.05, 0}}), Vec3<double>(0, 0.01, 0), down, down * 1e-3)
          .shared);
  const auto load = share(make(cube()), Vec3<double>(0, 0.06, 0), down, down * 1e-3);
  for (const auto& beam : load.beams) CHECK(beam.force == Vec3<double>(Vec3<double>::Zero()));
  // Each of them is an ordinary case for the common end.
  const Skeleton<double> common(cube(), make(cube()).theory(), VolumePreserving<double>({.volume = 1e-4}));
  Skeleton<double>::Load good;
  common.share({.position = Vec3<double>(0, 0.06, 0), .force = down}, good);
  CHECK(good.shared);
}

TEST_CASE("in space the printed form has no solution: F is not in the plane of the two columns") {
  std::mt19937_64 random(seed + 1);
  int solved = 0;
  for (int round = 0; round < 1000; ++round) {
    std::vector<Vec3<double>> points;
    for (int i = 0; i < 3 + round % 18; ++i) points.push_back(test::random_vector<double>(random, 0.03));
    const Vec3<double> D = test::random_vector<double>(random, 0.001);
    if (share(make(points), Vec3<double>::Zero(), D * 100, D).shared) ++solved;
  }
  MESSAGE("space skeletons solved by the printed form: ", solved, " of 1000");
  CHECK(solved <= 2);  // a chance of about 1e-6 over the residual's median of 4 % each
}

TEST_CASE("the printed form on bad input: zero displacement, zero force, NaN") {
  const auto planar = make({{-0.03, 0, 0}, {0.02, 0, 0}, {0, -0.05, 0}});
  const Vec3<double> position(0, 0.01, 0), F(0.1, -1, 0), D(1e-4, -1e-3, 0), zero = Vec3<double>::Zero();
  CHECK(share(planar, position, F, D).shared);
  CHECK_FALSE(share(planar, position, F, zero).shared);
  CHECK_FALSE(share(planar, position, zero, D).shared);
  CHECK_FALSE(share(planar, position, F, Vec3<double>(0, std::nan(""), 0)).shared);
}
