// SPDX-License-Identifier: MIT
#include <palpate/elasticity/flat_punch.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace palpate;

// Bonded, normal: F = 4 mu a ln(3 - 4 nu)/(1 - 2 nu) u [spence1968]. Tangential: F = 8 mu a u/(2 - nu).
TEST_CASE("flat punch: compliances are Spence's and Mindlin's, with the limit 1/(8 a) at nu = 1/2") {
  for (const double a : {1e-3, 5e-3}) {
    CHECK_RELATIVE(flat_punch_compliance(a, 0).normal, 1 / (4 * a * std::log(3.0)), 1e-14);
    CHECK_RELATIVE(flat_punch_compliance(a, 0.3).normal, 0.4 / (4 * a * std::log(1.8)), 1e-14);
    CHECK_RELATIVE(flat_punch_compliance(a, 0.5).normal, 1 / (8 * a), 1e-14);
    // ln(1 + 2 b) = 2 b - 2 b^2 + ..: 1 + b of the limit
    CHECK_RELATIVE(flat_punch_compliance(a, 0.4995).normal, (1 + 1e-3) / (8 * a), 1e-6);
    for (const double nu : {0.0, 0.3, 0.5})
      CHECK_RELATIVE(flat_punch_compliance(a, nu).tangential, (2 - nu) / (8 * a), 1e-14);
  }
}
