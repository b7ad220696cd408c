// SPDX-License-Identifier: MIT
// expect: HasMaxCoefficient
// expect-clang: same_as
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

#ifdef PALPATE_MUST_FAIL
using Result = double;
#else
using Result = float;
#endif

struct Rough {
  using Scalar = float;
  using Skew = palpate::ByComponents;
  using Slip = palpate::ReturnMapping;
  static constexpr bool active = true;
  float static_limit(float normal_force) const noexcept { return normal_force; }
  float sliding_limit(float normal_force) const noexcept { return normal_force / 2; }
  Result max_coefficient() const noexcept { return 1; }
};

template <palpate::FrictionLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Rough>{}.law.static_limit(0) > 0; }
