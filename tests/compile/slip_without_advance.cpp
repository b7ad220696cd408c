// SPDX-License-Identifier: MIT
// expect: HasSlipAdvance
// expect-clang: no member named 'advance' in 'Glue'
#include <palpate/law/friction/skew.hpp>

/// Never slips.
struct Glue {
  static constexpr bool shifts_by_travel = false;
#ifndef PALPATE_MUST_FAIL
  template <class Friction, class Skew, class Law>
  static palpate::SlipResult<double> advance(const Friction&, const Skew& skew, const Law& law,
                                             const palpate::SlipTrial<double>& trial,
                                             palpate::SlipState<double>&) noexcept {
    return {trial.stretch, skew.force(law, trial.depth, trial.normal_force, trial.stretch)};
  }
#endif
};

struct Rough {
  using Scalar = double;
  using Skew = palpate::ByComponents;
  using Slip = Glue;
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
