// SPDX-License-Identifier: MIT
#pragma once

/// @file Point force on the surface of an elastic half-space in closed form (Boussinesq, Cerruti). Every
/// displacement is multiplied by 4 pi mu; divide by it at the end.
///
///     u = f/R + r (f.r)/R^3 + (1-2 nu) v,
///     v = f_n (m/R - p/(R(R+z))) + f_t/(R+z) - p (f_t.p)/(R (R+z)^2) + m (f_t.p)/(R(R+z)),
///     div v = -2 f.r/R^3
///
/// | symbol    | name                                                           | unit |
/// |-----------|----------------------------------------------------------------|------|
/// | f; f_n, f_t | force; its part along m, its tangential part                 | N    |
/// | m         | unit normal into the body                                      | -    |
/// | r; R      | from the force to the point; its length                        | m    |
/// | z, p      | depth r.m of the point; r - z m                                | m    |
///
/// The first part is twice Kelvin's solution at nu = 1/2 and does not contain m. Source: [johnson1985], ch.
/// 3.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {

/// 4 pi mu u [N/m] at r != 0 of the point force f on the half-space's surface.
template <class T>
[[nodiscard]] inline Vec3<T> point_load(const Vec3<T>& r, const Vec3<T>& m, const Vec3<T>& f, T nu) noexcept {
  const T R2 = r.squaredNorm(), R = std::sqrt(R2), inverse = T(1) / R;
  Vec3<T> u = inverse * f + (f.dot(r) * inverse / R2) * r;
  const T b = T(1) - T(2) * nu;
  if (b > T(0)) {
    const T z = r.dot(m), fn = f.dot(m);
    const Vec3<T> p = r - z * m, ft = f - fn * m;
    // Above a hollow of the body R + z may vanish: from a tenth of R (chosen) on it is bounded, not exact.
    const T sum = (std::max)(R + z, T(0.1) * R), s1 = T(1) / sum, fp = ft.dot(p);
    u += b * (fn * (inverse * m - (inverse * s1) * p) + s1 * ft - (fp * inverse * s1 * s1) * p +
              (fp * inverse * s1) * m);
  }
  return u;
}

/// Traction [1/m^2] at r on a plane with outward normal n, by a unit force along each axis (columns), mu = 1.
[[nodiscard]] inline Mat3<double> point_load_traction(const Vec3<double>& r, const Vec3<double>& m,
                                                      const Vec3<double>& n, double nu) noexcept {
  using V = Vec3<double>;
  constexpr double pi = std::numbers::pi;
  const double R2 = r.squaredNorm(), R = std::sqrt(R2), R3 = R2 * R;
  Mat3<double> t = (-1.5 / pi * r.dot(n) / (R2 * R3)) * (r * r.transpose());  // columns: force directions
  const double b = 1 - 2 * nu;
  if (!(b > 0)) return t;
  // Strain of v by its gradient. A = 1/(R+z), a_i = dA/dx_i; R + z is bounded as in point_load().
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

}  // namespace palpate
