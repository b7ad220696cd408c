// SPDX-License-Identifier: MIT
#pragma once

/// @file  Timoshenko cantilever: bending and shear. Skeleton "beams" inside a solid are short, so shear
/// matters.

#include <palpate/core/error.hpp>
#include <palpate/luo_xiao/beam/concept.hpp>

namespace palpate {

/// Euler-Bernoulli's deflection plus a uniform shear angle F_y/(kappa G S):
///
///     y(x) = F_y/(E I_z) (l x^2/2 - x^3/6) + F_y x/(kappa G S),   F_y = y / (l^3/(3 E I_z) + l/(kappa G S))
///
/// | symbol | name    | unit | range  | default                         |
/// |--------|---------|------|--------|---------------------------------|
/// | kappa  | `kappa` | -    | (0, 1] | 6 (1+nu)^2/(7 + 14 nu + 8 nu^2) |
///
/// The default is energy-exact for an end-loaded circle: with it the tip moves as the energy of the exact
/// flexure stresses says (0.857, 0.851, 0.844 at nu = 0, 0.3, 0.5). For other sections pass
/// `section.shear_coefficient(nu)`. Cowper's 6(1+nu)/(7+6nu) [cowper1966] rests on another average and is not
/// consistent with those stresses. Along the beam it is Euler-Bernoulli's. Tends to it for l/r -> infinity.
/// No equation: the paper has no shear. Reported at set-up: kappa out of its range.
template <Real S>
class Timoshenko {
 public:
  using Scalar = S;

  /// The energy-exact kappa [-] of a circular section.
  [[nodiscard]] static constexpr S circular_kappa(S nu) noexcept {
    return S(6) * (S(1) + nu) * (S(1) + nu) / (S(7) + nu * (S(14) + S(8) * nu));
  }

  constexpr explicit Timoshenko(const IsotropicElasticity<S>& material) noexcept
      : material_(material), kappa_(circular_kappa(material.params().nu)) {}
  constexpr Timoshenko(const IsotropicElasticity<S>& material, S kappa) : material_(material), kappa_(kappa) {
    require_positive(kappa, "Timoshenko", "kappa must be > 0 and at most 1");
    if (kappa > S(1)) fail("Timoshenko", "kappa must be > 0 and at most 1", static_cast<double>(kappa));
  }

  /// Eq. (5) [N/m].
  template <BeamSection C>
  [[nodiscard]] constexpr S axial_stiffness(const C& section, S length) const noexcept {
    return material_.params().E * section.area() / length;
  }
  /// Bending and shear in series [N/m].
  template <BeamSection C>
  [[nodiscard]] constexpr S transverse_stiffness(const C& section, S length) const noexcept {
    const S bending = length * length / (S(3) * material_.params().E * section.second_moment_z());
    return S(1) / (length * (bending + shear_compliance(section)));
  }
  /// The deflection line y(x) [m] under F_y [N].
  template <BeamSection C>
  [[nodiscard]] constexpr S deflection(const C& section, S length, S F_y, S x) const noexcept {
    const S bending = x * (length / S(2) - x / S(6)) / (material_.params().E * section.second_moment_z());
    return F_y * x * (bending + shear_compliance(section));
  }
  [[nodiscard]] constexpr const IsotropicElasticity<S>& material() const noexcept { return material_; }
  [[nodiscard]] constexpr S kappa() const noexcept { return kappa_; }

 private:
  // shear angle per newton, 1/(kappa G S)
  template <BeamSection C>
  [[nodiscard]] constexpr S shear_compliance(const C& section) const noexcept {
    return S(1) / (kappa_ * material_.shear_modulus() * section.area());
  }

  IsotropicElasticity<S> material_;
  S kappa_;
};

static_assert(BeamTheory<Timoshenko<float>> && BeamTheory<Timoshenko<double>>);

}  // namespace palpate
