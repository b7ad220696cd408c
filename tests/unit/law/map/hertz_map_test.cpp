// SPDX-License-Identifier: MIT

#include <palpate/geometry/sphere.hpp>
#include <palpate/law/map/hertz_map.hpp>
#include <palpate/solver/contact_solver.hpp>

#include "support/check.hpp"

#include <random>

namespace {

using namespace palpate;
using V = Vec3<double>;

HertzMap<double> uneven(double compliance = 1e-4) {
  return HertzMap<double>({.spacing = 0.01, .lower = V::Constant(-0.05), .upper = V::Constant(0.05)},
                          [=](const V& x) {
                            return HertzForce<double>::Params{.k = 1e5 * std::exp(10 * x.x()),
                                                              .compliance = compliance * (1 + 10 * x.z())};
                          });
}
V somewhere(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return V(coordinate(random), coordinate(random), coordinate(random));
}

TEST_CASE_TEMPLATE("a map of equal coefficients is the uniform law, beyond its box too", S, float, double) {
  const typename HertzForce<S>::Params same{.k = S(2e4), .compliance = S(3e-4)};
  const HertzMap<S> map(
      {.spacing = S(0.02), .lower = Vec3<S>::Constant(S(-0.05)), .upper = Vec3<S>::Constant(S(0.05))},
      [&](const Vec3<S>&) { return same; });
  std::mt19937 random(1);
  const S law = HertzForce<S>(same).force(S(0.003));
  for (int i = 0; i < 1000; ++i) {
    const auto there = map.at(somewhere(random, 0.08).template cast<S>());
    // 27 weights that add to 1, each rounded three times; k is p to the power -3/2.
    CHECK_RELATIVE(there.force(S(0.003)), law, test::ulps<S>(60));
  }
}

TEST_CASE("whatever the nodes have, every blend is a law") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-6, 6);
  const HertzMap<double> map(
      {.spacing = 0.01, .lower = V::Constant(-0.05), .upper = V::Constant(0.05)}, [&](const V&) {
        return HertzForce<double>::Params{.k = std::pow(10, exponent(random)),
                                          .compliance = std::pow(10, exponent(random))};
      });
  for (int i = 0; i < 10000; ++i) {
    const auto there = map.at(somewhere(random, i < 5000 ? 0.05 : 1e6));
    CHECK(there.params().k > 0);
    CHECK(there.params().compliance > 0);
    CHECK(is_finite(there.configurational_force(0.01)));
  }
}

TEST_CASE("the configurational force is minus the energy's derivative with the position") {
  for (const double compliance : {1e-4, -1e-4}) {  // the latter: most beyond the end of the series
    const HertzMap<double> map = uneven(compliance);
    std::mt19937 random(3);
    for (int i = 1; i <= 300; ++i) {
      const V x = somewhere(random, 0.05);
      const double depth = 0.01 * i / 300, h = 1e-6;
      V slope;
      for (int k = 0; k < 3; ++k)
        slope[k] =
            (map.at(x + h * V::Unit(k)).energy(depth) - map.at(x - h * V::Unit(k)).energy(depth)) / (2 * h);
      // The difference's own error h^2 U''', and rounding eps U / h.
      CHECK((map.at(x).configurational_force(depth) + slope).norm() <=
            1e-8 * slope.norm() + 1e-9 * map.at(x).energy(depth) / h);
    }
  }
}

TEST_CASE("a frictionless ball on an uneven object gains and loses no energy on a closed path") {
  for (const double compliance : {1e-4, -1e-4}) {
    ContactSolver<Sphere<double>, HertzMap<double>> solver(
        {Sphere<double>({.radius = 0.05}), {}, uneven(compliance), {}, {}});
    const int steps = 20000;
    const auto position = [&](double s) {
      const double angle = 2 * 3.14159265358979323846 * s / steps;
      return V(0.02 * std::cos(angle), 0.041 + 0.003 * std::sin(3 * angle), 0.02 * std::sin(angle));
    };
    double work = 0, moved = 0;
    for (int i = 0; i < steps; ++i) {
      const V felt = solver.tick({Mat3<double>::Identity(), position(i + 0.5)}).wrench.force;
      const double dW = felt.dot(position(i + 1) - position(i));
      work += dW;
      moved += std::abs(dW);
    }
    REQUIRE(moved > 0);
    CHECK(std::abs(work) < 1e-6 * moved);  // the midpoint rule's error, falls with steps^2
  }
}

TEST_CASE("bad nodes are refused") {
  const auto make = [](const HertzForce<double>::Params& node) {
    return HertzMap<double>({.spacing = 0.1, .lower = V::Zero(), .upper = V::Ones()},
                            [&](const V&) { return node; });
  };
  CHECK_THROWS_AS(make({.k = 0}), SetupError);
  CHECK_THROWS_AS(make({.k = 1, .compliance = -std::numeric_limits<double>::infinity()}), SetupError);
  // Below 0 D would end at 0.09/(C k)^2, less than the smallest number; above, C k sqrt(D) is infinite.
  for (const double C : {-1e154, 1e154})
    CHECK_THROWS_AS(HertzForce<double>({.k = 1, .compliance = C}), SetupError);
  CHECK_THROWS_AS(HertzForce<float>({.k = 1e-10f, .compliance = -2e38f}), SetupError);
  CHECK_THROWS_AS(HertzForce<float>({.k = 6.8e22f, .compliance = 3e38f}), SetupError);
  const HertzForce<float> soft({.k = 1e-10f, .compliance = 1e28f});
  for (const float D : {1e-3f, 1.f, 1e6f}) CHECK_RELATIVE(soft.force(D), D / 1e28f, 1e-6);
  constexpr float infinite = std::numeric_limits<float>::infinity();
  CHECK(soft.force(infinite) == infinite);
  CHECK(HertzForce<float>({.k = 6e-39f, .compliance = 2e31f}).force(infinite) == infinite);
  const HertzForce<float> steep({.k = 1e-10f, .compliance = -1e28f});  // at 9e-38
  for (const float D : {1e-18f, 1.f, 1e24f}) {
    const float right = 2.0556f * 1e-10f * D * std::sqrt(D);  // v^3 where v^2 - 0.3 v^3 = 1, five digits
    CHECK_RELATIVE(steep.force(D), right, 1e-4);
    CHECK_RELATIVE(steep.depth(right), D, 1e-4);
  }
  CHECK_THROWS_AS(make({.k = 1, .compliance = std::nan("")}), SetupError);
}

}  // namespace
