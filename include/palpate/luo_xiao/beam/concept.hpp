// SPDX-License-Identifier: MIT
#pragma once

/// @file What the parts of a beam skeleton must offer (V.A.1). Read this before writing one.
///
/// | beam theory      | tip stiffness across the beam     | use it when                       |
/// |------------------|-----------------------------------|-----------------------------------|
/// | `EulerBernoulli` | 3 E I / l^3, eq. (4)              | the default, the paper's          |
/// | `Timoshenko`     | 1 / (l^3/(3 E I) + l/(kappa G S)) | beams shorter than about 10 radii |
///
/// | section              | half-axes along y, z   | use it when                          |
/// |----------------------|------------------------|--------------------------------------|
/// | `CircularSection`    | radius                 | the default                          |
/// | `EllipticSection`    | two semi-axes          | stiffness along and across set apart |
/// | `RectangularSection` | half depth, half width | ditto; slab-like bodies              |
///
/// | section rule        | section of every beam          | use it when                                     |
/// |---------------------|--------------------------------|-------------------------------------------------|
/// | `VolumePreserving`  | circle with sum S l_i = volume | the default: no parameter but the body's volume |
/// | `UniformSection<C>` | the one given                  | a measured or fitted section                    |
///
/// | sharing        | F among the beams                  | use it when                          |
/// |----------------|------------------------------------|--------------------------------------|
/// | `CommonEnd`    | one end, one displacement: K d = F | the default; always solvable         |
/// | `PlanarRatios` | (6)-(8) as printed, D known        | comparing with the paper, in a plane |
///
/// | regions             | contacts on each other               | use it when                         |
/// |---------------------|--------------------------------------|-------------------------------------|
/// | `CoupledRegions`    | one system, shared beams             | the default: reciprocal, continuous |
/// | `SuperposedRegions` | one skeleton each, others fixed (VI) | comparing with the paper            |
///
/// Beam frame: origin at the fixed end (the extremal point), x along the beam toward the loaded end (the
/// contact), y along the part of the load across the beam. A section turns with its load: y is its bending
/// direction. Absent on purpose: trusses (no bending stiffness), because their system can be singular; large
/// deflections, because the skeleton's system is linear.

#include <palpate/core/scalar.hpp>
#include <palpate/elasticity/isotropic.hpp>

#include <concepts>

namespace palpate {

/// Shear stresses in a section per newton of F_y [1/m^2].
template <Real S>
struct FlexureShear {
  S yx;
  S zx;
};

template <class C>  // S [m^2]
concept HasArea = requires(const C& section) {
  { section.area() } noexcept -> std::same_as<typename C::Scalar>;
};

template <class C>  // I_y = integral of z^2, I_z = integral of y^2 [m^4]; I_z resists bending along y
concept HasSecondMoments = requires(const C& section) {
  { section.second_moment_y() } noexcept -> std::same_as<typename C::Scalar>;
  { section.second_moment_z() } noexcept -> std::same_as<typename C::Scalar>;
};

template <class C>  // shear at (y, z) [m] per newton of F_y, for Poisson's ratio nu; exact within the section
concept HasFlexureShear = requires(const C& section, typename C::Scalar x) {
  { section.flexure_shear(x, x, x) } noexcept -> std::same_as<FlexureShear<typename C::Scalar>>;
};

/// A cross-section, symmetric about its y and z axes. (Sections have the suffix `Section`.)
template <class C>
concept BeamSection =
    Real<typename C::Scalar> && HasArea<C> && HasSecondMoments<C> && HasFlexureShear<C> && std::copyable<C>;

namespace detail {
/// A section with no more than the concept asks for: what a theory must accept.
template <Real S>
struct AnySection {
  using Scalar = S;
  [[nodiscard]] constexpr S area() const noexcept { return S(1); }
  [[nodiscard]] constexpr S second_moment_y() const noexcept { return S(1); }
  [[nodiscard]] constexpr S second_moment_z() const noexcept { return S(1); }
  [[nodiscard]] constexpr FlexureShear<S> flexure_shear(S, S, S) const noexcept { return {S(1), S(0)}; }
};
}  // namespace detail

template <class T>  // stiffness of the free end along and across the beam [N/m]; length [m] > 0
concept HasTipStiffness = requires(const T& theory, typename T::Scalar length) {
  {
    theory.axial_stiffness(detail::AnySection<typename T::Scalar>{}, length)
  } noexcept -> std::same_as<typename T::Scalar>;
  {
    theory.transverse_stiffness(detail::AnySection<typename T::Scalar>{}, length)
  } noexcept -> std::same_as<typename T::Scalar>;
};

template <class T>  // deflection line: (section, length, F_y, x) -> y(x) [m], 0 <= x <= length
concept HasDeflection = requires(const T& theory, typename T::Scalar x) {
  {
    theory.deflection(detail::AnySection<typename T::Scalar>{}, x, x, x)
  } noexcept -> std::same_as<typename T::Scalar>;
};

template <class T>
concept HasMaterial = requires(const T& theory) {
  { theory.material() } noexcept -> std::same_as<const IsotropicElasticity<typename T::Scalar>&>;
};

/// A straight cantilever, fixed at one end, loaded at the other.
template <class T>
concept BeamTheory =
    Real<typename T::Scalar> && HasTipStiffness<T> && HasDeflection<T> && HasMaterial<T> && std::copyable<T>;

/// The section of every beam of a skeleton, from the sum of the beams' lengths [m]. Continuous; positive for
/// 0.
template <class R>
concept SectionRule = BeamSection<typename R::Section> && std::copyable<R> &&
                      requires(const R& rule, typename R::Section::Scalar total_length) {
                        { rule.section(total_length) } noexcept -> std::same_as<typename R::Section>;
                      };

}  // namespace palpate
