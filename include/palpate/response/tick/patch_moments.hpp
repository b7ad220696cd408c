// SPDX-License-Identifier: MIT
#pragma once

/// @file What bonds a wide patch: its spread, shear and bending are kept at zero, not its mean alone. Per
/// tick.
///
/// Over a patch that is wide for its body, w would spread, shear and bend the surface. Five more loads
/// prevent it: a radial force dipole, two shear dipoles, two bending couples, each with the flat punch's
/// weight times the distance from its centre. Their strengths y are those for which the patch's own moments
/// vanish (Ritz: the energy of all loads is least):
///
///     y = D^-1 (slope of the tool - G P - W M),   D = D_near + W,   C -> C - G^T D^-1 G
///
/// | symbol | name                                                                     | unit         |
/// |--------|--------------------------------------------------------------------------|--------------|
/// | P, M   | force / mu; loads that the contact has anyway (SecondOrderContact) / mu  | m^2, m^3     |
/// | G, W   | moments of w over the patch by unit forces and by unit moments, times mu | 1/m^2, 1/m^3 |
/// | D_near | the half-space's: 3 (1-nu)/(16 a^3), 3 (2-nu)/(32 a^3), 3 (1-nu)/(8 a^3) | 1/m^3        |
///
/// A patch narrower than an edge of the boundary element mesh has none of these loads, a patch of one and a
/// half edges has all of them, in between a share. The loads for the slopes of w replace the rest
/// (linear_loads.hpp). The share falls with the part of the patch that lies on the fixed region, to 0 at
/// half. A contact alone has its share in full; it falls as others come in (ContactSystem::activate), because
/// of what several contacts do to each other's moments only the slopes are known. Nothing is fitted.
/// docs/response_field.md, "Bonded patches".

#include <palpate/response/response_field.hpp>
#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/constants.hpp>

namespace palpate::detail {

using Moments = Eigen::Matrix<double, 5, 1>;
using MomentsByForce = Eigen::Matrix<double, 5, 3>;
using MomentMatrix = Eigen::Matrix<double, 5, 5>;

struct PatchMoments {
  double share = 0;  ///< 0: narrow, the rest is not set
  Vec3<double> t1, t2, m;
  MomentsByForce G;
  MomentMatrix W, stiffness;  ///< stiffness: share D^-1

  /// Share of a patch of radius a, by the length `size` of the mesh's edges around it.
  [[nodiscard]] static double share_of(double a, double size) noexcept {
    return smooth_step((a / size - tick::narrow_patch) / (tick::wide_patch - tick::narrow_patch));
  }

  /// Reads G and W of a patch of radius a at a position of the load mesh. `counts`: factor of w; `dipole`:
  /// that of a unit normal force (bonded_dipole); `part`: share that the moments have.
  void read(const ResponseField& field, const LoadPosition& position, const PatchTable::Level& level,
            const Vec3<double>& inward, double a, double counts, double dipole, double part) noexcept;
  /// What the moments take from a compliance whose trace is `whole`, G^T D^-1 G. In theory less than all of
  /// it; where the mesh does not resolve w, half of it: by (1 + r^4)^(-1/4), r the part over a half.
  [[nodiscard]] Mat3<double> take(double whole) noexcept;
  /// Moments of w by a contact's dipole and couple.
  [[nodiscard]] Moments of_loads(double dipole, const Vec3<double>& couple) const noexcept;
  /// Moments of a patch whose normal displacement has a slope.
  [[nodiscard]] Moments of_slope(const Vec3<double>& slope) const noexcept;
  /// y for a tool's slope, a force and loads that the contact has anyway.
  [[nodiscard]] Moments bonding(const Vec3<double>& slope, const Vec3<double>& P, double dipole,
                                const Vec3<double>& couple) const noexcept;
  /// Loads as a tensor A: a node's force is A q (moment_loads.hpp).
  [[nodiscard]] Mat3<double> tensor(const Moments& y) const noexcept;
  [[nodiscard]] Mat3<double> shear(const Moments& y) const noexcept;
  [[nodiscard]] Vec3<double> couple(const Moments& y) const noexcept { return y[3] * t1 + y[4] * t2; }

 private:
  void add_node(const ResponseField& field, const LoadPosition& position, const PatchTable::Level& level,
                std::size_t i, double counts) noexcept;
  void invert(double nu, double a) noexcept;
};

}  // namespace palpate::detail

#ifndef PALPATE_COMPILED
#include <palpate/response/tick/patch_moments_impl.hpp>
#endif
