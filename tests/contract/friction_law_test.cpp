// SPDX-License-Identifier: MIT
// The friction law suite on every shipped law, float and double.

#include "contract/friction_law.hpp"

#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/law/friction/power_law.hpp>

#include <type_traits>

using namespace palpate;

TEST_CASE_TEMPLATE("friction laws: limits ordered, rising, continuous and bounded", S, float, double) {
  for (const S beta : {S(2) / S(3), S(0.75), S(0.9), S(1)}) {
    for (const S linear_below : {S(0), S(0.01), S(1)}) {
      const PowerLawFriction<S> law(
          {.K = S(0.562), .beta = beta, .mu_dynamic = S(0.4), .linear_below = linear_below});
      INFO("beta ", beta, " linear_below ", linear_below);
      test::check_friction_law(law, linear_below);
    }
  }
  test::check_friction_law(CoulombFriction<S>({.mu_static = S(0.6), .mu_dynamic = S(0.4)}), S(0));
  test::check_friction_law(CoulombFriction<S, LiteralShift, Radial>({.mu_static = S(2), .mu_dynamic = S(2)}),
                           S(0));
}

TEST_CASE_TEMPLATE("no friction: absent and empty", S, float, double) {
  static_assert(!Frictionless<S>::active && std::is_empty_v<Frictionless<S>>);
  static_assert(std::is_same_v<typename Frictionless<S>::Scalar, S>);
  static_assert(std::is_same_v<typename PowerLawFriction<S>::Slip, ReturnMapping>);
  static_assert(std::is_same_v<typename PowerLawFriction<S>::Skew, ByComponents>);
  static_assert(std::is_same_v<typename PowerLawFriction<S, LiteralShift, Radial>::Slip, LiteralShift>);
  CHECK(std::is_trivially_copyable_v<PowerLawFriction<S>>);
}
