// SPDX-License-Identifier: MIT
#pragma once

/// @file  Power-law force: Hertz's sphere, Sneddon's cone.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace palpate {

/// Contact force of a rigid indenter on an elastic half-space.
///
///     F = k D^p,   dF/dD = p k D^(p-1),   energy = k D^(p+1) / (p+1)      (0 for D <= 0)
///
/// | symbol | name     | unit  | range                                           |
/// |--------|----------|-------|-------------------------------------------------|
/// | D      | argument | m     | any; D <= 0 and NaN give 0                      |
/// | k      | `k`      | N/m^p | > 0                                             |
/// | p      | `p`      | -     | [1, 10]: sphere 3/2, cone 2                     |
///
/// dF/dD tends to 0 at D = 0 for p > 1 and to k for p = 1. p < 1 is refused: its stiffness at 0 is infinite.
/// Bad parameters: SetupError. Does not model: adhesion, large depth (Hertz holds for D well below R), finite
/// bodies. No equation of the paper; sources: [hertz1882], [sneddon1965], [johnson1985].
template <Real S>
class PowerLawForce {
 public:
  using Scalar = S;

  struct Params {
    S k;  ///< [N/m^p] > 0
    S p;  ///< exponent [-] in [1, 10]
  };

  explicit PowerLawForce(const Params& params) : p_(params) {
    require_positive(p_.k, "PowerLawForce", "k [N/m^p] must be > 0 and finite");
    if (!is_finite(p_.p) || !(p_.p >= S(1) && p_.p <= S(10))) {
      fail("PowerLawForce", "p [-] must be in [1, 10]", static_cast<double>(p_.p));
    }
  }

  /// Rigid sphere of radius R [m] on a half-space: F = (4/3) E/(1-nu^2) sqrt(R) D^(3/2) [hertz1882].
  /// E [Pa] > 0, nu in (-1, 1/2].
  [[nodiscard]] static PowerLawForce hertz_sphere(S young, S poisson, S radius) {
    require_positive(radius, "PowerLawForce::hertz_sphere", "radius [m] must be > 0 and finite");
    return PowerLawForce({S(4) / S(3) * plane_modulus(young, poisson) * std::sqrt(radius), S(1.5)});
  }

  /// Rigid cone on a half-space: F = (2/pi) E/(1-nu^2) tan(alpha) D^2 [sneddon1965]; alpha [rad] in (0, pi/2)
  /// is the half-opening angle. E [Pa] > 0, nu in (-1, 1/2].
  [[nodiscard]] static PowerLawForce cone(S young, S poisson, S half_angle) {
    if (!is_finite(half_angle) || !(half_angle > S(0) && half_angle < std::numbers::pi_v<S> / S(2))) {
      fail("PowerLawForce::cone", "half_angle [rad] must be in (0, pi/2)", static_cast<double>(half_angle));
    }
    const S slope = std::tan(half_angle);
    return PowerLawForce({S(2) / std::numbers::pi_v<S> * plane_modulus(young, poisson) * slope, S(2)});
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth) const noexcept {
    return is_positive(depth) ? p_.k * std::pow(depth, p_.p) : S(0);
  }
  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] S stiffness(S depth) const noexcept {
    return is_positive(depth) ? p_.k * (p_.p * std::pow(depth, p_.p - S(1))) : S(0);
  }
  /// Integral of F from 0 to D [J].
  [[nodiscard]] S energy(S depth) const noexcept {
    return is_positive(depth) ? p_.k * std::pow(depth, p_.p) * depth / (p_.p + S(1)) : S(0);
  }
  /// D [m] at the force F [N].
  [[nodiscard]] S depth(S force) const noexcept {
    if (!is_positive(force)) return S(0);
    // The rounded exponent 1/p costs |ln(F/k)| ulp; one Newton step takes them back.
    const S start = std::pow(force / p_.k, S(1) / p_.p);
    const S ratio = p_.k * std::pow(start, p_.p) / force;
    return is_finite(ratio) && ratio > S(0) ? start - start * (ratio - S(1)) / p_.p : start;
  }
  /// No limit: infinity.
  [[nodiscard]] S max_depth() const noexcept { return std::numeric_limits<S>::infinity(); }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static S plane_modulus(S young, S poisson) {
    require_positive(young, "PowerLawForce", "Young's modulus [Pa] must be > 0 and finite");
    if (!is_finite(poisson) || !(poisson > S(-1) && poisson <= S(0.5))) {
      fail("PowerLawForce", "Poisson's ratio [-] must be in (-1, 1/2]", static_cast<double>(poisson));
    }
    return young / (S(1) - poisson * poisson);
  }

  Params p_;
};

static_assert(ForceLaw<PowerLawForce<float>> && ForceLaw<PowerLawForce<double>>);

}  // namespace palpate
