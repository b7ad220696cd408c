// SPDX-License-Identifier: MIT
#pragma once

/// @file Loads on an elastic half-space in closed form: point force (Boussinesq, Cerruti), stuck flat disc,
/// Hertz pressure. Everything times 4 pi mu; divide by it at the end.
///
/// m: unit normal into the body, r = x - contact, z = r.m, p = r - z m, R = |r|, f = f_t + f_n m the force.
///     u = f/R + r (f.r)/R^3 + (1-2 nu) v,
///     v = f_n (m/R - p/(R(R+z))) + f_t/(R+z) - p (f_t.p)/(R (R+z)^2) + m (f_t.p)/(R(R+z)),   div v = -2 f.r/R^3
/// The first part is twice Kelvin's solution at nu = 1/2 and does not know m. Source: [johnson1985], ch. 3.
///
/// A disc with the weight 1/(2 pi a sqrt(a^2 - s^2)): every harmonic function h(p, z) of the point solution
/// becomes (1/a) Im of its antiderivative in z, taken at z + i a (a point source at a complex place). With q
/// = z + i a, R = sqrt(p^2 + q^2), l = ln(R + q):
///     1/R -> phi = Im l / a,   ln(R+z) -> L = Im(q l - R) / a,   z ln(R+z) - R -> X = Im((q^2/2 - p^2/4) l - 3 q R/4) / a
///     normal:      u = f_n [ -z grad phi + (1 + (1-2 nu)) phi m - (1-2 nu) grad_p L ]
///     tangential:  u = 2 f phi - z grad_p d_f L + 2 nu grad_p d_f X + m [ -z d_f phi + (1-2 nu) d_f L ]

#include <palpate/core/float_vector.hpp>
#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>

namespace palpate {

/// Displacement times 4 pi mu at r of the point force f on the half-space's surface. r != 0. `regular` >= 0
/// [m^2] is added to R^2 (0: exact).
template <class T>
[[nodiscard]] inline Vec3<T> point_load(const Vec3<T>& r, const Vec3<T>& m, const Vec3<T>& f, T nu,
                                        T regular = T(0)) noexcept {
  const T R2 = r.squaredNorm() + regular, R = std::sqrt(R2), inverse = T(1) / R;
  Vec3<T> u = inverse * f + (f.dot(r) * inverse / R2) * r;
  const T b = T(1) - T(2) * nu;
  if (b > T(0)) {
    const T z = r.dot(m), fn = f.dot(m);
    const Vec3<T> p = r - z * m, ft = f - fn * m;
    // Over a hollow of the body R + z may vanish; there the closed form is bounded instead of exact.
    const T sum = (std::max)(R + z, T(0.1) * R), s1 = T(1) / sum, fp = ft.dot(p);
    u += b * (fn * (inverse * m - (inverse * s1) * p) + s1 * ft - (fp * inverse * s1 * s1) * p +
              (fp * inverse * s1) * m);
  }
  return u;
}

/// Traction on a plane with outward normal n at r, of the displacement above / (4 pi mu), with mu = 1.
[[nodiscard]] inline Mat3<double> point_load_traction(const Vec3<double>& r, const Vec3<double>& m,
                                                      const Vec3<double>& n, double nu) noexcept {
  using V = Vec3<double>;
  constexpr double pi = std::numbers::pi;
  const double R2 = r.squaredNorm(), R = std::sqrt(R2), R3 = R2 * R;
  Mat3<double> t = (-1.5 / pi * r.dot(n) / (R2 * R3)) * (r * r.transpose());  // columns: force directions
  const double b = 1 - 2 * nu;
  if (!(b > 0)) return t;
  // Strain of v by its gradient. A = 1/(R+z), a_i = dA/dx_i.
  const double z = r.dot(m), sum = (std::max)(R + z, 0.1 * R), A = 1 / sum, iR = 1 / R;
  const V p = r - z * m, e = r * iR;
  const Mat3<double> I = Mat3<double>::Identity(), P = I - m * m.transpose();
  const V dA = -(A * A) * (e + m), dR = -(iR * iR) * e;  // gradients of A and 1/R
  const V dB = A * dR + iR * dA;                         // of B = A/R
  const double B = A * iR, C = A * B;
  const V dC = A * dB + B * dA;
  for (int k = 0; k < 3; ++k) {
    const V f = V::Unit(k);
    const double fn = f.dot(m);
    const V ft = f - fn * m;
    const double fp = ft.dot(p);
    // G(i, j) = d v_i / d x_j
    const Mat3<double> G = fn * (m * dR.transpose() - p * dB.transpose() - B * P) + ft * dA.transpose() -
                           fp * (p * dC.transpose()) - C * (p * ft.transpose()) - (C * fp) * P +
                           m * (fp * dB + B * ft).transpose();
    t.col(k) += b * (f.dot(r) / (2 * pi * R3) * n + (G + G.transpose()) * n / (4 * pi));
  }
  return t;
}

namespace detail {
/// Four places at a time, for the tick's loops; the long ones take as many as a register holds.
using Lane = Float4;
inline constexpr std::uint32_t lane_size = entries<Lane>;
[[nodiscard]] PALPATE_INLINE Lane lane_at(const float* from) noexcept { return load_vector<Lane>(from); }

template <std::floating_point S>
[[nodiscard]] PALPATE_INLINE S root(S x) noexcept {
  return std::sqrt(x);
}
template <std::floating_point S>
[[nodiscard]] PALPATE_INLINE S magnitude(S x) noexcept {
  return std::abs(x);
}
/// atan2(y, x) for x >= 0, y >= 0, not both 0; in lanes to 2e-6 by a polynomial.
[[nodiscard]] PALPATE_INLINE double first_quadrant_angle(double y, double x) noexcept {
  return std::atan2(y, x);
}
template <class V>
  requires(!std::floating_point<V>)
[[nodiscard]] PALPATE_INLINE V first_quadrant_angle(const V& y, const V& x) noexcept {
  const V t = smaller(x, y) / larger(x, y), t2 = t * t;
  const V p = t * (0.99997726f +
                   t2 * (-0.33262347f +
                         t2 * (0.19354346f + t2 * (-0.11643287f + t2 * (0.05265332f - t2 * 0.01172120f)))));
  return y > x ? 1.57079633f - p : p;
}
/// asin(x) for 0 <= x <= 1, to 7e-5. Source: [abramowitz1964], 4.4.45.
template <class V>
[[nodiscard]] PALPATE_INLINE V arc_sine(const V& x) noexcept {
  return 1.57079633f -
         root(larger(1.f - x, V{})) * (1.5707288f + x * (-0.2121144f + x * (0.0742610f - 0.0187293f * x)));
}
}  // namespace detail

/// A disc of radius a seen from distance p off its axis and depth z >= 0. S: a real number or a lane of them;
/// F: a real number. Weights: stuck flat disc 1/(2 pi a sqrt(a^2-s^2)); Hertz 3 sqrt(a^2-s^2)/(2 pi a^3).
/// Every field is 4 pi mu u = in_plane p + normal m + along t, with t the tangential part of the load.
template <class S, class F = S>
class Disc {
 public:
  struct Field {
    S in_plane, normal, along;
  };

  PALPATE_INLINE Disc(const S& p2, const S& depth, F radius) noexcept : z_(depth), p2_(p2), a_(radius) {
    using detail::larger, detail::root, detail::magnitude;
    const S re = p2 + z_ * z_ - a_ * a_, im = F(2) * a_ * z_;
    const S modulus = root(re * re + im * im);  // |R|^2
    // The root's larger part by sum, the smaller from the product: no cancellation. At the rim R = 0 is held
    // off.
    const S rim = F(1e-4) * a_ + S{};
    const S large = larger(S(root(F(0.5) * (modulus + magnitude(re)))), rim), small = F(0.5) * im / large;
    R_.re = re >= S{} ? large : small;
    R_.im = large + small - R_.re;
    const C sum{R_.re + z_, R_.im + a_};
    angle_ = detail::first_quadrant_angle(sum.im, sum.re);
    const S d = F(1) / (sum.re * sum.re + sum.im * sum.im), r = F(1) / larger(modulus, S(rim * rim));
    w_ = {sum.re * d, -sum.im * d};
    iR_ = {R_.re * r, -R_.im * r};
    wR_ = w_ * iR_;
    ww_ = w_ * w_;
    wwR_ = ww_ * iR_;
  }

  /// Force with normal part fn; fp = t.p with t its tangential part. Flat disc's weight.
  [[nodiscard]] PALPATE_INLINE Field flat(F fn, const S& fp, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(1) / a_;
    const S L_p = -s * w_.im, X_p = F(-0.5) * s * (angle_ + z_ * w_.im + a_ * w_.re);
    return {s * (fn * (b * w_.im - z_ * wR_.im) - fp * (z_ * wwR_.im + nu * ww_.im)),
            s * (fn * ((F(1) + b) * angle_ - z_ * iR_.im) - fp * (b * w_.im + z_ * wR_.im)),
            F(2) * s * angle_ - z_ * L_p + F(2) * nu * X_p};
  }
  /// Normal force fn with Hertz's weight.
  [[nodiscard]] PALPATE_INLINE Field hertz(F fn, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi = s * ((F(0.5) * (z_ * z_ + a_ * a_) - F(0.25) * p2_) * angle_ - F(0.75) * z_ * R_.im +
                       F(0.25) * a_ * R_.re);
    S in_plane = -z_ * hertz_phi_p();
    if (b > F(0)) in_plane = in_plane - b * hertz_L_p();
    return {fn * in_plane, fn * ((F(1) + b) * phi - z_ * hertz_phi_z()), S{}};
  }
  /// Radial double force in the disc's plane, sum x.f = 1; weight minus half the gradient of Hertz's.
  [[nodiscard]] PALPATE_INLINE Field double_force(F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi_zp = s * (z_ * wR_.im - iR_.im), phi_zz = s * (angle_ - a_ * iR_.re);
    return {F(-0.5) * ((F(1) + b) * hertz_phi_p() + z_ * phi_zp), F(-0.5) * (z_ * phi_zz - b * hertz_phi_z()),
            S{}};
  }
  /// Normal forces with the moment sum x (f.m) = t, tp = t.p; weight minus the gradient of Hertz's. The part
  /// with 1 - 2 nu in the plane is left out where it is not worth its time, below 1 % of the field.
  [[nodiscard]] PALPATE_INLINE Field tilt(const S& tp, F nu) const noexcept {
    const F b = F(1) - F(2) * nu, s = F(3) / (a_ * a_ * a_);
    const S phi_p = hertz_phi_p(), phi_2 = s * (F(-0.5) * ww_.im - a_ * wwR_.re),
            phi_zp = s * (z_ * wR_.im - iR_.im);
    Field u{z_ * tp * phi_2, tp * (z_ * phi_zp - (F(1) + b) * phi_p), z_ * phi_p};
    if (b > F(0.03)) {
      u.in_plane = u.in_plane + b * tp * hertz_L_pp();
      u.along = u.along + b * hertz_L_p();
    }
    return u;
  }

  /// Forces s p in the disc's plane, s symmetric without trace, of the moment sum f x^T = s / 2; weight minus
  /// half the gradient of Hertz's. psp = p.s.p; `along` goes with s p.
  [[nodiscard]] PALPATE_INLINE Field shear(const S& psp, F nu) const noexcept {
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

  /// Forces around the disc's axis with the moment 1 about m: u = twist (m x p), for every nu. A rigid disc's
  /// weight.
  [[nodiscard]] PALPATE_INLINE S twist() const noexcept { return -hertz_phi_p(); }

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

/// How far a stuck flat disc on a half-space moves per force, times mu [1/m]: (1 - 2 nu) / (4 a ln(3 - 4 nu))
/// along the normal, (2 - nu) / (8 a) along the surface. Sources: [spence1968], [mindlin1949].
struct DiscCompliance {
  double normal, along;
};
[[nodiscard]] inline DiscCompliance disc_compliance(double radius, double nu) noexcept {
  const double b = 1 - 2 * nu;
  return {b > 1e-6 ? b / (4 * radius * std::log1p(2 * b)) : 1 / (8 * radius), (2 - nu) / (8 * radius)};
}

/// Twelve points of the unit disc, equal weights, for means with the stuck disc's weight: two rings, by
/// Gauss's rule in sqrt(1 - s^2), in which the weight is uniform.
[[nodiscard]] inline const std::array<std::array<double, 2>, 12>& disc_points() noexcept {
  static constexpr double h = 0.86602540378443865, r = 0.97741587937861918, q = 0.61481015937592787;
  static constexpr std::array<std::array<double, 2>, 12> points{{{r, 0},
                                                                 {0.5 * r, h * r},
                                                                 {-0.5 * r, h * r},
                                                                 {-r, 0},
                                                                 {-0.5 * r, -h * r},
                                                                 {0.5 * r, -h * r},
                                                                 {h * q, 0.5 * q},
                                                                 {0, q},
                                                                 {-h * q, 0.5 * q},
                                                                 {-h * q, -0.5 * q},
                                                                 {0, -q},
                                                                 {h * q, -0.5 * q}}};
  return points;
}

/// Depth z >= 0 below a disc of radius a under a surface that bends away from its plane: at r, outside, below
/// the plane of the disc's own edge (see contact_near.hpp), which is at most `sag` deep.
[[nodiscard]] inline double edge_depth(const Vec3<double>& r, const Vec3<double>& m, double a,
                                       double sag = (std::numeric_limits<double>::max)()) noexcept {
  const double z = r.dot(m), near2 = (std::min)(1.0, a * a / (std::max)(r.squaredNorm(), 1e-300));
  return (std::max)(z - (std::min)(z * near2, sag), 0.0);
}

/// 4 pi mu u at r of the force f spread over a stuck flat disc; m: unit normal into the body.
[[nodiscard]] inline Vec3<double> disc_load(const Vec3<double>& r, const Vec3<double>& m, double depth,
                                            double radius, const Vec3<double>& f, double nu) noexcept {
  const double fn = f.dot(m);
  const Vec3<double> p = r - r.dot(m) * m, t = f - fn * m;
  const auto u = Disc<double>(p.squaredNorm(), (std::max)(depth, 0.0), radius).flat(fn, t.dot(p), nu);
  return u.in_plane * p + u.normal * m + u.along * t;
}

}  // namespace palpate
