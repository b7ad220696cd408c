// SPDX-License-Identifier: MIT
// expect: HasSkew
// expect-gcc: typename .*::Skew
// expect-clang: no type named 'Skew' in 'Rough'
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

struct Rough {
  using Scalar = double;
  using Slip = palpate::ReturnMapping;
#ifndef PALPATE_MUST_FAIL
  using Skew = palpate::ByComponents;
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
