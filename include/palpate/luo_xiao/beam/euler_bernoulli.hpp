// SPDX-License-Identifier: MIT
#pragma once

/// @file  Euler-Bernoulli cantilever: bending without shear (V.A.1).

#include <palpate/luo_xiao/beam/concept.hpp>

namespace palpate {

/// The paper's beam. Deflection at x under the end load F_y, tip stiffness, and stiffness along the beam:
///
///     y(x) = F_y / (E I_z) (l x^2/2 - x^3/6),   F_y = 3 E I_z y / l^3  (4),   F_x = E S x / l  (5)
///
/// | symbol | name           | unit | range |
/// |--------|----------------|------|-------|
/// | l      | `length`       | m    | > 0   |
/// | x      | `x`            | m    | 0..l  |
/// | E      | `material().E` | Pa   | > 0   |
///
/// Limits: small deflections (the tip is 2.8 % off at F_y l^2/(E I) = 1/2, 10.5 % at 1) and slender beams:
/// without shear a circular beam is too stiff by 11 % at l/r = 5. Source: [luo2005], eqs. (4), (5).
template <Real S>
class EulerBernoulli {
 public:
  using Scalar = S;

  constexpr explicit EulerBernoulli(const IsotropicElasticity<S>& material) noexcept : material_(material) {}

  /// Eq. (5) [N/m].
  template <BeamSection C>
  [[nodiscard]] constexpr S axial_stiffness(const C& section, S length) const noexcept {
    return material_.params().E * section.area() / length;
  }
  /// Eq. (4) [N/m].
  template <BeamSection C>
  [[nodiscard]] constexpr S transverse_stiffness(const C& section, S length) const noexcept {
    return S(3) * material_.params().E * (section.second_moment_z() / length) / (length * length);
  }
  /// The deflection line y(x) [m] under F_y [N].
  template <BeamSection C>
  [[nodiscard]] constexpr S deflection(const C& section, S length, S F_y, S x) const noexcept {
    return F_y / (material_.params().E * section.second_moment_z()) * (x * x) * (length / S(2) - x / S(6));
  }
  [[nodiscard]] constexpr const IsotropicElasticity<S>& material() const noexcept { return material_; }

 private:
  IsotropicElasticity<S> material_;
};

static_assert(BeamTheory<EulerBernoulli<float>> && BeamTheory<EulerBernoulli<double>>);

}  // namespace palpate
