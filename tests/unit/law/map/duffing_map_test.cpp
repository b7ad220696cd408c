// SPDX-License-Identifier: MIT

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/law/map/duffing_map.hpp>
#include <palpate/solver/contact_solver.hpp>

#include "support/check.hpp"
#include "support/meshes.hpp"
#include "support/no_heap.hpp"

#include <random>

namespace {

using namespace palpate;

template <class S>
DuffingMap<S> uneven() {
  return DuffingMap<S>({.spacing = S(0.01),
                        .lower = Vec3<S>(S(-0.06), S(-0.04), S(-0.05)),
                        .upper = Vec3<S>(S(0.06), S(0.04), S(0.05))},
                       [](const Vec3<S>& x) {
                         const S s = S(30) * x.x() + S(20) * x.y();
                         return typename DuffingForce<S>::Params{.c1 = S(200) * std::exp(s),
                                                                 .c3 = S(1e6) * std::sin(S(50) * x.z())};
                       });
}
template <class S>
Vec3<S> somewhere(std::mt19937& random, S size) {
  std::uniform_real_distribution<S> coordinate(-size, size);
  return Vec3<S>(coordinate(random), coordinate(random), coordinate(random));
}

TEST_CASE_TEMPLATE("a map of equal coefficients is the uniform law", S, float, double) {
  const typename DuffingForce<S>::Params same{.c1 = S(40), .c3 = S(-3e5)};
  const DuffingForce<S> law(same);
  const DuffingMap<S> map(
      {.spacing = S(0.02), .lower = Vec3<S>::Constant(S(-0.05)), .upper = Vec3<S>::Constant(S(0.05))},
      [&](const Vec3<S>&) { return same; });
  CHECK(map.max_depth() == law.max_depth());
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto there = map.at(somewhere(random, S(0.08)));
    // 27 weights that add to 1, each rounded three times.
    const S rounding = S(30) * std::numeric_limits<S>::epsilon();
    CHECK(std::abs(there.params().c1 - same.c1) <= rounding * same.c1);
    CHECK(std::abs(there.params().c3 - same.c3) <= rounding * -same.c3);
    CHECK(there.configurational_force(S(0.002)).norm() <= S(10) * rounding * law.energy(S(0.002)) / S(0.02));
  }
}

TEST_CASE("coefficients: linear fields are met exactly, smooth ones to third order") {
  const Vec3<double> low(-0.05, -0.03, -0.04), high(0.05, 0.03, 0.04);
  double before = 0;
  for (const double w : {0.008, 0.004, 0.002}) {
    const DuffingMap<double> map({.spacing = w, .lower = low, .upper = high}, [](const Vec3<double>& x) {
      return DuffingForce<double>::Params{.c1 = 100 + 500 * x.x() - 300 * x.y() + 200 * x.z(),
                                          .c3 = 1e6 * (2 + std::cos(40 * x.x()))};
    });
    std::mt19937 random(2);
    double worst = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3<double> x = somewhere(random, 0.4).cwiseProduct(high - low);
      const auto there = map.at(x).params();
      CHECK_RELATIVE(there.c1, 100 + 500 * x.x() - 300 * x.y() + 200 * x.z(), 1e-14);  // weights rounded
      worst = (std::max)(worst, std::abs(there.c3 - 1e6 * (2 + std::cos(40 * x.x()))));
    }
    if (before > 0) CHECK(before / worst > 7);  // 8 in the limit
    before = worst;
  }
}

TEST_CASE("whatever the nodes have, every blend is a law, and none folds earlier than max_depth()") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-8, 8), sign(-1, 1);
  const DuffingMap<double> map(
      {.spacing = 0.01, .lower = Vec3<double>::Constant(-0.05), .upper = Vec3<double>::Constant(0.05)},
      [&](const Vec3<double>&) {
        return DuffingForce<double>::Params{
            .c1 = std::pow(10, exponent(random)),
            .c3 = std::copysign(std::pow(10, exponent(random)), sign(random))};
      });
  for (int i = 0; i < 10000; ++i) {
    const auto there = map.at(somewhere(random, i < 5000 ? 0.05 : 1e6));  // far outside too
    CHECK(there.params().c1 > 0);
    CHECK(there.max_depth() >= map.max_depth() * (1 - 1e-14));
    CHECK(is_finite(there.configurational_force(0.01)));
  }
}

TEST_CASE(
    "the configurational force is minus the energy's derivative with the position, softening and beyond the "
    "fold included") {
  const DuffingMap<double> map(
      {.spacing = 0.01, .lower = Vec3<double>::Constant(-0.04), .upper = Vec3<double>::Constant(0.04)},
      [](const Vec3<double>& x) {
        return DuffingForce<double>::Params{.c1 = 100 + 1000 * x.x(), .c3 = -1e6 * (1 + 10 * x.z())};
      });
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3<double> x = somewhere(random, 0.04);
    const double depth = 0.012 * double(i) / 300;  // the fold is at about 6 mm
    const double h = 1e-6;
    Vec3<double> slope;
    for (int k = 0; k < 3; ++k)
      slope[k] = (map.at(x + h * Vec3<double>::Unit(k)).energy(depth) -
                  map.at(x - h * Vec3<double>::Unit(k)).energy(depth)) /
                 (2 * h);
    // Rounding of the difference: eps U / h.
    CHECK((map.at(x).configurational_force(depth) + slope).norm() <=
          1e-8 * slope.norm() + 1e-9 * map.at(x).energy(depth) / h);
  }
}

// Work of the wrench along a closed path of small steps, by the midpoint rule, over the energy that goes in
// and out.
template <class Solver>
double gain(Solver& solver, bool turn) {
  const int steps = 20000;
  const auto pose = [&](double s) {
    const double angle = 2 * 3.14159265358979323846 * s / steps;
    const Vec3<double> x(0.02 * std::cos(angle), 0.038 + 0.0025 * std::sin(3 * angle),
                         0.015 * std::sin(angle));
    Pose<double> X{Mat3<double>::Identity(), x};
    if (turn) X.rotation = Eigen::AngleAxisd(0.2 * std::sin(angle), Vec3<double>::UnitZ()).toRotationMatrix();
    return X;
  };
  double work = 0, moved = 0;
  for (int i = 0; i < steps; ++i) {
    const Pose<double> a = pose(i), b = pose(i + 1), middle = pose(i + 0.5);
    const auto felt = solver.tick(middle).wrench;
    const Eigen::AngleAxisd turned(Mat3<double>(b.rotation * a.rotation.transpose()));
    const double dW =
        felt.force.dot(b.translation - a.translation) + turned.angle() * felt.torque.dot(turned.axis());
    work += dW;
    moved += std::abs(dW);
  }
  REQUIRE(moved > 0);
  return work / moved;
}

TEST_CASE("frictionless contact on an uneven object gains and loses no energy on a closed path") {
  const Ellipsoid<double> object({.axes = Vec3<double>(0.06, 0.04, 0.05)});
  SUBCASE("point") {
    ContactSolver<Ellipsoid<double>, DuffingMap<double>> solver({object, {}, uneven<double>(), {}, {}});
    CHECK(std::abs(gain(solver, false)) < 1e-6);  // the midpoint rule's, falls with steps^2
  }
  SUBCASE("region") {
    const ToolPoints<double> ball(TriangleMesh<double>(Sphere<double>({.radius = 0.01}).mesh(300)),
                                  {.contact_area = 1e-4}, 1e-3);
    ContactSolver<Ellipsoid<double>, DuffingMap<double>, Frictionless<double>, SingleRegion<AreaSharing>>
        solver({object, ball, uneven<double>(), {}, {}});
    CHECK(std::abs(gain(solver, true)) < 1e-5);  // points come in and leave between steps
  }
}

TEST_CASE(
    "forces and torques follow the position without a click, with friction and regions, and without heap") {
  const Ellipsoid<double> object({.axes = Vec3<double>(0.06, 0.04, 0.05)});
  const ToolPoints<double> ball(TriangleMesh<double>(Sphere<double>({.radius = 0.01}).mesh(300)),
                                {.contact_area = 1e-4}, 1e-3);
  ContactSolver<Ellipsoid<double>, DuffingMap<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>
      solver({object,
              ball,
              uneven<double>(),
              PowerLawFriction<double>({.K = 0.5, .beta = 0.75, .mu_dynamic = 0.3}),
              {2.5e-3}});
  Vec3<double> before = Vec3<double>::Zero();
  double worst = 0, largest = 0;
  const test::HeapCount heap;
  for (int i = 0; i < 40000; ++i) {
    const double s = 1e-6 * i;
    const auto felt = solver.tick(
        Pose<double>{Mat3<double>::Identity(), Vec3<double>(-0.02 + s, 0.046 - 0.1 * s, 0.3 * s)});
    if (i > 0) worst = (std::max)(worst, (felt.wrench.force - before).norm());
    largest = (std::max)(largest, felt.wrench.force.norm());
    before = felt.wrench.force;
  }
  CHECK(heap.allocations() == 0);
  CHECK(largest > 0.1);
  // A stiffness of at most 200 e^2.6 + 3e6 * 0.008^2 N/m in the normal and the tangential direction, steps of
  // 1.05 um.
  CHECK(worst < 2 * (200 * std::exp(2.6) + 3e6 * 64e-6) * 1.05e-6);
}

TEST_CASE("bad maps are refused") {
  const auto fine = [](const Vec3<double>&) { return DuffingForce<double>::Params{.c1 = 1}; };
  const Vec3<double> low = Vec3<double>::Zero(), high = Vec3<double>::Ones();
  CHECK_THROWS_AS(DuffingMap<double>({.spacing = 0, .lower = low, .upper = high}, fine), SetupError);
  CHECK_THROWS_AS(DuffingMap<double>({.spacing = 1e-3, .lower = low, .upper = high}, fine), SetupError);
  CHECK_THROWS_AS(DuffingMap<double>({.spacing = 0.1, .lower = high, .upper = low}, fine), SetupError);
  CHECK_THROWS_AS(
      DuffingMap<double>({.spacing = 0.1, .lower = low, .upper = Vec3<double>(1, 1, std::nan(""))}, fine),
      SetupError);
  CHECK_THROWS_AS(DuffingMap<double>({.spacing = 0.1, .lower = low, .upper = high},
                                     [](const Vec3<double>& x) {
                                       return DuffingForce<double>::Params{.c1 = x.x() < 0.5 ? 1.0 : -1.0};
                                     }),
                  SetupError);
}

}  // namespace
