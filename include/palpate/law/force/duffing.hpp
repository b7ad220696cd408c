// SPDX-License-Identifier: MIT
#pragma once

/// @file  Duffing force law, eq. (3): a linear spring that stiffens or softens with depth. The default law.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

namespace palpate {

namespace detail {
/// Cube root of x > 0 within 3.2 %: a third of the exponent, and of the mantissa on a chord. The constants
/// are two thirds of the exponent's bias, less what makes the errors above and below equal.
template <Real S>
[[nodiscard]] inline S rough_cbrt(S x) noexcept {
  if (x < (std::numeric_limits<S>::min)()) return std::cbrt(x);  // has no exponent
  if constexpr (std::same_as<S, float>) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) / 3 + 0x2a510800u);
  } else if constexpr (sizeof(S) == sizeof(double)) {
    return std::bit_cast<S>(std::bit_cast<std::uint64_t>(x) / 3 + 0x2a9f760000000000u);
  } else {
    return std::cbrt(x);
  }
}
}  // namespace detail

/// Contact force of a Duffing spring.
///
///     F = c1 D + c3 D^3                            (3)    0 for D <= 0
///     dF/dD = c1 + 3 c3 D^2,   energy = c1 D^2 / 2 + c3 D^4 / 4
///
/// | symbol | name     | unit  | range                                            |
/// |--------|----------|-------|--------------------------------------------------|
/// | D      | argument | m     | any; D <= 0 and NaN give 0                       |
/// | c1     | `c1`     | N/m   | >= 0; > 0 unless c3 > 0                          |
/// | c3     | `c3`     | N/m^3 | any; > 0 stiffens, < 0 softens                   |
///
/// Softening is stable only for D < D_max = sqrt(c1 / (3 |c3|)); from there on the force stays at
/// F_max = (2/3) c1 D_max and dF/dD is 0. dF/dD jumps from 0 to c1 at D = 0.
/// The coefficients belong to the object, not to the tool's mass. Bad parameters: SetupError.
/// The inverse is within 2.5 epsilon of the exact root over the whole range, up to the fold D_max; a
/// subnormal F gives as many digits as it has. -ffast-math costs up to half the digits towards the fold.
/// Does not model: rate dependence (DampedForce), memory, size of the contact area.
/// Source: [luo2005] eqs. (1)-(3); [kovacic2011]. How (3) differs from the oscillator (1): docs/laws.md.
template <Real S>
class DuffingForce {
 public:
  using Scalar = S;

  struct Params {
    S c1;         ///< [N/m] >= 0
    S c3 = S(0);  ///< [N/m^3]
  };

  /// The paper's parameters, as plain numbers of a system of units that `length_unit` and `force_unit` name.
  struct Oscillator {
    S mass;                   ///< m [kg]
    S omega0;                 ///< omega_0 [1/s]
    S beta0_squared_epsilon;  ///< beta_0^2 epsilon [1/(s^2 length_unit^2)]; < 0 softens
    S length_unit;            ///< unit of D [m]: 1e-3 for the paper's millimetres, 1 for SI
    S force_unit = S(1);      ///< unit in which m omega_0^2 D comes out [N]; see from_oscillator
    S factor = S(0.75);       ///< of the cubic term [-]: 3/4 as in (3), 1 for the exact static root of (1)
  };

  explicit DuffingForce(const Params& params) : p_(params) {
    require_non_negative(p_.c1, "DuffingForce", "c1 [N/m] must be >= 0 and finite");
    require_finite(p_.c3, "DuffingForce", "c3 [N/m^3] must be finite");
    if (p_.c1 == S(0) && !(p_.c3 > S(0))) {
      fail("DuffingForce", "c3 [N/m^3] must be > 0 where c1 [N/m] is 0", static_cast<double>(p_.c3));
    }
    if (p_.c3 < S(0)) find_fold();
  }

  /// Eq. (3) from the paper's parameters; l = length_unit, f = force_unit, g = factor:
  ///
  ///     c1 = m omega_0^2 f / l,   c3 = g m beta_0^2 epsilon f / l^3
  ///
  /// The paper gives m = 1, omega_0 = 0.2, beta_0^2 epsilon = 0.4 with D in millimetres and reads the result
  /// in newtons: F [N] = 0.04 D + 0.3 D^3, so c1 = 40 N/m and c3 = 3e8 N/m^3. That is force_unit = 1, the
  /// default. Dimensionally, kg mm/s^2 is a millinewton; whoever means that sets force_unit = length_unit.
  /// g: (3) has 3/4, the amplitude relation of harmonic balance; a constant load on (1) settles at g = 1.
  [[nodiscard]] static DuffingForce from_oscillator(const Oscillator& o) {
    require_positive(o.mass, "DuffingForce::from_oscillator", "mass [kg] must be > 0 and finite");
    require_positive(o.length_unit, "DuffingForce::from_oscillator",
                     "length_unit [m] must be > 0 and finite");
    require_positive(o.force_unit, "DuffingForce::from_oscillator", "force_unit [N] must be > 0 and finite");
    require_positive(o.factor, "DuffingForce::from_oscillator", "factor [-] must be > 0 and finite");
    const S stiffness = o.force_unit / o.length_unit;
    const S cubic = o.factor * o.mass * o.beta0_squared_epsilon;
    return DuffingForce(
        {o.mass * o.omega0 * o.omega0 * stiffness, cubic * stiffness / o.length_unit / o.length_unit});
  }

  /// Least-squares cubics (in F, over 0 <= D <= depth [m]) of laws with the force F(depth) = force [N]. The
  /// worst error is stated as a share of `force`. No equation: own derivation, docs/laws.md.
  /// This one: F ~ D^(3/2), sphere; 3.9 %.
  [[nodiscard]] static DuffingForce hertz_fit(S depth, S force) {
    return fit(S(45) / S(77), S(5) / S(11), depth, force);
  }
  /// As hertz_fit, for F ~ D^2, cone or deep indentation; 4.2 %.
  [[nodiscard]] static DuffingForce parabolic_fit(S depth, S force) {
    return fit(S(5) / S(16), S(35) / S(48), depth, force);
  }
  /// As hertz_fit, for F ~ exp(3 D / depth) - 1, mildly stiffening tissue after Fung; 3.4 %.
  [[nodiscard]] static DuffingForce fung_fit(S depth, S force) {
    return fit(S(0.152246), S(0.813704), depth, force);
  }

  /// Eq. (3): F [N] at depth D [m].
  [[nodiscard]] S force(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    if (!(depth < max_depth_)) return max_force_;
    // In this order no product leaves the range between c3 and F.
    return (std::min)(depth * (p_.c1 + (p_.c3 * depth) * depth), max_force_);
  }

  /// Eq. (3) at several depths in [0, max_depth()] at once; `V` adds and multiplies as a number does.
  template <class V>
  [[nodiscard]] V forces(const V& depth) const noexcept {
    return depth * (p_.c1 + (p_.c3 * depth) * depth);
  }

  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] S stiffness(S depth) const noexcept {
    if (!is_positive(depth) || !(depth < max_depth_)) return S(0);
    return (std::max)(p_.c1 + S(3) * ((p_.c3 * depth) * depth), S(0));
  }

  /// Integral of F from 0 to D [J].
  [[nodiscard]] S energy(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    depth = (std::min)(depth, (std::numeric_limits<S>::max)());  // 0 times infinity would be NaN
    const S d = (std::min)(depth, max_depth_);
    const S stored = d * (d * (p_.c1 / S(2) + (p_.c3 / S(4) * d) * d));
    return depth > d ? stored + max_force_ * (depth - d) : stored;
  }

  /// D [m] at the force F [N]: the inverse of (3). max_depth() where F >= max_force().
  [[nodiscard]] S depth(S force) const noexcept {
    if (!is_positive(force)) return S(0);
    if (!(force < max_force_)) return max_depth_;
    if (p_.c3 == S(0)) return force / p_.c1;
    // Above 3/4 of F_max (chosen) the distance to the fold has more digits than D.
    if (p_.c3 < S(0) && force > S(0.75) * max_force_) return depth_near_fold(force);
    // D = D0 y with a y + b y^3 = 1. D0 is the min of the roots of the linear and of the cubic law alone, the
    // cubic one within 3.2 %. The root y lies in [0.66, 1.14], a and b are of order 1 at most, and the fitted
    // polynomials below are within 2.7 % of it. Two of Halley's steps, of cubic convergence, do the rest. a
    // and b come from the rounded D0, so its error does not count.
    S start = per_c1_ <= (std::numeric_limits<S>::max)() ? force * per_c1_
              : p_.c1 > S(0)                             ? force / p_.c1  // subnormal
                                                         : std::numeric_limits<S>::infinity();
    bool linear = true;
    if (p_.c3 > S(0)) {
      const S cubic = detail::rough_cbrt(force) * per_cbrt_c3_;
      linear = start < cubic;
      start = (std::min)(start, cubic);
    }
    if (!(start > S(0) && start <= (std::numeric_limits<S>::max)())) return start;  // out of the range
    // Products may exceed F a little; halved coefficients have the same root.
    const S half = force > (std::numeric_limits<S>::max)() / S(2) ? S(0.5) : S(1), F = half * force;
    const S a = p_.c1 * (half * start) / F;  // half of a subnormal c1 or c3 may be 0
    const S b = p_.c3 * (half * start) * start * start / F;
    S y = linear ? S(1.0103) + b * (S(-0.8353) + b * (S(0.8643) - b * S(0.3541)))  // a = 1
                 : (S(0.9979) - S(0.319) * a) * (S(1) - (b - S(1)) / S(3));        // b = 1
    constexpr int steps = std::numeric_limits<S>::digits > 53 ? 3 : 2;
    for (int i = 0; i < steps; ++i) {
      y = halley(y, a * y + b * (y * y) * y - S(1), a + S(3) * b * (y * y), S(6) * b * y);
    }
    return start * y;
  }

  /// D_max [m] of the stable branch; infinity unless softening.
  [[nodiscard]] S max_depth() const noexcept { return max_depth_; }
  /// F_max = F(D_max) [N]; infinity unless softening.
  [[nodiscard]] S max_force() const noexcept { return max_force_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 protected:
  struct Known {};
  /// Of parameters that are known to be good; where it softens, depth() has half the digits next to the fold.
  DuffingForce(const Params& params, Known) noexcept : p_(params) {
    if (!(p_.c3 < S(0))) return;
    max_depth_ = std::sqrt(p_.c1 / (S(-3) * p_.c3));
    max_force_ = S(2) / S(3) * p_.c1 * max_depth_;
  }

 private:
  static DuffingForce fit(S k1, S k3, S depth, S force) {
    require_positive(depth, "DuffingForce fit", "depth [m] must be > 0 and finite");
    require_positive(force, "DuffingForce fit", "force [N] must be > 0 and finite");
    return DuffingForce({k1 * (force / depth), k3 * (force / depth / depth / depth)});
  }

  static S halley(S x, S f, S f1, S f2) noexcept { return x - S(2) * f * f1 / (S(2) * f1 * f1 - f * f2); }

  // Near the fold D depends on F_max - F alone, so F_max is needed beyond working precision: max_force_ +
  // rest_. The mantissas are worked on, so nothing overflows, and a change of units by a power of 2 is exact.
  void find_fold() {
    int e1 = 0, e3 = 0;
    S m1 = std::frexp(p_.c1, &e1);
    const S m3 = std::frexp(-p_.c3, &e3);
    if ((e1 - e3) % 2 != 0) {
      m1 *= S(2);
      --e1;
    }
    const S t = S(3) * m3, t_rest = std::fma(S(3), m3, -t);
    const S d = std::sqrt(m1 / t);
    const S dd = d * d, dd_rest = std::fma(d, d, -dd);
    const S tdd = t * dd, tdd_rest = std::fma(t, dd, -tdd) + (t * dd_rest + t_rest * dd);
    const S d_error = ((m1 - tdd) - tdd_rest) / (S(2) * m1);  // D_max = d (1 + d_error)
    const S h = S(2) * m1 * d, h_rest = std::fma(S(2) * m1, d, -h);
    const S third = h / S(3);
    const S third_rest = (std::fma(S(-3), third, h) + h_rest) / S(3) + third * d_error;
    const S f = third + third_rest;
    const int e = (e1 - e3) / 2;
    max_depth_ = std::ldexp(d, e);
    max_force_ = std::ldexp(f, e1 + e);
    max_force_rest_ = std::ldexp((third - f) + third_rest, e1 + e);
  }

  // With D = D_max (1 - e): (F_max - F) / F_max = e^2 (3 - e) / 2. For e = k z, k^2 = (2/3) of that:
  // z^2 - (k/3) z^3 = 1, z in [1, 1.09].
  S depth_near_fold(S force) const noexcept {
    const S missing = (std::max)(((max_force_ - force) + max_force_rest_) / max_force_, S(0));
    const S k = std::sqrt(missing * S(2) / S(3));
    S z = S(1);
    for (int i = 0; i < 3; ++i) {
      z = halley(z, (z * z) * (S(1) - k * z / S(3)) - S(1), z * (S(2) - k * z), S(2) - S(2) * k * z);
    }
    return max_depth_ * (S(1) - k * z);
  }

  Params p_;
  S per_c1_ = S(1) / std::abs(p_.c1), per_cbrt_c3_ = S(1) / std::cbrt(p_.c3);  // c1 may be -0
  S max_depth_ = std::numeric_limits<S>::infinity();
  S max_force_ = std::numeric_limits<S>::infinity();
  S max_force_rest_ = S(0);
};

static_assert(ForceLaw<DuffingForce<float>> && ForceLaw<DuffingForce<double>>);

}  // namespace palpate
