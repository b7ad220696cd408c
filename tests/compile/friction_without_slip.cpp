// SPDX-License-Identifier: MIT
// expect: HasSlip
// expect-gcc: typename .*::Slip
// expect-clang: no type named 'Slip' in 'Rough'
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

struct Rough {
  using Scalar = double;
  using Skew = palpate::ByComponents;
#ifndef PALPATE_MUST_FAIL
  using Slip = palpate::ReturnMapping;
#endif
  static constexpr bool active = true;
  double static_limit(double normal_force) const noexcept { return normal_force; }
  double sliding_limit(double normal_force) const noexcept { return normal_force / 2; }
  double max_coefficient() const noexcept { return 1; }
};

template <palpate::FrictionLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Rough>{}.law.static_limit(0) > 0; }
