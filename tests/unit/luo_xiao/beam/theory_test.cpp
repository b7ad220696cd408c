// SPDX-License-Identifier: MIT
// The cantilever: tip, whole line and stresses against the closed form, and the figures of short beams.
#include <palpate/luo_xiao/beam/euler_bernoulli.hpp>
#include <palpate/luo_xiao/beam/rectangular_section.hpp>
#include <palpate/luo_xiao/beam/section.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

using L = long double;
constexpr L pi = std::numbers::pi_v<L>;

// A rubber cantilever: decimal parameters, so that double and long double differ in the last place of each.
constexpr double E = 1.7e6, nu = 0.5, radius = 0.0037, length = 0.0811, F = 0.43;

IsotropicElasticity<double> rubber(double poisson = nu) {
  return IsotropicElasticity<double>({.E = E, .nu = poisson});
}

}  // namespace

TEST_CASE("cantilever: tip, whole line and stresses are the closed form to 1e-12") {
  const EulerBernoulli<double> beam(rubber());
  const CircularSection<double> circle({.radius = radius});
  const L r = radius, l = length, I = pi * r * r * r * r / 4, area = pi * r * r;
  CHECK_RELATIVE(F / beam.transverse_stiffness(circle, length), F * l * l * l / (3 * L(E) * I), 1e-12);
  CHECK_RELATIVE(beam.axial_stiffness(circle, length), E * area / l, 1e-12);
  for (int i = 1; i <= 100; ++i) {
    const double at = length * i / 100;
    const L x = at;
    CHECK_RELATIVE(beam.deflection(circle, length, F, at), F / (E * I) * (l * x * x / 2 - x * x * x / 6),
                   1e-12);
    for (const double v : {-0.9, -0.2, 0.0, 0.6}) {
      const double y = v * radius, z = 0.35 * radius;
      const auto s = beam_stress(circle, nu, BeamLoad<double>{-0.2, F}, length - at, y, z);
      // Bending and axial part may cancel: the tolerance is of their sizes.
      CHECK_ABSOLUTE(s[0], -F * (l - x) * y / I - 0.2L / area, 1e-12L * (F * l * r / I + 0.2L / area));
      // nu = 1/2: tau_yx = F/(3I) (r^2 - y^2), tau_zx = -F y z/(3I)
      CHECK_RELATIVE(s[5], F / (3 * I) * (r * r - L(y) * y), 1e-12);
      CHECK_RELATIVE(s[4], -F * L(y) * z / (3 * I), 1e-12);
    }
  }
}

TEST_CASE("axial over bending stiffness of a circle is (4/3)(l/r)^2") {
  // Rows: l/r, ratio (4/3 times a square, exact to the digits here).
  constexpr double table[][2] = {
      {1, 4.0 / 3}, {5, 100.0 / 3}, {10, 400.0 / 3}, {20, 1600.0 / 3}, {100, 40000.0 / 3}};
  const EulerBernoulli<double> beam(rubber());
  for (const auto& row : table) {
    const CircularSection<double> circle({.radius = 0.01});
    const double l = row[0] * 0.01;
    CHECK_RELATIVE(beam.axial_stiffness(circle, l) / beam.transverse_stiffness(circle, l), row[1], 1e-14);
  }
}

TEST_CASE("Timoshenko's default kappa is energy-exact for the end-loaded circle: table and section") {
  // 6 (1+nu)^2/(7+14nu+8nu^2) by Castigliano on the exact flexure stresses, to the third decimal.
  constexpr double table[][2] = {{0, 0.857}, {0.3, 0.851}, {0.5, 0.844}};
  for (const auto& row : table) {
    const Timoshenko<double> beam(rubber(row[0]));
    CHECK_ABSOLUTE(beam.kappa(), row[1], 0.0005);  // the table's rounding
    CHECK_RELATIVE(beam.kappa(), CircularSection<double>({.radius = 0.003}).shear_coefficient(row[0]), 1e-14);
  }
}

TEST_CASE("short beams: what shear adds to the tip's compliance, nu = 1/2") {
  // Rows: l/r, added compliance over bending [%]: 3.56 (r/l)^2 / (4/3), from kappa = 27/32.
  constexpr double table[][2] = {{1, 267}, {5, 11}, {20, 0.7}};
  const EulerBernoulli<double> slender(rubber());
  const Timoshenko<double> short_beam(rubber());
  const CircularSection<double> circle({.radius = 0.01});
  for (const auto& row : table) {
    const double l = row[0] * 0.01;
    const double added =
        slender.transverse_stiffness(circle, l) / short_beam.transverse_stiffness(circle, l) - 1;
    CHECK_ABSOLUTE(added * 100, row[1], 0.5);  // the table's rounding
  }
}

TEST_CASE("Timoshenko: tip work with a section's own kappa is the energy of the exact stresses") {
  // Castigliano: F y/2 = l F^2 int tau^2/(2G) + F^2 l^3/(6EI); 1/kappa is S times the integral by the
  // section's test.
  const RectangularSection<double> box({.half_y = 0.003, .half_z = 0.005});
  const Timoshenko<double> beam(rubber(0.3), box.shear_coefficient(0.3));
  const double l = 0.02, G = rubber(0.3).shear_modulus();
  const L bending = L(l) * l * l / (3 * L(E) * box.second_moment_z());
  const L shear = l / (static_cast<L>(box.shear_coefficient(0.3)) * G * box.area());
  CHECK_RELATIVE(1 / beam.transverse_stiffness(box, l), bending + shear, 1e-14);
  CHECK_THROWS_AS(Timoshenko<double>(rubber(), 0.0), SetupError);
  CHECK_THROWS_AS(Timoshenko<double>(rubber(), 1.5), SetupError);
}

TEST_CASE("limit of the linear beam: how far the elastica's tip is from it") {
  // Rows: F l^2/(E I), tip deflection over l of the elastica (elliptic integrals, 10 digits).
  constexpr double table[][2] = {
      {0.25, 0.0827459154}, {0.5, 0.1621435757}, {1, 0.3017207738}, {2, 0.4934574804}};
  constexpr double error[] = {0.7, 2.8, 10.5, 35};
  const EulerBernoulli<double> beam(rubber());
  const CircularSection<double> circle({.radius = radius});
  for (int i = 0; i < 4; ++i) {
    const double force = table[i][0] * E * circle.second_moment_z() / (length * length);
    const double linear = beam.deflection(circle, length, force, length) / length;
    CHECK_ABSOLUTE(100 * (linear / table[i][1] - 1), error[i],
                   i == 3 ? 0.5 : 0.06);  // the stated figures' rounding
  }
}
