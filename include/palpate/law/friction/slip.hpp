// SPDX-License-Identifier: MIT
#pragma once

/// @file Stick or slip: how far the deformation may stretch sideways before its origin p0 moves (section
/// IV.B). Scalars only; the geometry is in law/friction/anchor.hpp.
///
/// | slip rule        | when the limit is passed, p0 moves ...                 | use it when                              |
/// |------------------|--------------------------------------------------------|------------------------------------------|
/// | `ReturnMapping`  | just so far that elastic force = friction; continuous  | the default                              |
/// | `LiteralShift`   | by the tick's whole motion, as printed; force may jump | comparing with the paper                 |
///
/// | skew rule        | force of a displacement D = D_n + D_t                  | use it when                              |
/// |------------------|--------------------------------------------------------|------------------------------------------|
/// | `ByComponents`   | law(|D_n|) along the normal, law(|D_t|) across (IV.B)  | the default                              |
/// | `Radial`         | law(|D|) against D, then decomposed (IV.C)             | comparing with the paper's regions       |

#include <palpate/core/scalar.hpp>
#include <palpate/law/force/concept.hpp>
#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/fwd.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// Normal and tangential part of the force [N] of a skewed deformation.
template <Real S>
struct SkewedForce {
  S normal;
  S tangential;
};

namespace detail {
// Root of g, or the lower end of an epsilon around it, on [0, high], where g changes sign once, from <= 0 to
// g(high) > 0. False position with the stale end's value reduced [anderson1973]; halving where that has not
// halved the bracket in four steps, or where g is 0 at the lower end, as it may be at 0 itself. At most 240
// steps.
template <Real S, class G>
[[nodiscard]] S root_below(S high, const G& g) noexcept {
  constexpr S epsilon = std::numeric_limits<S>::epsilon();
  S low = S(0), at_low = g(S(0)), at_high = g(high), goal = high;  // goal: what the bracket must be below
  S least = epsilon;  // of high: distance from the ends, so that the bracket closes on both sides
  int stale = 0;
  bool last_was_high = false;
  for (int i = 0; i < 240 && high - low > epsilon * high; ++i) {
    const S width = high - low;
    stale = width <= goal ? 0 : stale + 1;
    if (stale == 0) goal = width / S(2);
    S x = low + width / S(2);
    if (at_low < S(0) && stale < 4) {
      const S off = (std::min)(least * high, width / S(2));
      x = std::clamp(high - at_high / (at_high - at_low) * width, low + off, high - off);
    }
    const S value = g(x);
    if (value == S(0)) return x;
    const bool is_high = value > S(0);
    S& replaced = is_high ? at_high : at_low;
    if (i > 0 && is_high == last_was_high) {
      const S reduced = S(1) - value / replaced;
      (is_high ? at_low : at_high) *= reduced > S(0) ? reduced : S(0.5);
      least *= S(8);
    } else {
      least = epsilon;
    }
    last_was_high = is_high;
    replaced = value;
    (is_high ? high : low) = x;
  }
  return low;
}
}  // namespace detail

/// Skew rule of IV.B: each part of D gives its own force, F_cn = law(|D_n|), F_ct = law(|D_t|).
struct ByComponents {
  /// `normal_force` is the region's F_cn, already summed; stretch is |D_t| [m].
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SkewedForce<S> force(const L& law, S /*depth*/, S normal_force, S stretch) noexcept {
    return {normal_force, law.force(stretch)};
  }
  /// The stretch |D_t| [m] at which the tangential force is f [N].
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S stretch(const L& law, S /*depth*/, S f) noexcept {
    return law.depth(f);
  }
  /// The largest stretch <= trial [m] whose tangential force is within limit(F_cn).
  template <ForceLaw L, class Limit, Real S = typename L::Scalar>
  [[nodiscard]] static S admissible(const L& law, S /*depth*/, S normal_force, S trial,
                                    const Limit& limit) noexcept {
    const S most = limit(normal_force);
    if (law.force(trial) <= most) return trial;  // sticks: no inverse needed
    return (std::min)(trial, law.depth(most));
  }
  /// Energy [J] that the stretch |D_t| [m] adds.
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S energy(const L& law, S /*depth*/, S stretch) noexcept {
    return law.energy(stretch);
  }
};

/// Skew rule of IV.C: F = law(|D|) against D, decomposed into F D_n/|D| and F D_t/|D|. It differs from
/// ByComponents by the law's nonlinear part; the two agree for a linear law.
struct Radial {
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SkewedForce<S> force(const L& law, S depth, S normal_force, S stretch) noexcept {
    if (!(stretch > S(0))) return {normal_force, S(0)};
    const S length = std::hypot(depth, stretch);
    const S ratio = law.force(length) / length;
    // normal_force is law(depth), and more with a rate term or where a region asks for more than the law's
    // maximum.
    const S unskewed = law.force(depth);
    return {unskewed > S(0) ? normal_force * (ratio * depth / unskewed) : normal_force, ratio * stretch};
  }
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S stretch(const L& law, S depth, S f) noexcept {
    // The ratio law(|D|)/|D| lies between its values at depth and at |D|; doubling finds an upper end.
    S high = (std::max)(law.depth(f), depth);
    for (int i = 0; i < 60 && force(law, depth, S(0), high).tangential < f; ++i) high *= S(2);
    return detail::root_below(high, [&](S t) { return force(law, depth, S(0), t).tangential - f; });
  }
  template <ForceLaw L, class Limit, Real S = typename L::Scalar>
  [[nodiscard]] static S admissible(const L& law, S depth, S normal_force, S trial,
                                    const Limit& limit) noexcept {
    const auto excess = [&](S t) {
      const SkewedForce<S> f = force(law, depth, normal_force, t);
      return f.tangential - limit(f.normal);
    };
    return excess(trial) > S(0) ? detail::root_below(trial, excess) : trial;
  }
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S energy(const L& law, S depth, S stretch) noexcept {
    return law.energy(std::hypot(depth, stretch)) - law.energy(depth);
  }
};

/// What stick and slip remember of one contact between ticks.
template <Real S>
struct SlipState {
  bool sliding = false;
  /// Present limit over the law's (f_max while sticking, f_slide while sliding) [-], >= 1. Above 1 after
  /// breakaway and after regions merged; falls to 1 as the tool travels on.
  S strength = S(1);
  S slid = S(0);  ///< largest |D_t| since the last slip [m]
  /// Tangential springs in parallel [-], >= 1: F_ct = springs F_ct(|D_t|). Above 1 after regions merged; a
  /// slip lets the surplus go before it shortens D_t.
  S springs = S(1);

  /// A contact that holds `force` [N] with at most `energy` [J]: sets springs and returns the stretch |D_t|
  /// [m]. One spring with the joint force of two would hold more energy than both, a gift to the user at each
  /// merger.
  template <class Skew, ForceLaw L>
  [[nodiscard]] S hold(const L& law, S depth, S force, S energy) noexcept {
    const auto one = [&](S t) { return Skew::force(law, depth, S(0), t).tangential; };
    const auto excess = [&](S t) { return force * Skew::energy(law, depth, t) - energy * one(t); };
    S stretch = Skew::stretch(law, depth, force);
    if (excess(stretch) > S(0)) stretch = detail::root_below(stretch, excess);
    springs = one(stretch) > S(0) ? (std::max)(force / one(stretch), S(1)) : S(1);
    return stretch;
  }
};

/// One tick's motion of the contact, as the slip rule needs it.
template <Real S>
struct SlipTrial {
  S depth;         ///< D_n of the equivalent contact [m]
  S normal_force;  ///< F_cn at zero stretch [N]
  S stretch;       ///< |D_t| if the tool stuck in this tick [m]
  S before;        ///< |D_t| at the end of the last tick [m]
  S travel;        ///< distance the contact's tool point moved in this tick [m]
};

/// The stretch after the slip rule, and the force it gives.
template <Real S>
struct SlipResult {
  S stretch;             ///< |D_t| [m]
  SkewedForce<S> force;  ///< F_cn, F_ct [N]
};

/// p0 moves just so far that the elastic tangential force equals the friction (return mapping, as in
/// plasticity).
///
///     stick:  F_ct(D_t) <= f_max(F_cn)
///     slip:   F_ct(D_t) = s f_slide(F_cn),  s = f_max/f_slide at breakaway, s -> 1 as the tool travels on
///
/// No equation: reading of IV.B. The printed drop from f_max to mu_D F_cn at breakaway is a force jump; here
/// it is spread over the tool's travel, s - 1 falling by travel/|D_t| per tick, so that friction never
/// changes faster than the law's stiffness times the motion. Full static strength returns when the tool has
/// gone back by a tenth of the stretch: not in each tick without motion, or the steps of an encoder would
/// make every slow slide stick and slip. Since p0 only moves so as to shorten D_t, the elastic energy only
/// falls in a slip: friction never does positive work on the user.
struct ReturnMapping {
  static constexpr bool shifts_by_travel = false;

  template <class Skew, FrictionLaw F, ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SlipResult<S> advance(const F& friction, const L& law, const SlipTrial<S>& trial,
                                             SlipState<S>& state) noexcept {
    constexpr S rest = S(0.9);
    const SkewedForce<S> stuck = Skew::force(law, trial.depth, trial.normal_force, trial.stretch);
    const auto limit = [&](S normal_force) {
      return state.strength *
             (state.sliding ? friction.sliding_limit(normal_force) : friction.static_limit(normal_force));
    };
    const auto settle = [&] {
      if (state.springs > S(1)) {
        const S most = limit(stuck.normal);
        if (state.springs * stuck.tangential > most)
          state.springs = (std::max)(most / stuck.tangential, S(1));
      }
      return Skew::admissible(law, trial.depth, trial.normal_force, trial.stretch, [&](S normal_force) {
        const S most = limit(normal_force);
        return state.springs > S(1) ? most / state.springs : most;
      });
    };
    const auto static_over_sliding = [&](S stretch) {
      const S normal = Skew::force(law, trial.depth, trial.normal_force, stretch).normal;
      const S sliding = friction.sliding_limit(normal);
      return sliding > S(0) ? friction.static_limit(normal) / sliding : S(1);
    };
    if (state.sliding && trial.stretch < rest * state.slid) {  // full static strength returns
      state.sliding = false;
      state.strength = (std::max)(S(1), state.strength / static_over_sliding(trial.before));
      state.slid = S(0);
    }
    const S springs = state.springs;
    S stretch = settle();
    if (!state.sliding && (stretch < trial.stretch || state.springs < springs)) {
      state.sliding = true;
      // A sliding limit next to nothing must not make the ratio infinite.
      state.strength =
          (std::min)(state.strength * static_over_sliding(stretch), S(1) / (std::numeric_limits<S>::min)());
      state.slid = S(0);
    }
    if (state.strength > S(1) && stretch > S(0)) {
      const S left = (std::max)(S(0), S(1) - trial.travel / stretch);
      state.strength = S(1) + (state.strength - S(1)) * left;
      stretch = settle();
    }
    state.slid = stretch < trial.stretch ? stretch : (std::max)(state.slid, stretch);
    SkewedForce<S> force = Skew::force(law, trial.depth, trial.normal_force, stretch);
    force.tangential *= state.springs;
    return {stretch, force};
  }
};

/// As printed in IV.B: stick while F_ct <= f_max; otherwise |F_ct| = min(mu_D F_cn, f_max) and p0 moves by
/// the tick's whole tangential motion, so D_t keeps its last value. The stored D_t and the friction then
/// disagree, and the force jumps at breakaway and at re-sticking.
struct LiteralShift {
  static constexpr bool shifts_by_travel = true;

  template <class Skew, FrictionLaw F, ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SlipResult<S> advance(const F& friction, const L& law, const SlipTrial<S>& trial,
                                             SlipState<S>& state) noexcept {
    SkewedForce<S> stuck = Skew::force(law, trial.depth, trial.normal_force, trial.stretch);
    stuck.tangential *= state.springs;
    state.sliding = stuck.tangential > friction.static_limit(stuck.normal);
    if (!state.sliding) return {trial.stretch, stuck};
    state.springs = S(1);
    return {trial.before, {stuck.normal, friction.sliding_limit(stuck.normal)}};
  }
};

}  // namespace palpate
