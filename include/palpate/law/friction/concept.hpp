// SPDX-License-Identifier: MIT
#pragma once

/// @file What a friction law, a slip rule and a skew rule must offer. Read this before writing one.
///
/// | friction law       | limit              | use it when                                               |
/// |--------------------|--------------------|-----------------------------------------------------------|
/// | `PowerLawFriction` | f_max = K F_n^beta | the paper's (Howell and Mazur): elastic or fibrous solids |
/// | `CoulombFriction`  | f_max = mu_S F_n   | beta = 1: dry, hard or rough pairs                        |
/// | `Frictionless`     | 0                  | absent: no state, no byte, no instruction                 |
///
/// | slip rule       | when the limit is passed, p0 moves ...                 | use it when              |
/// |-----------------|--------------------------------------------------------|--------------------------|
/// | `ReturnMapping` | just so far that elastic force = friction; continuous  | the default              |
/// | `LiteralShift`  | by the tick's whole motion, as printed; force may jump | comparing with the paper |
///
/// | skew rule       | force of a displacement D = D_n + D_t                  | use it when              |
/// |-----------------|--------------------------------------------------------|--------------------------|
/// | `ByComponents`  | law(|D_n|) along the normal, law(|D_t|) across (IV.B)  | the default              |
/// | `BondedDisc`    | as ByComponents, softer across as elasticity has it    | nu is known              |
/// | `Radial`        | law(|D|) against D, then decomposed (IV.C)             | the paper's regions      |
///
/// A law says how large friction may be. The slip rule says how the origin p0 of the deformation moves when
/// the limit is passed, the skew rule how much force a sideways stretch gives and how a region resists twist.
/// Both are types inside the law.
/// Absent on purpose: velocity-regularised laws, because they cannot keep a tool at rest.

#include <palpate/core/absent.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/slip_state.hpp>

namespace palpate {

namespace detail {
/// Stands for what a skew rule is given as the limit.
template <Real S>
struct AnyLimit {
  [[nodiscard]] S operator()(S normal_force) const noexcept;
};
}  // namespace detail

/// The force of the stretch |D_t| [m] at depth D_n [m]: (law, depth, F_cn at no stretch, stretch).
template <class K, class S>
concept HasSkewForce = requires(const K& skew, const LinearForce<S>& law, S x) {
  { skew.force(law, x, x, x) } noexcept -> std::same_as<SkewedForce<S>>;
};

/// Its inverse, the stretch [m] whose tangential force is f [N]: (law, depth, f).
template <class K, class S>
concept HasSkewStretch = requires(const K& skew, const LinearForce<S>& law, S x) {
  { skew.stretch(law, x, x) } noexcept -> std::same_as<S>;
};

/// The largest stretch <= trial [m] whose tangential force is within limit(F_cn): (law, depth, F_cn at no
/// stretch, trial, limit).
template <class K, class S>
concept HasSkewAdmissible =
    requires(const K& skew, const LinearForce<S>& law, S x, const detail::AnyLimit<S>& limit) {
      { skew.admissible(law, x, x, x, limit) } noexcept -> std::same_as<S>;
    };

/// The elastic energy [J] that the stretch adds: (law, depth, stretch).
template <class K, class S>
concept HasSkewEnergy = requires(const K& skew, const LinearForce<S>& law, S x) {
  { skew.energy(law, x, x) } noexcept -> std::same_as<S>;
};

/// Optional: the torsional stiffness of a region that sticks, over a^2 dF_n/dD with a the radius of its area.
/// Without it a region gives no torque against twist.
template <class K>
concept HasTorsionalRatio = requires(const K& skew) {
  { skew.torsional_ratio() } noexcept -> std::convertible_to<double>;
};

/// Skew rule: functions, static ones where it has no parameters, templates of any `ForceLaw`. All are
/// continuous and rise with the stretch; force and energy are 0 at stretch 0.
template <class K, class S>
concept SkewRule =
    Real<S> && HasSkewForce<K, S> && HasSkewStretch<K, S> && HasSkewAdmissible<K, S> && HasSkewEnergy<K, S>;

template <class F>  // f_max(F_n) [N]: the largest force that sticks
concept HasStaticLimit = requires(const F& law, typename F::Scalar normal_force) {
  { law.static_limit(normal_force) } noexcept -> std::same_as<typename F::Scalar>;
};

template <class F>  // friction while sliding [N], <= static_limit
concept HasSlidingLimit = requires(const F& law, typename F::Scalar normal_force) {
  { law.sliding_limit(normal_force) } noexcept -> std::same_as<typename F::Scalar>;
};

template <class F>  // sup f_max / F_n [-]: the bound on friction's share of a force step
concept HasMaxCoefficient = requires(const F& law) {
  { law.max_coefficient() } noexcept -> std::same_as<typename F::Scalar>;
};

/// Friction limits as functions of the normal force F_n [N] >= 0. Both are 0 at F_n = 0, continuous and
/// non-decreasing.
template <class F>
concept FrictionLimits = HasScalar<F> && HasStaticLimit<F> && HasSlidingLimit<F> && HasMaxCoefficient<F>;

/// True where p0 moves by the tick's whole tangential motion, false where it moves so far that the stretch of
/// `advance` is left.
template <class R>
concept HasShiftsByTravel = requires {
  { R::shifts_by_travel } -> std::convertible_to<bool>;
};

/// One tick of stick or slip, `advance(friction, skew, law, trial, state)`. A template of any skew rule, any
/// `FrictionLimits` and any `ForceLaw`; not of `FrictionLaw`, which asks for the rule itself.
template <class R, class F>
concept HasSlipAdvance =
    requires(const F& friction, const typename F::Skew& skew, const LinearForce<typename F::Scalar>& law,
             const SlipTrial<typename F::Scalar>& trial, SlipState<typename F::Scalar>& state) {
      {
        R::advance(friction, skew, law, trial, state)
      } noexcept -> std::same_as<SlipResult<typename F::Scalar>>;
    };

/// Slip rule for the friction law F: the stretch that is left, and its force, no more than F's limit.
template <class R, class F>
concept SlipRule = HasShiftsByTravel<R> && HasSlipAdvance<R, F>;

template <class F>
concept HasSkew = SkewRule<typename F::Skew, typename F::Scalar>;

template <class F>
concept HasSlip = SlipRule<typename F::Slip, F>;

namespace detail {
/// Checked instead of a friction law that is absent.
struct NoFriction {
  using Scalar = double;
  struct Skew {
    static SkewedForce<double> force(const LinearForce<double>&, double, double, double) noexcept;
    static double stretch(const LinearForce<double>&, double, double) noexcept;
    static double admissible(const LinearForce<double>&, double, double, double,
                             const AnyLimit<double>&) noexcept;
    static double energy(const LinearForce<double>&, double, double) noexcept;
  };
  struct Slip {
    static constexpr bool shifts_by_travel = false;
    static SlipResult<double> advance(const NoFriction&, const Skew&, const LinearForce<double>&,
                                      const SlipTrial<double>&, SlipState<double>&) noexcept;
  };
  [[nodiscard]] double static_limit(double) const noexcept;
  [[nodiscard]] double sliding_limit(double) const noexcept;
  [[nodiscard]] double max_coefficient() const noexcept;
};
template <class F>
using CheckedFriction = ActiveOrT<F, NoFriction>;

/// The law's skew rule: what `skew()` returns, where the law has that.
template <class F>
[[nodiscard]] constexpr typename F::Skew skew_of(const F& friction) noexcept {
  if constexpr (requires { friction.skew(); })
    return friction.skew();
  else
    return {};
}
}  // namespace detail

/// Friction: its limits, and the slip and skew rules that it goes with; `skew()` where the skew rule has
/// parameters. Absent where `active` is false; then
/// nothing else is asked of it.
template <class F>
concept FrictionLaw =
    HasScalar<F> && HasActive<F> && std::copyable<F> && FrictionLimits<detail::CheckedFriction<F>> &&
    HasSkew<detail::CheckedFriction<F>> && HasSlip<detail::CheckedFriction<F>>;

}  // namespace palpate
