// SPDX-License-Identifier: MIT
#pragma once

/// @file  The elastic object's material: homogeneous, isotropic, linear (section II).

#include <palpate/core/error.hpp>
#include <palpate/core/scalar.hpp>

#include <array>

namespace palpate {

/// Stress [Pa] or strain [-] in the order xx, yy, zz, yz, zx, xy. Strain has engineering shear, gamma = 2
/// epsilon.
template <Real S>
using Voigt = std::array<S, 6>;

/// Isotropic elasticity: strain from stress by the compliance, {eps} = D^-1 {sigma}  (10).
///
///     eps_x = (sigma_x - nu (sigma_y + sigma_z)) / E, and so on
///     gamma_yz = tau_yz / G, and so on;  G = E / (2 (1 + nu))
///
/// | symbol | name  | unit   | range                                    |
/// |--------|-------|--------|------------------------------------------|
/// | E      | `E`   | Pa     | > 0                                      |
/// | nu     | `nu`  | -      | 0 to 1/2; 1/2 is incompressible (rubber) |
/// | rho    | `rho` | kg/m^3 | > 0                                      |
///
/// The compliance is finite up to and including nu = 1/2, where D itself is not; so D is never formed.
/// Reported at set-up: a parameter out of its range. Default nu and rho are the paper's rubber (VII); its E
/// was lost in the scan, 1 MPa is a soft rubber. Source: [luo2005], eq. (10).
template <Real S>
class IsotropicElasticity {
 public:
  using Scalar = S;

  struct Params {
    S E{1e6};           ///< Young's modulus [Pa]
    S nu{S(1) / S(2)};  ///< Poisson's ratio [-]
    S rho{1100};        ///< density [kg/m^3]
  };

  constexpr explicit IsotropicElasticity(const Params& params) : p_(params) {
    require_positive(params.E, "IsotropicElasticity", "E [Pa] must be > 0");
    require_finite(params.nu, "IsotropicElasticity", "nu must be from 0 to 1/2");
    if (params.nu < S(0) || params.nu > S(0.5)) {
      fail("IsotropicElasticity", "nu must be from 0 to 1/2", static_cast<double>(params.nu));
    }
    require_positive(params.rho, "IsotropicElasticity", "rho [kg/m^3] must be > 0");
  }

  /// G = E / (2 (1 + nu)) [Pa].
  [[nodiscard]] constexpr S shear_modulus() const noexcept { return p_.E / (S(2) * (S(1) + p_.nu)); }

  /// Eq. (10): strain [-] of `stress` [Pa].
  [[nodiscard]] constexpr Voigt<S> strain(const Voigt<S>& stress) const noexcept {
    const S per_E = S(1) / p_.E, per_G = S(2) * (S(1) + p_.nu) / p_.E;
    return {(stress[0] - p_.nu * (stress[1] + stress[2])) * per_E,
            (stress[1] - p_.nu * (stress[2] + stress[0])) * per_E,
            (stress[2] - p_.nu * (stress[0] + stress[1])) * per_E,
            stress[3] * per_G,
            stress[4] * per_G,
            stress[5] * per_G};
  }

  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

}  // namespace palpate
