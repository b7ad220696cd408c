// SPDX-License-Identifier: MIT
#pragma once

/// @file  Circular and elliptic cross-sections, and the stresses in a loaded beam (V.A.1).

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/beam/concept.hpp>

#include <numbers>

namespace palpate {

/// Ellipse with semi-axes a along y (the bending direction) and b along z. Exact flexure stresses, bending
/// function
///
///     phi_1 = A y + B (y^3 - 3 y z^2)
///     A = a^2 (2(1+nu) a^2 + b^2)/(3a^2 + b^2),  B = ((1+nu) a^2 + nu b^2)/(3 (3a^2 + b^2))
///     S = pi a b,  I_z = pi a^3 b/4,  I_y = pi a b^3/4
///
/// | symbol | name     | unit | range |
/// |--------|----------|------|-------|
/// | a      | `semi_y` | m    | > 0   |
/// | b      | `semi_z` | m    | > 0   |
///
/// Source: [timoshenko1970], bending of elliptic bars; phi_1 as [luo2005] uses it.
template <Real S>
class EllipticSection {
 public:
  using Scalar = S;

  struct Params {
    S semi_y{0.01};  ///< a [m]
    S semi_z{0.01};  ///< b [m]
  };

  constexpr explicit EllipticSection(const Params& params) : p_(params) {
    require_positive(params.semi_y, "EllipticSection", "semi_y [m] must be > 0");
    require_positive(params.semi_z, "EllipticSection", "semi_z [m] must be > 0");
  }

  [[nodiscard]] constexpr S area() const noexcept { return std::numbers::pi_v<S> * p_.semi_y * p_.semi_z; }
  [[nodiscard]] constexpr S second_moment_y() const noexcept { return area() * p_.semi_z * p_.semi_z / S(4); }
  [[nodiscard]] constexpr S second_moment_z() const noexcept { return area() * p_.semi_y * p_.semi_y / S(4); }

  /// (tau_yx, tau_zx) at (y, z) [m] per newton of F_y.
  [[nodiscard]] constexpr FlexureShear<S> flexure_shear(S nu, S y, S z) const noexcept {
    const Coefficients c = coefficients(nu);
    const S v = y / p_.semi_y, w = z / p_.semi_z;
    return {c.yx * (S(1) - v * v - c.bend * w * w), -c.zx * v * w};
  }

  /// kappa [-] with which Timoshenko's shear energy is that of the exact stresses, 1/kappa = S int tau^2 dS /
  /// F_y^2. Circle: 6 (1+nu)^2 / (7 + 14 nu + 8 nu^2).
  [[nodiscard]] constexpr S shear_coefficient(S nu) const noexcept {
    const Coefficients c = coefficients(nu);
    const S s = area();
    return S(1) / (s * s *
                   (c.yx * c.yx * (S(5) / S(8) + c.bend * c.bend / S(8) - c.bend * S(5) / S(12)) +
                    c.zx * c.zx / S(24)));
  }

  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  // tau_yx = yx (1 - (y/a)^2 - bend (z/b)^2), tau_zx = -zx (y/a)(z/b): free of fourth powers of a length
  struct Coefficients {
    S yx, bend, zx;
  };
  [[nodiscard]] constexpr Coefficients coefficients(S nu) const noexcept {
    const S q = p_.semi_z / p_.semi_y, q2 = q * q, s = area();
    const S top = S(2) * (S(1) + nu) + q2, below = (S(1) + nu) * (S(3) + q2);
    return {S(2) * top / (s * below), (S(1) - S(2) * nu) * q2 / top,
            S(4) * q * ((S(1) + nu) + nu * q2) / (s * below)};
  }

  Params p_;
};

/// Circle: the ellipse with equal semi-axes. S = pi r^2, I = pi r^4/4.
///
/// | symbol | name     | unit | range |
/// |--------|----------|------|-------|
/// | r      | `radius` | m    | > 0   |
template <Real S>
class CircularSection {
 public:
  using Scalar = S;

  struct Params {
    S radius{0.01};  ///< r [m]
  };

  constexpr explicit CircularSection(const Params& params)
      : ellipse_({.semi_y = params.radius, .semi_z = params.radius}) {}

  [[nodiscard]] constexpr S area() const noexcept { return ellipse_.area(); }
  [[nodiscard]] constexpr S second_moment_y() const noexcept { return ellipse_.second_moment_y(); }
  [[nodiscard]] constexpr S second_moment_z() const noexcept { return ellipse_.second_moment_z(); }
  /// tau_yx = F (3+2nu)/(8(1+nu) I) [r^2 - y^2 - (1-2nu)/(3+2nu) z^2], tau_zx = -F (1+2nu) y z/(4(1+nu) I), F
  /// = 1 N.
  [[nodiscard]] constexpr FlexureShear<S> flexure_shear(S nu, S y, S z) const noexcept {
    return ellipse_.flexure_shear(nu, y, z);
  }
  [[nodiscard]] constexpr S shear_coefficient(S nu) const noexcept { return ellipse_.shear_coefficient(nu); }
  [[nodiscard]] constexpr S radius() const noexcept { return ellipse_.params().semi_y; }

 private:
  EllipticSection<S> ellipse_;
};

/// Load at a beam's free end, in the beam frame [N].
template <Real S>
struct BeamLoad {
  S F_x;  ///< along the beam; > 0 pulls
  S F_y;  ///< across it
};

/// Stress at the point (y, z) of the section at distance `arm` = l - x from the loaded end, exact away from
/// the ends:
///
///     sigma_x = -F_y (l - x) y / I_z + F_x / S
///     tau_yx  = F_y / (2(1+nu) I_z) [d phi_1/dy + nu z^2 - (1+nu) y^2]
///     tau_zx  = F_y / (2(1+nu) I_z) d phi_1/dz
///     sigma_y = sigma_z = tau_yz = 0
///
/// The sign of sigma_x is that of three-dimensional elasticity (equilibrium with tau), not that of the scan.
template <BeamSection C, Real S = typename C::Scalar>
[[nodiscard]] constexpr Voigt<S> beam_stress(const C& section, S nu, const BeamLoad<S>& load, S arm, S y,
                                             S z) noexcept {
  const FlexureShear<S> shear = section.flexure_shear(nu, y, z);
  const S sigma_x = load.F_x / section.area() - load.F_y * arm * (y / section.second_moment_z());
  return {sigma_x, S(0), S(0), S(0), load.F_y * shear.zx, load.F_y * shear.yx};
}

static_assert(BeamSection<CircularSection<float>> && BeamSection<CircularSection<double>>);
static_assert(BeamSection<EllipticSection<float>> && BeamSection<EllipticSection<double>>);

}  // namespace palpate
