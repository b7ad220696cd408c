// SPDX-License-Identifier: MIT
// expect: HasSlidingLimit
// expect-clang: no member named 'sliding_limit' in 'Rough'
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

struct Rough {
  using Scalar = double;
  using Skew = palpate::ByComponents;
  using Slip = palpate::ReturnMapping;
  static constexpr bool active = true;
  double static_limit(double normal_force) const noexcept { return normal_force; }
#ifndef PALPATE_MUST_FAIL
  double sliding_limit(double normal_force) const noexcept { return normal_force / 2; }
#endif
  double max_coefficient() const noexcept { return 1; }
};

template <palpate::FrictionLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Rough>{}.law.static_limit(0) > 0; }
