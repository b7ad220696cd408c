// SPDX-License-Identifier: MIT
#pragma once

/// @file  Coulomb friction: the limit is proportional to the normal force.

#include <palpate/core/error.hpp>
#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/friction/slip.hpp>

namespace palpate {

/// Amontons-Coulomb friction, the case beta = 1 of IV.B.
///
///     f_max = mu_S F_n,   sliding: mu_D F_n
///
/// | symbol | name         | unit | range            |
/// |--------|--------------|------|------------------|
/// | mu_S   | `mu_static`  | -    | > 0              |
/// | mu_D   | `mu_dynamic` | -    | > 0, <= mu_S     |
/// | F_n    | argument     | N    | any; F_n <= 0 and NaN give 0 |
///
/// Bad parameters: SetupError. Does not model: dependence on speed, waiting time or contact area.
/// Source: [johnson1985].
///
/// @tparam Slip_  slip rule, @tparam Skew_  skew rule: see law/friction/concept.hpp.
template <Real S, class Slip_ = ReturnMapping, class Skew_ = ByComponents>
class CoulombFriction {
 public:
  using Scalar = S;
  using Slip = Slip_;
  using Skew = Skew_;
  static constexpr bool active = true;

  struct Params {
    S mu_static;                             ///< [-] > 0
    S mu_dynamic;                            ///< [-] > 0, <= mu_static
    PALPATE_NO_UNIQUE_ADDRESS Skew_ skew{};  ///< parameters of the skew rule, where it has any
  };

  constexpr explicit CoulombFriction(const Params& params) : p_(params) {
    require_positive(p_.mu_static, "CoulombFriction", "mu_static [-] must be > 0 and finite");
    require_positive(p_.mu_dynamic, "CoulombFriction", "mu_dynamic [-] must be > 0 and finite");
    if (p_.mu_dynamic > p_.mu_static) {
      fail("CoulombFriction", "mu_dynamic [-] must be <= mu_static", static_cast<double>(p_.mu_dynamic));
    }
  }

  /// f_max [N] at the normal force F_n [N].
  [[nodiscard]] constexpr S static_limit(S normal_force) const noexcept {
    return is_positive(normal_force) ? p_.mu_static * normal_force : S(0);
  }
  /// Friction while sliding [N] at the normal force F_n [N].
  [[nodiscard]] constexpr S sliding_limit(S normal_force) const noexcept {
    return is_positive(normal_force) ? p_.mu_dynamic * normal_force : S(0);
  }
  /// sup f_max / F_n [-].
  [[nodiscard]] constexpr S max_coefficient() const noexcept { return p_.mu_static; }
  [[nodiscard]] constexpr const Skew& skew() const noexcept { return p_.skew; }
  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

static_assert(FrictionLaw<CoulombFriction<float>> && FrictionLaw<CoulombFriction<double>>);

}  // namespace palpate
