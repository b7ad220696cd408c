// SPDX-License-Identifier: MIT
#include "unit/luo_xiao/beam/reference.hpp"

#include <palpate/luo_xiao/beam/end_release.hpp>
#include <palpate/luo_xiao/beam/rectangular_section.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <algorithm>
#include <numbers>

using namespace palpate;
using palpate::test::L;
using palpate::test::MatL;
using palpate::test::VecL;

namespace {

constexpr std::uint64_t seed = 20050611;

// The literal path in long double: beam frame with y along the load across the beam, stress at the centroid,
// strain by compliance, R eps R^T, times the arm. mean_shear is tau_yx per newton.
VecL literal(L E, L nu, L area, L mean_shear, const VecL& axis, const VecL& force, const VecL& arm) {
  const VecL x = axis.normalized();
  const VecL y = (force - x * x.dot(force)).normalized(), z = x.cross(y);
  const L sigma = force.dot(x) / area, tau = force.dot(y) * mean_shear;
  MatL e = MatL::Zero(), R;
  e(0, 0) = sigma / E;
  e(1, 1) = e(2, 2) = -nu * sigma / E;
  e(0, 1) = e(1, 0) = (1 + nu) * tau / E;  // half of tau/G
  R << x, y, z;
  return R * e * R.transpose() * arm;
}

std::vector<Vec3<double>> ellipsoid() {  // 60 x 40 x 40 mm, bottom at the origin
  return {{-0.03, 0.02, 0}, {0.03, 0.02, 0}, {0, 0, 0}, {0, 0.04, 0}, {0, 0.02, -0.02}, {0, 0.02, 0.02}};
}

Skeleton<double> make(double nu = 0.5) {
  return Skeleton<double>(ellipsoid(),
                          EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e6, .nu = nu})),
                          VolumePreserving<double>({.volume = 5.02654824574366919e-5}));
}

std::vector<Vec3<double>> release_at(const Skeleton<double>& k, const Vec3<double>& position,
                                     const Vec3<double>& F, const Vec3<double>& D) {
  Skeleton<double>::Load load;
  k.share({.position = position, .force = F}, load);
  std::vector<Vec3<double>> u(6);
  release(k, load, Vec3<double>(Vec3<double>::Zero()), D, std::span<Vec3<double>>(u));
  return u;
}

// The upper point of the ellipsoid over (x, z).
Vec3<double> on_top(double x, double z) {
  return {x, 0.02 + 0.02 * std::sqrt(1 - x * x / (0.03 * 0.03) - z * z / (0.02 * 0.02)), z};
}

}  // namespace

TEST_CASE("one beam: displacement is R eps R^T (e - o) in the beam's own frame, for every nu and section") {
  std::mt19937_64 random(seed);
  for (int round = 0; round < 200; ++round) {
    const double nu = std::array{0.0, 0.3, 0.5}[static_cast<std::size_t>(round % 3)], E = 2.3e6;
    const IsotropicElasticity<double> material({.E = E, .nu = nu});
    const Vec3<double> axis = test::random_vector<double>(random, 1).normalized();
    const Vec3<double> F = test::random_vector<double>(random, 1),
                       arm = test::random_vector<double>(random, 0.05);
    const CircularSection<double> circle({.radius = 0.004});
    const L area = std::numbers::pi_v<L> * 0.004L * 0.004L, n = nu;
    const VecL exact =
        literal(E, n, area, (3 + 2 * n) / (2 * (1 + n) * area), axis.cast<L>(), F.cast<L>(), arm.cast<L>());
    const L size = F.norm() * arm.norm() / (area * E);
    CHECK((released_displacement(circle, material, axis, F, arm).cast<L>() - exact).norm() <= 1e-14L * size);

    const RectangularSection<double> box({.half_y = 0.004, .half_z = 0.006});
    const VecL other =
        literal(E, n, box.area(), box.flexure_shear(nu, 0, 0).yx, axis.cast<L>(), F.cast<L>(), arm.cast<L>());
    CHECK((released_displacement(box, material, axis, F, arm).cast<L>() - other).norm() <= 1e-13L * size);
  }
}

TEST_CASE("no load across the beam needs no direction y; nu = 1/2 keeps the volume") {
  const IsotropicElasticity<double> rubber({.E = 1e6, .nu = 0.5});
  const CircularSection<double> circle({.radius = 0.01});
  const Vec3<double> x(1, 0, 0), arm(0.02, 0.03, 0);
  const Vec3<double> u = released_displacement(circle, rubber, x, Vec3<double>(-2, 0, 0), arm);
  const double e = -2 / circle.area() / 1e6;
  CHECK((u - Vec3<double>(e * 0.02, -e / 2 * 0.03, 0)).norm() <= 1e-18);
  const Vec3<double> F(-2, 1, 0.5);
  double trace = 0;
  for (int i = 0; i < 3; ++i)
    trace += released_displacement(circle, rubber, x, F, Vec3<double>(Vec3<double>::Unit(i)))[i];
  CHECK_ABSOLUTE(trace, 0, 1e-16);  // strains of 1e-2, rounding
}

TEST_CASE("skeleton: every extremal point moves as its beam says, the fixed centre stays") {
  const auto skeleton = make(0.3);
  const Vec3<double> position = on_top(0.011, 0.004), F(0.2, -1, 0.1), D(0, -0.002, 0);
  Skeleton<double>::Load load;
  skeleton.share({.position = position, .force = F}, load);
  const auto u = release_at(skeleton, position, F, D);
  test::ReferenceRegions r{{}, {position.cast<L>()}, {F.cast<L>()}, {{0}}, 1e6, 5.02654824574366919e-5L};
  for (const auto& p : ellipsoid()) r.points.push_back(p.cast<L>());
  const VecL d = r.displacements()[0];
  const L area = r.area(0);
  for (std::size_t i = 0; i < 6; ++i) {
    const VecL e = r.points[i];
    const VecL exact = literal(1e6, 0.3L, area, 3.6L / (2.6L * area), r.positions[0] - e, r.own(0, i) * d, e);
    CHECK((u[i].cast<L>() - exact).norm() <=
          1e-12L * F.norm() * 0.05L / (area * 1e6L));  // the solve's rounding
  }
  CHECK(u[2] == Vec3<double>(Vec3<double>::Zero()));
  const auto twice = release_at(skeleton, position, 2 * F, D);
  for (std::size_t i = 0; i < 6; ++i) CHECK((twice[i] - 2 * u[i]).norm() <= 1e-14 * u[3].norm() + 1e-18);
}

TEST_CASE("turning body, contact and load turns the displacements") {
  std::mt19937_64 random(seed + 1);
  const auto skeleton = make();
  const Vec3<double> position = on_top(-0.008, 0.006), F(0.3, -1, 0.2), D(0, -0.002, 0.001);
  const auto u = release_at(skeleton, position, F, D);
  for (int round = 0; round < 20; ++round) {
    const Mat3<double> R = test::random_rotation(random);
    auto points = ellipsoid();
    for (auto& p : points) p = Vec3<double>(R * p);
    const Skeleton<double> turned(points, skeleton.theory(),
                                  VolumePreserving<double>({.volume = 5.02654824574366919e-5}));
    Skeleton<double>::Load load;
    turned.share({.position = Vec3<double>(R * position), .force = Vec3<double>(R * F)}, load);
    std::vector<Vec3<double>> v(6);
    release(turned, load, Vec3<double>(Vec3<double>::Zero()), Vec3<double>(R * D),
            std::span<Vec3<double>>(v));
    for (std::size_t i = 0; i < 6; ++i) CHECK((v[i] - R * u[i]).norm() <= 1e-12 * u[3].norm());  // rounding
  }
}

TEST_CASE(
    "contact wanders over an extremal point: no jump on any path, and on it the point moves with the "
    "contact") {
  const auto skeleton = make();
  const Vec3<double> F(0.1, -1, 0.05), D(0.0002, -0.002, 0);
  const auto top = release_at(skeleton, Vec3<double>(0, 0.04, 0), F, D);
  CHECK((top[3] - D).norm() <= 1e-9 * D.norm());  // within min_length over release_blend
  for (const double angle : {0.0, 0.7, 1.9, 2.6}) {
    double max_step = 0;
    auto before = release_at(skeleton, on_top(-0.002 * std::cos(angle), -0.002 * std::sin(angle)), F, D);
    for (int step = 1; step <= 4000; ++step) {
      const double s = -0.002 + step * 1e-6;  // through the pole in steps of a micrometre
      const auto now = release_at(skeleton, on_top(s * std::cos(angle), s * std::sin(angle)), F, D);
      for (std::size_t i = 0; i < 6; ++i) max_step = std::max(max_step, (now[i] - before[i]).norm());
      before = now;
    }
    // Blend zone of 0.01 times 40 mm: |D - u| of about 3 mm over 0.4 mm is 7.5 um per um.
    INFO("angle ", angle, " max step ", max_step);
    CHECK(max_step <= 1e-5);
  }
}

TEST_CASE_TEMPLATE("release in the scene's scalar: rounding only; not shared gives zeros; no heap", S, float,
                   double) {
  std::vector<Vec3<S>> points;
  for (const auto& p : ellipsoid()) points.push_back(p.cast<S>());
  const Skeleton<S> skeleton(points, make().theory(),
                             VolumePreserving<double>({.volume = 5.02654824574366919e-5}));
  typename Skeleton<S>::Load load;
  const Vec3<double> position = on_top(0.01, 0.005), F(0.2, -1, 0);
  std::vector<Vec3<S>> u(6);
  const Vec3<S> o = Vec3<S>::Zero(), D(0, S(-0.002), 0);
  const test::HeapCount heap;
  skeleton.share({.position = position.cast<S>(), .force = F.cast<S>()}, load);
  release(skeleton, load, o, D, std::span<Vec3<S>>(u));
  CHECK(heap.allocations() == 0);
  const auto exact = release_at(make(), position, F, D.template cast<double>());
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK((u[i].template cast<double>() - exact[i]).norm() <=
          0.01 * double(test::ulps<S>(64)));  // 10 mm; input rounding
  }
  skeleton.share({.position = Vec3<S>(std::numeric_limits<S>::quiet_NaN(), S(0), S(0)), .force = F.cast<S>()},
                 load);
  release(skeleton, load, o, D, std::span<Vec3<S>>(u));
  for (const auto& v : u) CHECK(v == Vec3<S>(Vec3<S>::Zero()));
}
