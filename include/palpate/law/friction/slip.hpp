// SPDX-License-Identifier: MIT
#pragma once

/// @file Slip rules: how far the deformation may stretch sideways before its origin p0 moves (section IV.B).
/// Scalars only; the geometry is in law/friction/anchor.hpp, the chooser in law/friction/concept.hpp.

#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/detail/root_below.hpp>

#include <algorithm>
#include <limits>

namespace palpate {

/// The stretch |D_t| [m] of a contact that takes over `force` [N] with at most `energy` [J] from merged or
/// split regions; sets state.springs. One spring with the joint force of two would store more energy than
/// both, a gift to the user at each merger.
template <class Skew, ForceLaw L, Real S = typename L::Scalar>
[[nodiscard]] inline S carried_stretch(const Skew& skew, const L& law, S depth, S force, S energy,
                                       SlipState<S>& state) noexcept {
  const auto one = [&](S t) { return skew.force(law, depth, S(0), t).tangential; };
  const auto excess = [&](S t) { return force * skew.energy(law, depth, t) - energy * one(t); };
  S stretch = skew.stretch(law, depth, force);
  if (excess(stretch) > S(0)) stretch = detail::root_below(stretch, excess);
  state.springs = one(stretch) > S(0) ? (std::max)(force / one(stretch), S(1)) : S(1);
  return stretch;
}

/// p0 moves just so far that the elastic tangential force equals the friction (return mapping, as in
/// plasticity).
///
///     stick:  F_ct(D_t) <= f_max(F_cn)
///     slip:   F_ct(D_t) = f_slide + s (f_max - f_slide),  s = 1 at breakaway, s -> 0 as the tool travels on
///
/// No equation: reading of IV.B. The printed drop from f_max to mu_D F_cn at breakaway is a force jump; here
/// it is spread over the tool's travel, s falling by s travel/|D_t| per tick, so that friction never changes
/// faster than the law's stiffness times the motion. s is a share of the difference, not a factor: where the
/// load changes meanwhile, so does f_max/f_slide, and f_max must not be passed. Full static strength returns
/// when the tool has gone back by a tenth of the stretch: not in each tick without motion, or the steps of an
/// encoder would make every slow slide stick and slip. Since p0 only moves so as to shorten D_t, the elastic
/// energy only falls in a slip: friction never does positive work on the user.
struct ReturnMapping {
  static constexpr bool shifts_by_travel = false;

  template <class Skew, FrictionLimits F, ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SlipResult<S> advance(const F& friction, const Skew& skew, const L& law,
                                             const SlipTrial<S>& trial, SlipState<S>& state) noexcept {
    constexpr S rest = S(0.9);  // gone back by a tenth of the stretch
    const SkewedForce<S> stuck = skew.force(law, trial.depth, trial.normal_force, trial.stretch);
    const auto of_law = [&](S normal_force) {
      if (!state.sliding) return friction.static_limit(normal_force);
      const S sliding = friction.sliding_limit(normal_force);
      if (!(state.static_share > S(0))) return sliding;
      return sliding + state.static_share * (friction.static_limit(normal_force) - sliding);
    };
    const auto limit = [&](S normal_force) { return state.strength * of_law(normal_force); };
    const auto settle = [&] {
      if (state.springs > S(1)) {
        const S f_max = limit(stuck.normal);
        if (state.springs * stuck.tangential > f_max)
          state.springs = (std::max)(f_max / stuck.tangential, S(1));
      }
      return skew.admissible(law, trial.depth, trial.normal_force, trial.stretch, [&](S normal_force) {
        const S f_max = limit(normal_force);
        return state.springs > S(1) ? f_max / state.springs : f_max;
      });
    };
    if (state.sliding && trial.stretch < rest * state.slid) {  // full static strength returns
      const S normal = skew.force(law, trial.depth, trial.normal_force, trial.before).normal;
      const S f_max = friction.static_limit(normal);
      state.strength = f_max > S(0) ? (std::max)(S(1), limit(normal) / f_max) : S(1);
      state.sliding = false;
      state.static_share = state.slid = S(0);
    }
    const S springs = state.springs;
    const bool slid_before = state.sliding;
    S stretch = slid_before ? trial.stretch : settle();
    if (!slid_before && (stretch < trial.stretch || state.springs < springs)) {
      state.sliding = true;
      state.static_share = S(1);
      state.slid = S(0);
    }
    const bool wears_off = (state.strength > S(1) || state.static_share > S(0)) && trial.stretch > S(0);
    if (wears_off) {
      const S left = (std::max)(S(0), S(1) - trial.travel / trial.stretch);
      state.strength = S(1) + (state.strength - S(1)) * left;
      state.static_share *= left;
      if (!(state.static_share > std::numeric_limits<S>::epsilon())) state.static_share = S(0);
    }
    if (slid_before || wears_off) stretch = settle();
    state.slid = stretch < trial.stretch ? stretch : (std::max)(state.slid, stretch);
    SkewedForce<S> force = skew.force(law, trial.depth, trial.normal_force, stretch);
    force.tangential *= state.springs;
    return {stretch, force};
  }
};

/// As printed in IV.B: stick while F_ct <= f_max; otherwise |F_ct| = min(mu_D F_cn, f_max) and p0 moves by
/// the tick's whole tangential motion, so D_t keeps its last value. The stored D_t and the friction then
/// disagree, and the force jumps at breakaway and at re-sticking.
struct LiteralShift {
  static constexpr bool shifts_by_travel = true;

  template <class Skew, FrictionLimits F, ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SlipResult<S> advance(const F& friction, const Skew& skew, const L& law,
                                             const SlipTrial<S>& trial, SlipState<S>& state) noexcept {
    SkewedForce<S> stuck = skew.force(law, trial.depth, trial.normal_force, trial.stretch);
    stuck.tangential *= state.springs;
    state.sliding = stuck.tangential > friction.static_limit(stuck.normal);
    if (!state.sliding) return {trial.stretch, stuck};
    state.springs = S(1);
    return {trial.before, {stuck.normal, friction.sliding_limit(stuck.normal)}};
  }
};

}  // namespace palpate
