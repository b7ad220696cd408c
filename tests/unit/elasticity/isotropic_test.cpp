// SPDX-License-Identifier: MIT
#include <palpate/elasticity/isotropic.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <cmath>
#include <random>
#include <string>

using namespace palpate;

namespace {

std::string message_of(const IsotropicElasticity<double>::Params& params) {
  try {
    [[maybe_unused]] const IsotropicElasticity<double> material(params);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE_TEMPLATE("compliance inverts Hooke's law with Lame's constants, below nu = 1/2", S, float, double) {
  std::mt19937_64 random(20050608);
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double nu : {0.0, 0.3, 0.45}) {
    const IsotropicElasticity<S> material({.E = S(2e6), .nu = S(nu)});
    const long double E = material.params().E, n = material.params().nu;
    const long double G = E / (2 * (1 + n)), lambda = E * n / ((1 + n) * (1 - 2 * n));
    CHECK_RELATIVE(material.shear_modulus(), G, test::ulps<S>(2));
    Voigt<S> stress;
    for (S& s : stress) s = S(1e4 * u(random));
    const Voigt<S> e = material.strain(stress);
    const long double trace = static_cast<long double>(e[0]) + e[1] + e[2];
    for (std::size_t i = 0; i < 6; ++i) {
      const long double back = i < 3 ? lambda * trace + 2 * G * e[i] : G * e[i];
      // The trace loses digits by 1/(1 - 2 nu) = 10 at most; a dozen roundings.
      CHECK_ABSOLUTE(back, stress[i], 1e4L * test::ulps<S>(100));
    }
  }
}

TEST_CASE("nu = 1/2: strain is finite, keeps the volume, and pressure gives none") {
  const IsotropicElasticity<double> rubber({.E = 1e6, .nu = 0.5});
  const Voigt<double> e = rubber.strain({3e3, -1e3, 500, 200, -300, 100});
  CHECK_ABSOLUTE(e[0] + e[1] + e[2], 0, 1e-17);  // strains of 1e-3, a few roundings
  CHECK_RELATIVE(e[0], (3e3 + 250) / 1e6, test::ulps<double>(4));
  CHECK_RELATIVE(e[5], 100 * 3 / 1e6, test::ulps<double>(4));
  for (const double x : rubber.strain({700, 700, 700, 0, 0, 0})) CHECK(x == 0);
}

TEST_CASE("set-up: a parameter out of its range is reported with its name and value") {
  CHECK(message_of({.E = 0}) == "IsotropicElasticity: E [Pa] must be > 0, got 0");
  CHECK(message_of({.nu = 0.6}) == "IsotropicElasticity: nu must be from 0 to 1/2, got 0.6");
  CHECK(message_of({.nu = -0.1}) == "IsotropicElasticity: nu must be from 0 to 1/2, got -0.1");
  CHECK(message_of({.nu = std::nan("")}) != "");
  CHECK(message_of({.rho = -1}) == "IsotropicElasticity: rho [kg/m^3] must be > 0, got -1");
  CHECK(message_of({}) == "");
}
