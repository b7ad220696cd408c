// SPDX-License-Identifier: MIT
#pragma once

/// @file  Release of the beams' fixed ends: stress, strain (10) and displacement (9) of the extremal points
/// (V.A.1).

#include <palpate/luo_xiao/beam/section.hpp>
#include <palpate/luo_xiao/beam/skeleton.hpp>

#include <algorithm>
#include <span>

namespace palpate {

/// Equations (9) and (10): displacement [m] that the strain at a beam's fixed end gives the point at `arm`
/// [m] from the fixed centre o:
///
///     {sigma}: beam_stress at x = 0, y = z = 0 under F_i;   {eps} = D^-1 {sigma}  (10)
///     u_i = R eps_beam R^T (e_i - o)   (9): constant strain from o to e_i and no rotation
///
/// The stress is taken at the section's centroid, where the strain is the mean of the section's. Bending
/// stress is 0 there; sigma_x = F_x/S and the flexure shear tau_yx are left. The formula uses the vector of F
/// across the beam, so that it needs no direction y where that vector is 0. Source: [luo2005], V.A.1.
template <BeamSection C>
[[nodiscard]] inline Vec3<double> released_displacement(const C& section,
                                                        const IsotropicElasticity<double>& material,
                                                        const Vec3<double>& axis, const Vec3<double>& force,
                                                        const Vec3<double>& arm) noexcept {
  const double F_x = axis.dot(force), nu = material.params().nu;
  const Vec3<double> across = force - axis * F_x;
  const Voigt<double> pull =
      material.strain(beam_stress(section, nu, BeamLoad<double>{F_x, 0}, 0.0, 0.0, 0.0));
  const Voigt<double> shear =
      material.strain(beam_stress(section, nu, BeamLoad<double>{0, 1}, 0.0, 0.0, 0.0));
  const double along = axis.dot(arm), half = shear[5] / 2;  // per newton; gamma = 2 epsilon
  return axis * ((pull[0] - pull[1]) * along) + arm * pull[1] + axis * (half * across.dot(arm)) +
         across * (half * along);
}

/// Part of the longest beam's length. Where the contact is nearer than that to an extremal point, u_i passes
/// over to the contact's own D, linearly in l_i: at l_i = 0 the two are one point, and the beam has no
/// direction. Chosen: small, and wide enough for a tick's steps not to jump over it.
inline constexpr double release_blend = 0.01;

/// Displacements of all extremal points [m], in their order, for a shared load; zeros for one that is not.
/// `fixed` is o, the bottom centre, which does not move. Continuous in the contact's position.
template <ContactSkeleton K>
inline void release(const K& skeleton, const typename K::Load& load, const Vec3<typename K::Scalar>& fixed,
                    const Vec3<typename K::Scalar>& contact_displacement,
                    std::span<Vec3<typename K::Scalar>> displacements) noexcept {
  using S = typename K::Scalar;
  const auto section = skeleton.section(load);
  double max_length = 0;
  for (const auto& beam : load.beams) max_length = (std::max)(max_length, static_cast<double>(beam.length));
  const std::size_t count = (std::min)(displacements.size(), skeleton.points().size());
  for (std::size_t i = 0; i < count; ++i) {
    displacements[i].setZero();
    if (!load.shared || !(max_length > 0)) continue;
    const auto& beam = load.beams[i];
    const Vec3<double> u =
        released_displacement(section, skeleton.theory().material(), beam.axis.template cast<double>(),
                              beam.force.template cast<double>(),
                              Vec3<double>((skeleton.points()[i] - fixed).template cast<double>()));
    const double own = (std::min)(1.0, static_cast<double>(beam.length) / (release_blend * max_length));
    const Vec3<S> result =
        (own * u + (1 - own) * contact_displacement.template cast<double>()).template cast<S>();
    if (is_finite(result)) displacements[i] = result;
  }
}

}  // namespace palpate
