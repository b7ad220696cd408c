// SPDX-License-Identifier: MIT
#pragma once

/// @file  Decorator: a force law that relaxes, after a Prony series.

#include <palpate/core/error.hpp>
#include <palpate/law/force/detail/with_law.hpp>
#include <palpate/law/force/linear.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

namespace palpate {

/// A law that relaxes: quasi-linear viscoelasticity (Fung) with N exponentials, in hereditary form.
///
///     F(t) = int G(t - t') d law(D(t')),   G(t) = g_inf + sum_i g_i exp(-t/tau_i),   g_inf = 1 - sum_i g_i
///     with s_i' = (law(D) - s_i)/tau_i:   F = law(D) - sum_i g_i s_i                              F >= 0
///
/// | symbol | name         | unit | range                                                                 |
/// |--------|--------------|------|-----------------------------------------------------------------------|
/// | D      | argument     | m    | any; D <= 0 and NaN: no contact                                       |
/// | g_i    | `Term::part` | -    | > 0, sum below 1: what relaxes of a step of D                         |
/// | tau_i  | `Term::time` | s    | > 0                                                                   |
/// | s_i    | `State`      | N    | the law's force, low-pass filtered                                    |
/// |        | `extent`     | m    | > 0; a contact that begins this near meets what the last one left     |
///
/// A step of D gives G(t) law(D): the law at once, g_inf of it in the end. The stiffness at once is the
/// law's. A tick is exact, for any dt, where the law's force runs straight within it: at a constant rate of D
/// for a linear law, within the sagitta of its curve for others. Where the tool leaves faster than the body
/// recovers F is 0, the body recovers freely, and contact is back when the tool is as deep as its surface,
/// D_free = law^-1(sum g_i s_i). The free energy,
///
///     U = W(D) - D sum_i g_i s_i + sum_i g_i W*(s_i),   D no less than D_free
///
/// with W the law's energy and W* = s law^-1(s) - W(law^-1(s)) its dual, is at least 0 and loses g_i (law(D)
/// - s_i)(D - law^-1(s_i))/tau_i >= 0 a second: passive for any law that rises. Without a dt that makes sense
/// no time passes. Bad parameters: SetupError. No equation: IV.A; source: [fung1993] ch. 7, [simo1998] ch.
/// 10.
template <ForceLaw Law, std::size_t N = 1>
class RelaxingForce : public detail::WithLaw<Law> {
  using Base = detail::WithLaw<Law>;
  static_assert(N >= 1, "a Prony series has a term");
  using S = typename Law::Scalar;

 public:
  using Scalar = S;
  using Base::force, Base::stiffness, Base::energy, Base::depth;

  struct Term {
    S part;  ///< g_i [-] > 0
    S time;  ///< tau_i [s] > 0
  };
  struct Params {
    std::array<Term, N> terms;  ///< sum of g_i below 1
    S extent;                   ///< [m] > 0
  };
  struct State {
    S elastic = S(0);  ///< the law's force at the last tick [N], at D or, without contact, at D_free
    std::array<S, N> relaxed{};  ///< s_i [N]
  };

  RelaxingForce(Law law, Params params) : Base(std::move(law)), p_(params) {
    S sum = S(0);
    for (const Term& term : p_.terms) {
      require_positive(term.part, "RelaxingForce", "part [-] of a term must be > 0 and finite");
      require_positive(term.time, "RelaxingForce", "time [s] of a term must be > 0 and finite");
      sum += term.part;
    }
    if (!(sum < S(1))) {
      fail("RelaxingForce", "the parts [-] must add up to less than 1", static_cast<double>(sum));
    }
    require_positive(p_.extent, "RelaxingForce", "extent [m] must be > 0 and finite");
  }

  /// The state dt [s] later, at depth D [m].
  [[nodiscard]] State advance(const State& state, S depth, S dt) const noexcept {
    const S pressed = law_.force(depth);
    if (!(pressed < (std::numeric_limits<S>::max)() / S(2))) return state;  // what follows may be larger
    const S time = is_positive(dt) && is_finite(dt) ? dt : S(0);
    // s_i at the end is fixed_i + b_i u for the law's force u there, which without contact is sum g_i s_i.
    std::array<S, N> fixed, slope;
    S constant = S(0), factor = S(0);
    for (std::size_t i = 0; i < N; ++i) {
      const S z = time / p_.terms[i].time;
      slope[i] = ramp(z);
      fixed[i] =
          state.relaxed[i] - std::expm1(-z) * (state.elastic - state.relaxed[i]) - slope[i] * state.elastic;
      constant += p_.terms[i].part * fixed[i];
      factor += p_.terms[i].part * slope[i];
    }
    State now;
    now.elastic = (std::max)(pressed, constant / (S(1) - factor));
    for (std::size_t i = 0; i < N; ++i) now.relaxed[i] = (std::max)(fixed[i] + slope[i] * now.elastic, S(0));
    return now;
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth, const State& state) const noexcept {
    return (std::max)(law_.force(depth) - lost(state), S(0));
  }
  /// dF/dD [N/m] at depth D [m]: the law's, where there is a force.
  [[nodiscard]] S stiffness(S depth, const State& state) const noexcept {
    return law_.force(depth) > lost(state) ? law_.stiffness(depth) : S(0);
  }
  /// The free energy U [J] at depth D [m].
  [[nodiscard]] S energy(S depth, const State& state) const noexcept {
    const S gone = lost(state);
    const S at = (law_.force(depth) > gone) ? depth : law_.depth(gone);
    S sum = law_.energy(at) - at * gone;
    for (std::size_t i = 0; i < N; ++i) {
      const S dual = law_.depth(state.relaxed[i]);
      sum += p_.terms[i].part * (state.relaxed[i] * dual - law_.energy(dual));
    }
    // Rounding of what cancels; NaN where the terms leave the scalar's range.
    return is_finite(sum) ? (std::max)(sum, S(0)) : std::numeric_limits<S>::infinity();
  }
  /// D [m] at the force F [N]; D_free where there is none.
  [[nodiscard]] S depth(S force, const State& state) const noexcept {
    return law_.depth(is_positive(force) ? force + lost(state) : lost(state));
  }

  /// The parts' mean, each s_i as a share of the law's force, at depth D [m].
  [[nodiscard]] State carried(std::span<const CarriedState<RelaxingForce>> parts, S depth) const noexcept {
    State state;
    constexpr S most = (std::numeric_limits<S>::max)();
    state.elastic = (std::min)(law_.force(depth), most);
    for (const CarriedState<RelaxingForce>& part : parts) {
      const S fresh = law_.force(part.depth);
      if (!(fresh > S(0))) continue;
      for (std::size_t i = 0; i < N; ++i)
        state.relaxed[i] = (std::min)(
            most, state.relaxed[i] +
                      part.share * (state.elastic * (std::min)(part.state.relaxed[i] / fresh, most)));
    }
    return state;
  }

  [[nodiscard]] S extent() const noexcept { return p_.extent; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  using Base::law_;

  // sum g_i s_i [N]
  S lost(const State& state) const noexcept {
    S sum = S(0);
    for (std::size_t i = 0; i < N; ++i) sum += p_.terms[i].part * state.relaxed[i];
    return sum;
  }

  // What s gains while the law's force rises by 1 in a tick of z = dt/tau: 1 - (1 - exp(-z))/z. Below 1/8 its
  // series: the difference would lose digits; the first term left out is 1e-17 of the sum.
  static S ramp(S z) noexcept {
    if (!(z < S(0.125))) return S(1) + std::expm1(-z) / z;
    S sum = S(1);
    for (int k = 11; k >= 3; --k) sum = S(1) - z / S(k) * sum;
    return z / S(2) * sum;
  }

  Params p_;
};

static_assert(StatefulForceLaw<RelaxingForce<LinearForce<float>>> &&
              StatefulForceLaw<RelaxingForce<LinearForce<double>, 3>>);

}  // namespace palpate
