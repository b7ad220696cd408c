// SPDX-License-Identifier: MIT
#pragma once

/// @file  Decorator: caps a force law at a limit, smoothly.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>
#include <palpate/law/force/linear.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// A law that never asks for more than a limit.
///
///     F = law(D)                                  D <= D_k,  law(D_k) = a L
///     F = a L + k s - (k s)^2 / (4 w)             s = D - D_k <= 2 w / k,  w = (1 - a) L,  k = law'(D_k)
///     F = L                                       beyond max_depth() = D_k + 2 w / k
///
/// | symbol | name    | unit | range                                                                  |
/// |--------|---------|------|------------------------------------------------------------------------|
/// | L      | `limit` | N    | > 0                                                                    |
/// | a      | `knee`  |------| (0, 1), default 0.8 (chosen): part of L up to which F is the law's own |
///
/// A parabola joins the law and the limit with continuous slope (C1), zero at the limit; dF/dD jumps nowhere
/// that the law's does not, d2F/dD2 jumps at both ends. Force, tangent, energy and inverse are closed forms.
/// A law whose own maximum is within the limit is left as it is. Bad parameters, a law with zero stiffness at
/// the knee, or a limit whose depth leaves the scalar's range: SetupError. Does not cap a rate term: decorate
/// in this order, DampedForce<SaturatedForce<Law>>, and let the device's gate bound the total. No equation:
/// own choice; any C1 cap would do, this one has the simplest inverse.
template <ForceLaw Law>
class SaturatedForce {
  static_assert(!RateDependentForceLaw<Law>,
                "SaturatedForce would drop the rate term: write DampedForce<SaturatedForce<Law>> instead");
  static_assert(!StatefulForceLaw<Law>, "SaturatedForce would drop the law's state: saturate inside");

  using S = typename Law::Scalar;

 public:
  using Scalar = S;

  struct Params {
    S limit;          ///< L [N] > 0
    S knee = S(0.8);  ///< a [-] in (0, 1)
  };

  SaturatedForce(const Law& law, Params params)
      : law_(law), p_(params), max_depth_(law.max_depth()), knee_depth_(std::numeric_limits<S>::infinity()) {
    require_positive(p_.limit, "SaturatedForce", "limit [N] must be > 0 and finite");
    if (!is_finite(p_.knee) || !(p_.knee > S(0) && p_.knee < S(1))) {
      fail("SaturatedForce", "knee [-] must be in (0, 1)", static_cast<double>(p_.knee));
    }
    if (law_.force(law_.max_depth()) <= p_.limit) return;  // the law stays within the limit by itself
    knee_force_ = p_.knee * p_.limit;
    knee_depth_ = law_.depth(knee_force_);
    stiffness_ = law_.stiffness(knee_depth_);
    require_positive(stiffness_, "SaturatedForce",
                     "the law's stiffness [N/m] at the knee must be > 0 and finite");
    room_ = p_.limit - knee_force_;
    width_ = S(2) * (room_ / stiffness_);
    max_depth_ = knee_depth_ + width_;
    if (!is_positive(width_) || !is_finite(max_depth_)) {
      fail("SaturatedForce", "limit [N] has no depth within the scalar's range",
           static_cast<double>(p_.limit));
    }
    knee_energy_ = law_.energy(knee_depth_);
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth) const noexcept {
    if (!beyond_knee(depth)) return law_.force(depth);
    const S r = reached(depth);
    return knee_force_ + room_ * r * (S(2) - r);
  }
  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] S stiffness(S depth) const noexcept {
    return beyond_knee(depth) ? stiffness_ * (S(1) - reached(depth)) : law_.stiffness(depth);
  }
  /// Integral of F from 0 to D [J].
  [[nodiscard]] S energy(S depth) const noexcept {
    if (!beyond_knee(depth)) return law_.energy(depth);
    const S d = (std::min)(depth, max_depth_);
    const S r = reached(d);
    const S stored = knee_energy_ + (d - knee_depth_) * (knee_force_ + room_ * r * (S(1) - r / S(3)));
    return depth > max_depth_ ? stored + p_.limit * (depth - max_depth_) : stored;
  }
  /// D [m] at the force F [N]; max_depth() where F >= the limit.
  [[nodiscard]] S depth(S force) const noexcept {
    if (!is_positive(force) || !is_finite(knee_depth_) || !(force > knee_force_)) return law_.depth(force);
    if (!(force < p_.limit)) return max_depth_;
    const S y = (force - knee_force_) / room_;
    const S r = y / (S(1) + std::sqrt(S(1) - y));  // 1 - sqrt(1 - y) without its cancellation
    return knee_depth_ + r * width_;
  }
  /// Depth [m] at which the limit is reached; the law's own where it never is.
  [[nodiscard]] S max_depth() const noexcept { return max_depth_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }
  [[nodiscard]] const Law& law() const noexcept { return law_; }

 private:
  bool beyond_knee(S depth) const noexcept { return is_positive(depth) && depth > knee_depth_; }
  // How far from the knee to the limit, 0 to 1.
  S reached(S depth) const noexcept { return (std::min)((depth - knee_depth_) / width_, S(1)); }

  Law law_;
  Params p_;
  S max_depth_;
  S knee_depth_;
  S knee_force_ = S(0);
  S knee_energy_ = S(0);
  S stiffness_ = S(0);
  S room_ = S(0);
  S width_ = S(0);  // of the parabola [m]
};

static_assert(ForceLaw<SaturatedForce<LinearForce<float>>> && ForceLaw<SaturatedForce<LinearForce<double>>>);

}  // namespace palpate
