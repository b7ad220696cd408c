// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/power_law.hpp>

#include <numbers>
#include <random>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE("power law: force and inverse against long double over many decades", S, float, double) {
  std::mt19937_64 random(1882);  // fixed seed
  std::uniform_real_distribution<double> decade(-8, 8), exponent(1, 4);
  for (int i = 0; i < 5000; ++i) {
    const S k = static_cast<S>(std::pow(10.0, decade(random))), p = static_cast<S>(exponent(random));
    const S x = static_cast<S>(std::pow(10.0, decade(random) / 2));
    const PowerLawForce<S> law({.k = k, .p = p});
    const long double a = k, b = p, y = x;
    CHECK_RELATIVE(law.force(x), a * std::pow(y, b), ulps<S>(4));
    CHECK_RELATIVE(law.depth(x), std::pow(y / a, 1 / b), ulps<S>(6));  // the Newton step's own roundings
  }
}

TEST_CASE_TEMPLATE("power law: p = 1 is the linear law", S, float, double) {
  const PowerLawForce<S> power({.k = S(300), .p = S(1)});
  const LinearForce<S> linear({.k = S(300)});
  for (const S d : {S(-1), S(0), S(1e-12), S(1e-3), S(2)}) {
    CHECK_RELATIVE(power.force(d), linear.force(d), ulps<S>(1));
    CHECK_RELATIVE(power.stiffness(d), linear.stiffness(d), ulps<S>(1));  // k, however small the depth
    CHECK_RELATIVE(power.energy(d), linear.energy(d), ulps<S>(2));
    CHECK_RELATIVE(power.depth(d), linear.depth(d), ulps<S>(2));
  }
}

TEST_CASE("power law: hertz sphere and cone") {
  // Rows of hertz_rigid_sphere_halfspace.csv are (4/3) E/(1-nu^2) sqrt(R) d^1.5; here a hand-checked one:
  // E = 9 kPa, nu = 1/2: E* = 12 kPa; R = 1 cm, d = 1 mm: 16000 * 0.1 * 1e-4.5 N.
  const auto sphere = PowerLawForce<double>::hertz_sphere(9000, 0.5, 0.01);
  CHECK_RELATIVE(sphere.force(0.001), 1600 * std::pow(10.0L, -4.5L), ulps<double>(8));
  // nu = 1/2: F = (16/9) E sqrt(R) d^1.5
  CHECK_RELATIVE(sphere.params().k, 16.0L / 9 * 9000 * std::sqrt(0.01L), ulps<double>(8));
  const auto cone = PowerLawForce<double>::cone(9000, 0.5, std::numbers::pi / 4);
  CHECK_RELATIVE(cone.force(0.001), 2 / std::numbers::pi_v<long double> * 12000 * 1e-6L, ulps<double>(8));
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("power and linear laws: bad parameters are refused by name and value") {
  using Power = PowerLawForce<double>;
  CHECK_THROWS_WITH_AS(Power({.k = 0, .p = 2}), "PowerLawForce: k [N/m^p] must be > 0 and finite, got 0",
                       SetupError);
  CHECK_THROWS_WITH_AS(Power({.k = 1, .p = 0.5}), "PowerLawForce: p [-] must be in [1, 10], got 0.5",
                       SetupError);
  CHECK_THROWS_AS(Power({.k = 1, .p = std::numeric_limits<double>::quiet_NaN()}), SetupError);
  CHECK_THROWS_WITH_AS(static_cast<void>(Power::hertz_sphere(1000, 0.6, 0.01)),
                       "PowerLawForce: Poisson's ratio [-] must be in (-1, 1/2], got 0.6", SetupError);
  CHECK_THROWS_AS(static_cast<void>(Power::hertz_sphere(-1, 0.5, 0.01)), SetupError);
  CHECK_THROWS_AS(static_cast<void>(Power::hertz_sphere(1000, 0.5, 0)), SetupError);
  CHECK_THROWS_AS(static_cast<void>(Power::cone(1000, 0.5, 1.6)), SetupError);
  CHECK_THROWS_WITH_AS(LinearForce<double>({.k = -2}), "LinearForce: k [N/m] must be > 0 and finite, got -2",
                       SetupError);
}
#endif
