// SPDX-License-Identifier: MIT
#pragma once

/// @file Loads that are spread over a disc on an elastic half-space, in closed form: bonded flat punch,
/// Hertz's pressure, force dipole, bending and torsional couple. Every displacement is multiplied by 4 pi mu.
///
/// The flat punch's weight is 1/(2 pi a sqrt(a^2 - s^2)). With it, every harmonic function h(p, z) of the
/// point force's solution (point_load.hpp) becomes (1/a) Im of its antiderivative in z, taken at z + i a: a
/// point source at a complex depth. With q = z + i a, R = sqrt(p^2 + q^2), l = ln(R + q):
///     1/R -> phi = Im l / a,   ln(R+z) -> L = Im(q l - R) / a,
///     z ln(R+z) - R -> X = Im((q^2/2 - p^2/4) l - 3 q R/4) / a
///     normal force:      u = f_n [ -z grad phi + (1 + (1-2 nu)) phi m - (1-2 nu) grad_p L ]
///     tangential force:  u = 2 f phi - z grad_p d_f L + 2 nu grad_p d_f X
///                            + m [ -z d_f phi + (1-2 nu) d_f L ]
/// Hertz's weight 3 sqrt(a^2 - s^2)/(2 pi a^3) is an integral over discs; the dipole and the couples are
/// derivatives of Hertz's field. Own derivation from [johnson1985], ch. 3; tested against direct integration.

#include <palpate/core/simd.hpp>
#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>

namespace palpate {

namespace detail {
/// atan2(y, x) for x >= 0, y >= 0, not both 0; of a Simd by an odd polynomial of degree 11,
/// error below 2e-6.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V first_quadrant_angle(const V& y, const V& x) noexcept {
  if constexpr (Real<V>) {
    return std::atan2(y, x);
  } else {
    const V t = (min)(x, y) / (max)(x, y), t2 = t * t;
    const V p = t * (0.99997726f +
                     t2 * (-0.33262347f +
                           t2 * (0.19354346f + t2 * (-0.11643287f + t2 * (0.05265332f - t2 * 0.01172120f)))));
    return select(y > x, 1.57079633f - p, p);
  }
}
/// asin(x) for 0 <= x <= 1, error below 7e-5. Source: [abramowitz1964], 4.4.45.
template <SimdOrReal V>
[[nodiscard]] PALPATE_INLINE V arc_sine(const V& x) noexcept {
  return 1.57079633f -
         sqrt((max)(1.f - x, V{})) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - 0.0187293f * x)));
}
}  // namespace detail

/// A loaded disc of radius a, seen from the distance p off its axis and the depth z >= 0 [m]. S: a number or
/// a SIMD vector of them; F: a number. Every field is 4 pi mu u = in_plane p + normal m + along t, with t the
/// tangential part of the load.
template <class S, class F = S>
class Disc {
 public:
  struct Field {
    S in_plane, normal, along;
  };

  PALPATE_INLINE Disc(const S& p2, const S& depth, F radius) noexcept : z_(depth), p2_(p2), a_(radius) {
    using detail::abs, detail::select, detail::sqrt;
    const S re = p2 + z_ * z_ - a_ * a_, im = F(2) * a_ * z_;
    const S modulus = sqrt(re * re + im * im);  // |R|^2
    // The root's larger part by a sum, the smaller from the product: no cancellation. At the rim R = 0, which
    // 1e-4 of the radius replaces: far below what a mesh resolves, far above float's rounding.
    const S rim = F(1e-4) * a_ + S{};
    const S large = (detail::max)(sqrt(S(F(0.5) * (modulus + abs(re)))), rim), small = F(0.5) * im / large;
    R_.re = select(re >= S{}, large, small);
    R_.im = large + small - R_.re;
    const C sum{R_.re + z_, R_.im + a_};
    angle_ = detail::first_quadrant_angle(sum.im, sum.re);
    const S d = F(1) / (sum.re * sum.re + sum.im * sum.im), r = F(1) / (detail::max)(modulus, S(rim * rim));
    w_ = {sum.re * d, -sum.im * d};
    iR_ = {R_.re * r, -R_.im * r};
    wR_ = w_ * iR_;
    ww_ = w_ * w_;
    wwR_ = ww_ * iR_;
  }

  /// Force on a bonded flat punch, normal part fn; fp = t.p with t the tangential part. Flat punch's weight.
  [[nodiscard]] PALPATE_INLINE Field flat_punch(F fn, const S& fp, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(1) / a_;
    const S L_p = -s * w_.im, X_p = F(-0.5) * s * (angle_ + z_ * w_.im + a_ * w_.re);
    return {s * (fn * (b * w_.im - z_ * wR_.im) - fp * (z_ * wwR_.im + nu * ww_.im)),
            s * (fn * ((F(1) + b) * angle_ - z_ * iR_.im) - fp * (b * w_.im + z_ * wR_.im)),
            F(2) * s * angle_ - z_ * L_p + F(2) * nu * X_p};
  }
  /// Normal force fn with the weight of Hertz's pressure.
  [[nodiscard]] PALPATE_INLINE Field hertz(F fn, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi = s * ((F(0.5) * (z_ * z_ + a_ * a_) - F(0.25) * p2_) * angle_ - F(0.75) * z_ * R_.im +
                       F(0.25) * a_ * R_.re);
    S in_plane = -z_ * hertz_phi_p();
    if (b > F(0)) in_plane = in_plane - b * hertz_L_p();
    return {fn * in_plane, fn * ((F(1) + b) * phi - z_ * hertz_phi_z()), S{}};
  }
  /// Radial force dipole in the disc's plane, sum x.f = 1. Weight: minus half the gradient of Hertz's.
  [[nodiscard]] PALPATE_INLINE Field force_dipole(F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi_zp = s * (z_ * wR_.im - iR_.im), phi_zz = s * (angle_ - a_ * iR_.re);
    return {F(-0.5) * ((F(1) + b) * hertz_phi_p() + z_ * phi_zp), F(-0.5) * (z_ * phi_zz - b * hertz_phi_z()),
            S{}};
  }
  /// Bending couple: normal forces with the moment sum x (f.m) = t, tp = t.p. Weight: minus the gradient of
  /// Hertz's. Below b = 1 - 2 nu = 0.03 the in-plane part with b is left out: it is less than 1 % of the
  /// field.
  [[nodiscard]] PALPATE_INLINE Field bending_couple(const S& tp, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi_p = hertz_phi_p(), phi_2 = s * (F(-0.5) * ww_.im - a_ * wwR_.re),
            phi_zp = s * (z_ * wR_.im - iR_.im);
    Field u{z_ * tp * phi_2, tp * (z_ * phi_zp - (F(1) + b) * phi_p), z_ * phi_p};
    if (b > F(0.03)) {  // see above
      u.in_plane = u.in_plane + b * tp * hertz_L_pp();
      u.along = u.along + b * hertz_L_p();
    }
    return u;
  }
  /// Shear dipole: forces s p in the disc's plane, s symmetric without trace, of the moment sum f x^T = s /
  /// 2. Weight: minus half the gradient of Hertz's. psp = p.s.p; `along` multiplies s p.
  [[nodiscard]] PALPATE_INLINE Field shear_dipole(const S& psp, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const C w3 = ww_ * w_, w4 = ww_ * ww_, w3R = w3 * iR_;
    // (1/p d/dp)^2 and ^3 of L, X and phi with Hertz's weight.
    const S L_2 = hertz_L_pp(), L_3 = -s * (w3.im / F(3) + a_ * w3R.re),
            X_2 = s * (F(0.125) * (angle_ - F(2) / F(3) * p2_ * ww_.im - p2_ * p2_ * w4.im / F(12)) -
                       F(0.25) * a_ * (w_.re + p2_ * w3.re / F(3))),
            X_3 = s * (ww_.im / F(12) + p2_ * w4.im / F(24) + a_ * w3.re / F(3)),
            phi_2 = s * (F(-0.5) * ww_.im - a_ * wwR_.re);
    return {psp * (F(0.5) * z_ * L_3 - nu * X_3), F(0.5) * psp * (z_ * phi_2 - b * L_2),
            z_ * L_2 - hertz_phi_p() - F(2) * nu * X_2};
  }
  /// Torsional couple 1 about m, with the weight of a rigid disc: 4 pi mu u = this (m x p), for every nu.
  [[nodiscard]] PALPATE_INLINE S torsional_couple() const noexcept { return -hertz_phi_p(); }

 private:
  struct C {
    S re, im;
    [[nodiscard]] PALPATE_INLINE C operator*(const C& o) const noexcept {
      return {re * o.re - im * o.im, re * o.im + im * o.re};
    }
    [[nodiscard]] PALPATE_INLINE C operator+(const C& o) const noexcept { return {re + o.re, im + o.im}; }
  };
  [[nodiscard]] PALPATE_INLINE S hertz_phi_p() const noexcept {  // d phi / dp / p
    return F(1.5) / (a_ * a_ * a_) * (a_ * w_.re - angle_ - z_ * w_.im);
  }
  [[nodiscard]] PALPATE_INLINE S hertz_L_p() const noexcept {  // likewise of L
    const C q{z_, S{} + a_}, sum = R_ * R_ + R_ * q + q * q;
    return F(3) / (a_ * a_ * a_) *
           (F(-0.5) * (z_ * angle_ - R_.im) - (w_ * sum).im / F(6) + F(0.5) * a_ * (q * w_).re);
  }
  [[nodiscard]] PALPATE_INLINE S hertz_L_pp() const noexcept {  // (1/p d/dp)^2 of L
    const C w3 = ww_ * w_;
    return F(3) / (a_ * a_ * a_) * (F(0.25) * (w_.im + p2_ * w3.im / F(3)) + F(0.5) * a_ * ww_.re);
  }
  [[nodiscard]] PALPATE_INLINE S hertz_phi_z() const noexcept {
    return F(3) / (a_ * a_ * a_) * (z_ * angle_ - R_.im);
  }

  S z_, p2_, angle_;
  F a_;
  C R_, w_, iR_, wR_, ww_, wwR_;  // R, 1/(R + q), 1/R, and products
};

/// Depth z >= 0 [m] of the point r below a disc of radius a whose surface bends away from the tangent plane:
/// below the plane of the disc's own edge, which for a quadric lies z (a/r)^2 below the tangent plane. The
/// edge is at most `sagitta` deep: the side of a block lies below its top by all of z.
[[nodiscard]] inline double edge_depth(const Vec3<double>& r, const Vec3<double>& m, double a,
                                       double sagitta = (std::numeric_limits<double>::max)()) noexcept {
  // 1e-300: r = 0 is not divided by.
  const double z = r.dot(m), near2 = (std::min)(1.0, a * a / (std::max)(r.squaredNorm(), 1e-300));
  return (std::max)(z - (std::min)(z * near2, sagitta), 0.0);
}

}  // namespace palpate
