// SPDX-License-Identifier: MIT
#pragma once

/// @file  Decorator: adds the transient term of eq. (1) to a force law.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>
#include <palpate/law/force/linear.hpp>

#include <algorithm>
#include <utility>

namespace palpate {

/// F (1 + 3/2 c D'), c [s/m]. The rate term vanishes with F at D = 0, so contact begins and ends without a
/// jump; 1 - c v approximates the coefficient of restitution at impact speed v. Source: [hunt1975].
struct HuntCrossley {
  template <Real S>
  [[nodiscard]] static constexpr S total(S elastic, S rate, S damping) noexcept {
    return elastic * (S(1) + S(1.5) * damping * rate);
  }
};

/// F + b D', b = 2 mu m [N s/m], literally the damping of (1). The force jumps from 0 to b D' on entry: a
/// hand feels it as a click. Offered for comparison.
struct Viscous {
  template <Real S>
  [[nodiscard]] static constexpr S total(S elastic, S rate, S damping) noexcept {
    return elastic + damping * rate;
  }
};

/// A force law with the rate term of (1), x'' + 2 mu x' + ..., as a function of the depth's rate.
///
///     F(D, D') = max(0, Form(law(D), D'))  for D > 0, else 0
///
/// | symbol | name      | unit                                       | range                            |
/// |--------|-----------|--------------------------------------------|----------------------------------|
/// | D'     | `rate`    | m/s                                        | > 0 going in; NaN, inf: left out |
/// | c or b | `damping` | HuntCrossley: s/m; Viscous: N s/m (2 mu m) | >= 0                             |
///
/// The total is never negative: damping does not pull the tool in. Left out, too, is a rate so large that
/// the total is out of the scalar's range. `force(depth)`, tangent, energy and inverse are the law's own
/// (rate 0). Bad parameters: SetupError. Does not model: the inertia term x'' of (1), which belongs to the
/// simulated tool; memory (creep, relaxation). Source: [luo2005] eq. (1).
template <ForceLaw Law, class Form = HuntCrossley>
class DampedForce {
  static_assert(!StatefulForceLaw<Law>, "DampedForce would drop the law's state");

  using S = typename Law::Scalar;

 public:
  using Scalar = S;

  struct Params {
    S damping;  ///< HuntCrossley: c [s/m]; Viscous: 2 mu m [N s/m]; >= 0
  };

  constexpr DampedForce(Law law, Params params) : law_(std::move(law)), p_(params) {
    require_non_negative(p_.damping, "DampedForce", "damping must be >= 0 and finite");
  }

  /// F [N] at depth D [m] and rate D' [m/s]; >= 0.
  [[nodiscard]] constexpr S force(S depth, S rate) const noexcept {
    const S elastic = law_.force(depth);
    if (!is_positive(depth) || !is_finite(rate)) return elastic;
    const S total = Form::total(elastic, rate, p_.damping);
    return is_finite(total) ? (std::max)(total, S(0)) : elastic;
  }
  /// The law's F [N] at depth D [m], at rest.
  [[nodiscard]] constexpr S force(S depth) const noexcept { return law_.force(depth); }
  /// The law's dF/dD [N/m] at depth D [m], at rest.
  [[nodiscard]] constexpr S stiffness(S depth) const noexcept { return law_.stiffness(depth); }
  /// The law's energy [J] at depth D [m].
  [[nodiscard]] constexpr S energy(S depth) const noexcept { return law_.energy(depth); }
  /// The law's D [m] at the force F [N], at rest.
  [[nodiscard]] constexpr S depth(S force) const noexcept { return law_.depth(force); }
  /// The law's largest stable depth [m].
  [[nodiscard]] constexpr S max_depth() const noexcept { return law_.max_depth(); }
  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }
  [[nodiscard]] constexpr const Law& law() const noexcept { return law_; }

 private:
  Law law_;
  Params p_;
};

static_assert(RateDependentForceLaw<DampedForce<LinearForce<float>>> &&
              RateDependentForceLaw<DampedForce<LinearForce<double>, Viscous>>);

}  // namespace palpate
