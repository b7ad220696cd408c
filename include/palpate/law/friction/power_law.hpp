// SPDX-License-Identifier: MIT
#pragma once

/// @file  Power-law friction of Howell and Mazur: the paper's friction limit.

#include <palpate/core/error.hpp>
#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// Friction limit that grows more slowly than the normal force, as the contact area of an elastic body does
/// (IV.B).
///
///     f_max = K F_n^beta                     F_n >= F_0
///     f_max = K F_0^(beta-1) F_n             F_n <  F_0   (no equation: own choice)
///     sliding: min(mu_D F_n, f_max)
///
/// | symbol | name           | unit       | range                                                |
/// |--------|----------------|------------|------------------------------------------------------|
/// | K      | `K`            | N^(1-beta) | > 0                                                  |
/// | beta   | `beta`         | -          | [2/3, 1]: 2/3 one elastic junction, 1 Coulomb        |
/// | mu_D   | `mu_dynamic`   | -          | > 0                                                  |
/// | F_0    | `linear_below` | N          | >= 0, default 0.01 (chosen); 0: the law as printed   |
/// | F_n    | argument       | N          | any; F_n <= 0 and NaN give 0                         |
///
/// The power law has infinite slope at F_n = 0, so that a light touch would stick at any sideways force; the
/// chord below F_0 keeps f_max / F_n, and with it the change of force per tick, bounded by
/// `max_coefficient()`. The two limits meet at F_n = (K/mu_D)^(1/(1-beta)): below it sliding friction is mu_D
/// F_n, above it f_max. K depends on the unit of force: convert with `si_coefficient`. beta = 1 is
/// CoulombFriction with mu_S = K, to the bit. Bad parameters: SetupError. Does not model: dependence on
/// speed, waiting time or apparent area. Source: [luo2005] IV.B; [howell1953].
///
/// @tparam Slip_  slip rule, @tparam Skew_  skew rule: see law/friction/concept.hpp.
template <Real S, class Slip_ = ReturnMapping, class Skew_ = ByComponents>
class PowerLawFriction {
 public:
  using Scalar = S;
  using Slip = Slip_;
  using Skew = Skew_;
  static constexpr bool active = true;

  struct Params {
    S K;                                     ///< [N^(1-beta)] > 0
    S beta;                                  ///< [-] in [2/3, 1]
    S mu_dynamic;                            ///< [-] > 0
    S linear_below = S(0.01);                ///< F_0 [N] >= 0
    PALPATE_NO_UNIQUE_ADDRESS Skew_ skew{};  ///< parameters of the skew rule, where it has any
  };

  explicit PowerLawFriction(const Params& params) : p_(params) {
    require_positive(p_.K, "PowerLawFriction", "K [N^(1-beta)] must be > 0 and finite");
    // 2/3 has no exact value: a caller's 2/3, rounded differently from this one, is still 2/3.
    const S lowest = S(2) / S(3) - S(4) * std::numeric_limits<S>::epsilon();
    if (!is_finite(p_.beta) || !(p_.beta >= lowest && p_.beta <= S(1))) {
      fail("PowerLawFriction", "beta [-] must be in [2/3, 1]", static_cast<double>(p_.beta));
    }
    require_positive(p_.mu_dynamic, "PowerLawFriction", "mu_dynamic [-] must be > 0 and finite");
    require_non_negative(p_.linear_below, "PowerLawFriction", "linear_below [N] must be >= 0 and finite");
    if (p_.beta == S(1)) {
      max_coefficient_ = p_.K;
    } else if (p_.linear_below > S(0)) {
      max_coefficient_ = p_.K * std::pow(p_.linear_below, p_.beta - S(1));
    } else {
      max_coefficient_ = std::numeric_limits<S>::infinity();
    }
    // A little lower than where the limits meet, so that below it mu_D F_n is the smaller one in spite of
    // rounding. Below F_0 they are proportional.
    constexpr S guard = S(1) - S(32) * std::numeric_limits<S>::epsilon();
    const S ratio = p_.K / p_.mu_dynamic * guard;
    if (p_.beta < S(1)) {
      meet_ = std::pow(ratio, S(1) / (S(1) - p_.beta));
      if (!(meet_ > p_.linear_below)) meet_ = S(0);
    }
  }

  /// K in N^(1-beta) from a value given with forces in another unit: K_SI = K_u u^(1-beta), u = `unit` [N].
  /// The paper's K = 10 at beta = 0.75 in dyn (1e-5 N) is 0.562 N^0.25.
  [[nodiscard]] static S si_coefficient(S K, S beta, S unit) {
    require_positive(unit, "PowerLawFriction", "unit of force [N] must be > 0 and finite");
    return K * std::pow(unit, S(1) - beta);
  }

  /// f_max [N] at the normal force F_n [N].
  [[nodiscard]] S static_limit(S normal_force) const noexcept {
    if (!is_positive(normal_force)) return S(0);
    if (p_.beta == S(1)) return p_.K * normal_force;
    if (normal_force < p_.linear_below) return max_coefficient_ * normal_force;
    if (p_.beta == S(0.75)) {  // the paper's; half the time of a power
      const S root = std::sqrt(normal_force);
      return p_.K * (root * std::sqrt(root));
    }
    return p_.K * std::pow(normal_force, p_.beta);
  }
  /// Friction while sliding [N] at the normal force F_n [N]: min(mu_D F_n, f_max).
  [[nodiscard]] S sliding_limit(S normal_force) const noexcept {
    if (!is_positive(normal_force)) return S(0);
    const S dynamic = p_.mu_dynamic * normal_force;
    return normal_force < meet_ ? dynamic : (std::min)(dynamic, static_limit(normal_force));
  }
  /// sup f_max / F_n [-] = K F_0^(beta-1). Infinite for the printed power law (F_0 = 0, beta < 1).
  [[nodiscard]] S max_coefficient() const noexcept { return max_coefficient_; }
  [[nodiscard]] constexpr const Skew& skew() const noexcept { return p_.skew; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  Params p_;
  S max_coefficient_;
  S meet_ = S(0);  // below it [N] sliding friction is mu_D F_n
};

static_assert(FrictionLaw<PowerLawFriction<float>> && FrictionLaw<PowerLawFriction<double>>);

}  // namespace palpate
