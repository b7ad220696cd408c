// SPDX-License-Identifier: MIT
#pragma once

/// @file  Decorator: a force law that yields, and leaves a dent that stays.

#include <palpate/core/error.hpp>
#include <palpate/law/force/detail/with_law.hpp>
#include <palpate/law/force/linear.hpp>

#include <algorithm>
#include <span>
#include <utility>

namespace palpate {

/// A law with a permanent set: elastoplastic contact with linear hardening.
///
///     F = law(D - s)                                     F = 0 for D <= s
///     yield: F <= Y(D) = F_y + H max(D - D_y, 0),        law(D_y) = F_y
///     return: law(D - s) > Y(D)  ->  s = D - law^-1(Y(D))
///
/// | symbol | name          | unit | range                                                          |
/// |--------|---------------|------|----------------------------------------------------------------|
/// | D      | argument      | m    | any; D <= 0 and NaN give 0                                     |
/// | s      | `State::set`  | m    | >= 0, only grows                                               |
/// | F_y    | `yield_force` | N    | > 0                                                            |
/// | H      | `hardening`   | N/m  | >= 0, < law'(D_y); tangent of F(D) beyond yield, default 0     |
/// |        | `extent`      | m    | > 0; a contact that begins this near meets the dent            |
///
/// Loading follows the law to F_y, then the line Y; unloading and loading again follow the law, shifted by s.
/// The hardening is given in D, not in s as in textbooks, because that is the slope of a measured curve, and
/// the return is then a closed form for any law. For a linear law of stiffness k the textbook's modulus is H
/// k/(k - H). Does not depend on time. The free energy is that of the law at D - s; F ds, what the set costs,
/// is lost. Where the law softens below the slope H the set rests and F follows the law, above Y. Bad
/// parameters: SetupError. Does not model: recovery, the rim that rises beside a dent, ploughing. No
/// equation: IV.A names "elastic, plastic, etc."; source: [simo1998] ch. 1.
template <ForceLaw Law>
class PlasticForce : public detail::WithLaw<Law> {
  using Base = detail::WithLaw<Law>;
  using S = typename Law::Scalar;

 public:
  using Scalar = S;
  using Base::force, Base::stiffness, Base::energy, Base::depth;

  struct Params {
    S yield_force;       ///< F_y [N] > 0
    S hardening = S(0);  ///< H [N/m] in [0, law'(D_y))
    S extent;            ///< [m] > 0
  };
  struct State {
    S set = S(0);  ///< s [m]
  };

  PlasticForce(Law law, Params params) : Base(std::move(law)), p_(params) {
    require_positive(p_.yield_force, "PlasticForce", "yield_force [N] must be > 0 and finite");
    require_non_negative(p_.hardening, "PlasticForce", "hardening [N/m] must be >= 0 and finite");
    require_positive(p_.extent, "PlasticForce", "extent [m] must be > 0 and finite");
    yield_depth_ = law_.depth(p_.yield_force);
    if (!(p_.hardening < law_.stiffness(yield_depth_)) && yield_depth_ < law_.max_depth()) {
      fail("PlasticForce", "hardening [N/m] must be below the law's stiffness at the yield force",
           static_cast<double>(p_.hardening));
    }
  }

  /// The state at depth D [m]. No time goes into it.
  [[nodiscard]] State advance(const State& state, S depth, S /*dt*/) const noexcept {
    if (!is_positive(depth) || !is_finite(depth)) return state;
    const S yield = p_.yield_force + p_.hardening * (std::max)(depth - yield_depth_, S(0));
    if (!(law_.force(depth - state.set) > yield)) return state;
    return {(std::max)(state.set, depth - law_.depth(yield))};
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth, const State& state) const noexcept { return law_.force(depth - state.set); }
  /// dF/dD [N/m] at depth D [m], elastic.
  [[nodiscard]] S stiffness(S depth, const State& state) const noexcept {
    return law_.stiffness(depth - state.set);
  }
  /// The elastic energy [J] at depth D [m].
  [[nodiscard]] S energy(S depth, const State& state) const noexcept {
    return law_.energy(depth - state.set);
  }
  /// D [m] at the force F [N]; the set where there is none.
  [[nodiscard]] S depth(S force, const State& state) const noexcept { return state.set + law_.depth(force); }

  /// The set at depth D [m] that leaves the parts' mean share of the law's force.
  [[nodiscard]] State carried(std::span<const CarriedState<PlasticForce>> parts, S depth) const noexcept {
    S left = S(0);
    for (const CarriedState<PlasticForce>& part : parts) {
      const S fresh = law_.force(part.depth);
      left += part.share * (fresh > S(0) ? law_.force(part.depth - part.state.set) / fresh : S(1));
    }
    const S set = depth - law_.depth((std::min)(left, S(1)) * law_.force(depth));
    return {is_positive(set) && is_finite(set) ? set : S(0)};
  }

  [[nodiscard]] S extent() const noexcept { return p_.extent; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  using Base::law_;

  Params p_;
  S yield_depth_;  // D_y [m]
};

static_assert(StatefulForceLaw<PlasticForce<LinearForce<float>>> &&
              StatefulForceLaw<PlasticForce<LinearForce<double>>>);

}  // namespace palpate
