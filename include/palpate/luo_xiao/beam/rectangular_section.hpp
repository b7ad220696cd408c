// SPDX-License-Identifier: MIT
#pragma once

/// @file  Rectangular cross-section with its exact flexure stresses (V.A.1).

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/beam/concept.hpp>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace palpate {

namespace detail {

/// Dilogarithm Li2(w) = sum w^n / n^2 for |w| <= 1: Bernoulli series in u = -log(1 - w), after reflection of
/// the half Re w > 1/2 to the other. To rounding in double. Source: [lewin1981].
template <Real S>
[[nodiscard]] inline std::complex<S> dilogarithm(std::complex<S> w) noexcept {
  constexpr S pi = std::numbers::pi_v<S>;
  if (w.real() > S(0.5)) {
    const std::complex<S> v = S(1) - w;
    if (std::abs(v) < (std::numeric_limits<S>::min)()) return pi * pi / S(6);
    return pi * pi / S(6) - std::log(w) * std::log(v) - dilogarithm(v);  // Re v < 1/2: once
  }
  // B_2k / (2k+1)!
  constexpr S c[] = {S(2.777777777777777777778e-2L),  S(-2.777777777777777777778e-4L),
                     S(4.724111866969009826153e-6L),  S(-9.185773074661963550852e-8L),
                     S(1.897886998897099907201e-9L),  S(-4.064761645144225526806e-11L),
                     S(8.921691020456452555218e-13L), S(-1.993929586072107568724e-14L),
                     S(4.518980029619918191651e-16L), S(-1.035651761218124701448e-17L)};
  const std::complex<S> u = -std::log(S(1) - w), u2 = u * u;
  std::complex<S> tail = S(0);
  for (int k = 9; k >= 0; --k) tail = (tail + c[k]) * u2;
  return u * (S(1) + tail) - u2 / S(4);
}

}  // namespace detail

/// Rectangle with half depth a along y (the bending direction) and half width b along z. S = 4ab, I_z = 4a^3
/// b/3,
///
///     tau_yx = F/(2(1+nu) I) {(1+nu)(a^2-y^2) + nu (z^2 - b^2/3)
///                             - (4 nu b^2/pi^2) sum (-1)^n/n^2 c_n(y) cos(n pi z/b)}
///     tau_zx = F/(2(1+nu) I) (4 nu b^2/pi^2) sum (-1)^n/n^2 s_n(y) sin(n pi z/b)
///     c_n = cosh(n pi y/b)/cosh(n pi a/b),  s_n = sinh(n pi y/b)/cosh(n pi a/b),  n = 1, 2, ...
///
/// | symbol | name     | unit | range                                              |
/// |--------|----------|------|----------------------------------------------------|
/// | a      | `half_y` | m    | > 0                                                |
/// | b      | `half_z` | m    | > 0; a/b >= 1/4 for full accuracy, see below       |
///
/// The part of the series that converges slowly near y = a is a dilogarithm; of the rest 48 terms are kept,
/// with an error below 1e-16 of the mean shear for a/b >= 1/4, and below 1e-6 for a/b >= 1/20. Source:
/// [timoshenko1970], bending of rectangular bars.
template <Real S>
class RectangularSection {
 public:
  using Scalar = S;

  struct Params {
    S half_y{0.01};  ///< a [m]
    S half_z{0.01};  ///< b [m]
  };

  explicit RectangularSection(const Params& params) : p_(params) {
    require_positive(params.half_y, "RectangularSection", "half_y [m] must be > 0");
    require_positive(params.half_z, "RectangularSection", "half_z [m] must be > 0");
  }

  [[nodiscard]] constexpr S area() const noexcept { return S(4) * p_.half_y * p_.half_z; }
  [[nodiscard]] constexpr S second_moment_y() const noexcept { return area() * p_.half_z * p_.half_z / S(3); }
  [[nodiscard]] constexpr S second_moment_z() const noexcept { return area() * p_.half_y * p_.half_y / S(3); }

  /// (tau_yx, tau_zx) at (y, z) [m] per newton of F_y; points outside the section give their nearest point's
  /// value.
  [[nodiscard]] FlexureShear<S> flexure_shear(S nu, S y, S z) const noexcept {
    // Lengths over a; the fields are even and odd in y, so y >= 0 is enough.
    const S b = p_.half_z / p_.half_y, v = clamped(std::abs(y) / p_.half_y, S(1)),
            w = clamped(z / p_.half_y, b);
    const S k = std::numbers::pi_v<S> / b, t = k * w;
    const std::complex<S> slow = detail::dilogarithm(-std::polar(std::exp(-k * (S(1) - v)), t));
    S even = slow.real(), odd = slow.imag();
    for (int n = 1; n <= terms; ++n) {
      const S kn = k * S(n), near = std::exp(-kn * (S(1) + v)), far = std::exp(-kn * (S(3) - v));
      const S scale = (n % 2 == 0 ? S(1) : S(-1)) / (S(n) * S(n) * (S(1) + std::exp(S(-2) * kn)));
      even += scale * (near - far) * std::cos(S(n) * t);
      odd -= scale * (near + far) * std::sin(S(n) * t);
    }
    const S series = S(4) * nu / (k * k);
    const S mean = S(3) / (S(2) * (S(1) + nu) * area());  // 1 / (2 (1+nu) I) in lengths over a
    return {mean * ((S(1) + nu) * (S(1) - v * v) + nu * (w * w - b * b / S(3)) - series * even),
            mean * series * (y < S(0) ? -odd : odd)};
  }

  /// kappa [-] with which Timoshenko's shear energy is that of the exact stresses, 1/kappa = S int tau^2 dS /
  /// F_y^2; 5/6 at nu = 0. For set-up: it sums a series.
  [[nodiscard]] S shear_coefficient(S nu) const noexcept {
    const S b = p_.half_z / p_.half_y, k = std::numbers::pi_v<S> / b, pi = std::numbers::pi_v<S>;
    S sum = pi * pi * pi * pi / S(45) - S(2.07385551028673985266e0L) / k;  // 2 zeta(4) - 2 zeta(5) / k
    for (int n = terms; n >= 1; --n) {
      const S e = std::exp(S(-2) * k * S(n)), n5 = S(n) * S(n) * S(n) * S(n) * S(n);
      sum += S(4) * e / ((S(1) + e) * n5 * k);  // 1 - tanh(k n)
    }
    const S m = S(1) + nu, shape = S(16) * nu * nu * b * b * b * b / (pi * pi * pi * pi);
    return S(16) * m * m / (S(9) * (S(32) / S(15) * m * m + shape * sum));
  }

  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  static constexpr int terms = 48;
  [[nodiscard]] static constexpr S clamped(S x, S limit) noexcept {
    return x > limit ? limit : x < -limit ? -limit : x;
  }

  Params p_;
};

static_assert(BeamSection<RectangularSection<float>> && BeamSection<RectangularSection<double>>);

}  // namespace palpate
