// SPDX-License-Identifier: MIT
// expect: HasSkewEnergy
// expect-clang: no member named 'energy' in 'Sideways'
#include <palpate/law/friction/slip.hpp>

/// The law's own force, whatever the depth.
struct Sideways {
  template <class Law>
  static palpate::SkewedForce<double> force(const Law& law, double, double normal_force,
                                            double stretch) noexcept {
    return {normal_force, law.force(stretch)};
  }
  template <class Law>
  static double stretch(const Law& law, double, double f) noexcept {
    return law.depth(f);
  }
  template <class Law, class Limit>
  static double admissible(const Law& law, double, double normal_force, double trial,
                           const Limit& limit) noexcept {
    const double most = law.depth(limit(normal_force));
    return trial < most ? trial : most;
  }
#ifndef PALPATE_MUST_FAIL
  template <class Law>
  static double energy(const Law& law, double, double stretch) noexcept {
    return law.energy(stretch);
  }
#endif
};

struct Rough {
  using Scalar = double;
  using Skew = Sideways;
  using Slip = palpate::ReturnMapping;
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
