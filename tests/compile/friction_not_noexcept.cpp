// SPDX-License-Identifier: MIT
// expect: HasStaticLimit
// expect-clang: may throw an exception
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

#ifdef PALPATE_MUST_FAIL
#define MAYBE_NOEXCEPT
#else
#define MAYBE_NOEXCEPT noexcept
#endif

struct Rough {
  using Scalar = double;
  using Skew = palpate::ByComponents;
  using Slip = palpate::ReturnMapping;
  static constexpr bool active = true;
  double static_limit(double normal_force) const MAYBE_NOEXCEPT { return normal_force; }
  double sliding_limit(double normal_force) const noexcept { return normal_force / 2; }
  double max_coefficient() const noexcept { return 1; }
};

template <palpate::FrictionLaw Law>
struct Solver {
  Law law;
};

int main() { return Solver<Rough>{}.law.static_limit(0) > 0; }
