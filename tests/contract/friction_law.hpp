// SPDX-License-Identifier: MIT
#pragma once

/// @file  What every friction law must keep (law/friction/concept.hpp), run on an example of each policy.

#include "support/check.hpp"

#include <palpate/law/friction/concept.hpp>

#include <cmath>
#include <limits>

namespace palpate::test {

/// `linear_below`: normal force [N] below which f_max is linear, where the law changes formula; 0 if nowhere.
template <FrictionLaw F>
void check_friction_law(const F& law, typename F::Scalar linear_below) {
  using S = typename F::Scalar;
  const S epsilon = std::numeric_limits<S>::epsilon();
  static_assert(F::active);

  // No normal force, or none that makes sense: no friction.
  const S infinity = std::numeric_limits<S>::infinity(), nan = std::numeric_limits<S>::quiet_NaN();
  for (const S none : {S(0), -S(0), S(-1e-12), S(-5), -infinity, nan}) {
    CHECK(law.static_limit(none) == S(0));
    CHECK(law.sliding_limit(none) == S(0));
  }
  CHECK(law.static_limit(std::numeric_limits<S>::min()) < S(1e-6));  // friction begins without a step

  // Normal forces over 24 decades: ordered, finite, non-decreasing (to rounding), bounded by the coefficient.
  S static_before = S(0), sliding_before = S(0);
  for (int i = 0; i <= 2400; ++i) {
    const S normal = std::pow(S(10), S(i - 1200) / S(100));
    const S most = law.static_limit(normal), sliding = law.sliding_limit(normal);
    const bool good = is_finite(most) && sliding > S(0) && sliding <= most &&
                      most >= static_before * (S(1) - S(4) * epsilon) &&
                      sliding >= sliding_before * (S(1) - S(4) * epsilon) &&
                      (!is_finite(law.max_coefficient()) ||
                       most <= law.max_coefficient() * normal * (S(1) + S(8) * epsilon));
    INFO("normal force ", normal, " static ", most, " sliding ", sliding);
    CHECK(good);
    static_before = most;
    sliding_before = sliding;
  }

  // Continuous where the formula changes, and the stated coefficient is the least upper bound.
  if (linear_below > S(0)) {
    CHECK_RELATIVE(law.static_limit(linear_below * (S(1) - epsilon)), law.static_limit(linear_below),
                   ulps<S>(8));
    CHECK_RELATIVE(law.static_limit(linear_below / S(2)) / (linear_below / S(2)), law.max_coefficient(),
                   ulps<S>(8));
  }
}

}  // namespace palpate::test
