// SPDX-License-Identifier: MIT
#pragma once

/// @file Linear loads of a contact beside its force: what bonds its patch, and what the tool's rotation does
/// to it. Per tick.
///
/// A bonded patch neither spreads nor bends. For nu < 1/2 a flat punch under a force would do both; a force
/// dipole and a bending couple prevent it, in the mean that the loads' energy contains. Where the regular
/// part w spreads and bends the surface beneath the patch, the half-space's loads for that spread and slope
/// prevent it, as far as PatchMoments does not: the moments of w over a narrow patch are the slopes of w.

#include <palpate/response/tick/placement.hpp>

namespace palpate::detail {

/// Radial force dipole [m] of a unit normal force on a bonded flat punch, a (1 - 2 nu) / (pi (1 - nu)); minus
/// half of it is the bending couple of a unit tangential force.
[[nodiscard]] inline double bonded_dipole(double a, double nu) noexcept {
  return a * (1 - 2 * nu) / (std::numbers::pi * (1 - nu));
}

/// `series_share` of a displacement u whose force S u is half of the contact's.
[[nodiscard]] inline double series_share_of_force(const Vec3<double>& u, const Mat3<double>& S,
                                                  const Vec3<double>& P) noexcept {
  return smooth_limit((S * u).squaredNorm(), tick::max_load_force2 * P.squaredNorm());
}

/// w at a contact's patch by its own loads, times mu. By reciprocity: the spread and the slopes of w by unit
/// forces.
struct MovedByLoads {
  Vec3<double> radial = Vec3<double>::Zero();  ///< by a unit force dipole [1/m^2]
  Mat3<double> couple = Mat3<double>::Zero();  ///< rows: by a unit bending couple along each axis [1/m^2]
  const PatchMoments* moments;

  MovedByLoads(const ResponseField& field, const PlacedContact& c, const PatchMoments& m) noexcept
      : moments(&m) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t node = c.position.node[i];
      const Mat3<double> mean =
          c.regular * c.regular * c.position.weight[Eigen::Index(i)] * field.table().second(node, c.level);
      const Vec3<double>& n = field.load_mesh().nodes()[node].normal;
      const Vec3<double> n1 = perpendicular(n);
      radial += mean.col(0);
      couple += n1 * mean.col(1).transpose() + n.cross(n1) * mean.col(2).transpose();
    }
  }
  /// Displacement by a dipole and a couple, less what a wide patch prevents.
  [[nodiscard]] Vec3<double> by(double dipole, const Vec3<double>& c) const noexcept {
    Vec3<double> u = dipole * radial + couple.transpose() * c;
    if (moments->share > 0) u -= moments->G.transpose() * moments->stiffness * moments->of_loads(dipole, c);
    return u;
  }
  /// Size of u = by(dipole, c) for `series_share`.
  [[nodiscard]] double size(const Vec3<double>& u, double dipole, const Vec3<double>& c) const noexcept {
    return std::lerp(size_of_both(radial.norm(), dipole, couple.norm(), c), u.norm(), moments->share);
  }
};

/// Bending couple of a rigid disc by its slope, 8 a^3 / (3 (1 - nu)) [m^3]: the inverse of D_near
/// (patch_moments.hpp); times the contact's activation.
[[nodiscard]] inline double bending_stiffness(double activation, double a, double nu) noexcept {
  return activation * 8 * a * a * a / (3 * (1 - nu));
}
/// Couple about m of a bonded disc by its rotation about m [m^3]:
///
///     16 a^3 / (3 (1 + 9 H a / (4 pi)))
///
/// H: mean curvature, from the mean depth H a^2 / 2 of the patch's edge. On a convex surface there is less
/// material around the patch to shear; the factor is the first order of that (docs/response_field.md). Times
/// the contact's activation.
[[nodiscard]] PALPATE_COMPILED_INLINE double torsional_stiffness(const ResponseField& field,
                                                                 const PlacedContact& c,
                                                                 double activation) noexcept {
  const double a = c.tool.a,
               Ha = 2 / a *
                    field.table().edge(&MomentRow::mean_sagitta, c.position.node, c.position.weight, a);
  return activation * 16 * a * a * a /
         (3 + 6.75 / std::numbers::pi * std::clamp(Ha, tick::min_curvature, tick::max_curvature));
}
/// Mean displacement of a contact's patch by w of its unit torsional couple; by reciprocity the rotation of w
/// about m by unit forces [1/m^2].
[[nodiscard]] PALPATE_COMPILED_INLINE Vec3<double> moved_by_torsion(const ResponseField& field,
                                                                    const PlacedContact& c) noexcept {
  Vec3<double> u = Vec3<double>::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    u += c.regular * c.regular * c.position.weight[Eigen::Index(i)] *
         field.table().second_by_twist(c.position.node[i], c.level);
  return u;
}

/// Loads by which the tool rotates its patch, and the displacement of the patch by them: through w, and, for
/// nu < 1/2, through the half-space, by reciprocity with the couple of a bonded patch under a force.
[[nodiscard]] inline RotationLoads rotation_loads(const ResponseField& field, const PlacedContact& c,
                                                  const BondedContact& bonded) noexcept {
  RotationLoads out;
  const Vec3<double> slope = c.tool.slope();
  const double a = c.tool.a, nu = field.nu();
  const PatchMoments& moments = bonded.moments;
  out.couple = (1 - moments.share) * bending_stiffness(bonded.activation, a, nu) * slope;
  out.torsion = torsional_stiffness(field, c, bonded.activation) * c.tool.rotation.dot(c.tool.m);
  out.displacement = MovedByLoads(field, c, moments).by(0, out.couple) +
                     0.5 * bonded.activation * bonded_dipole(a, nu) * slope +
                     out.torsion * moved_by_torsion(field, c);
  if (moments.share > 0)
    out.displacement += moments.G.transpose() * moments.stiffness * moments.of_slope(slope);
  return out;
}

/// The bonded stage: C less what the moments of a wide patch take from it, and the tool's rotation. `wide`:
/// share of the moments.
[[nodiscard]] PALPATE_COMPILED_INLINE BondedContact bond_contact(const ResponseField& field,
                                                                 const PlacedContact& c, double activation,
                                                                 double wide) noexcept {
  BondedContact out;
  out.activation = activation;
  out.C = c.C;
  out.S = c.S;
  if (wide > 0) {
    out.moments.read(field, c.position, c.level, c.tool.m, c.tool.a, c.regular * c.regular,
                     bonded_dipole(c.tool.a, field.nu()), wide);
    out.C -= out.moments.take(out.C.trace());
    out.S = bounded_inverse(out.C, c.min_near());
  }
  if (c.tool.is_rotated()) out.rotation = rotation_loads(field, c, out);
  return out;
}

/// The contact's force in the formulas of the loads beside it: at most that of the half-space for d. For a
/// body that is far stiffer than a half-space the formulas do not hold.
struct IndentingForce {
  FlatPunchCompliance near;
  double whole;             ///< normal part of the contact's force [m^2]
  double factor;            ///< of the contact's force
  Vec3<double> P;           ///< factor times the contact's force [m^2]
  double normal;            ///< P . m
  Vec3<double> tangential;  ///< the rest

  PALPATE_INLINE IndentingForce(const PlacedContact& c, const Vec3<double>& force) noexcept
      : near(c.near), whole(force.dot(c.tool.m)) {
    const Vec3<double> indentation =
        near.tangential * force + (near.normal - near.tangential) * whole * c.tool.m;
    const double max = std::sqrt(c.displacement2), length = indentation.norm();
    factor = length > max ? max / length : 1;
    P = factor * force;
    normal = P.dot(c.tool.m);
    tangential = P - normal * c.tool.m;
  }
};

/// Loads of first order beside the force.
struct LinearLoads {
  double bending;       ///< bending stiffness of the patch [m^3]
  Vec3<double> slope;   ///< of w beneath the patch, by all forces
  double dipole;        ///< radial force dipole [m^3]
  Vec3<double> couple;  ///< bending couple, the tool's included [m^3]
  Vec3<double> rhs;     ///< displacement that is left for the force [m]
};

/// Dipole and couple that keep the patch from spreading and bending:
///
///     dipole = D_b P_n - 2 k (radial . P + spread),   couple = -D_b P_t / 2 - k (slope of w) + the tool's
///
/// D_b: `bonded_dipole`; k: what a narrow patch has of the bending stiffness.
[[nodiscard]] PALPATE_INLINE LinearLoads linear_loads(const ResponseField& field, const PlacedContact& c,
                                                      const BondedContact& bonded,
                                                      const LinearContact& linear, const MovedByLoads& moved,
                                                      const IndentingForce& F) noexcept {
  const Indenter& tool = c.tool;
  const Vec3<double> t1 = tool.t1(), t2 = t1.cross(tool.m);
  const double nu = field.nu(), own = bonded_dipole(tool.a, nu);
  LinearLoads out;
  out.bending = bending_stiffness(bonded.activation, tool.a, nu);
  double k = (1 - bonded.moments.share) * out.bending;
  const double taken = k * (2 * moved.radial.squaredNorm() + moved.couple.squaredNorm()),
               whole = bonded.C.trace();
  k *= smooth_limit(taken * taken, tick::max_bonded_part2 * whole * whole);
  const Vec3<double> slope = moved.couple * F.P;
  out.slope = (slope.dot(t1) + linear.imposed[1]) * t1 + (slope.dot(t2) + linear.imposed[2]) * t2;
  out.dipole = own * F.normal - 2 * k * (moved.radial.dot(F.P) + linear.imposed[0]);
  out.couple = -0.5 * own * F.tangential - k * out.slope;
  const Vec3<double> u = moved.by(out.dipole, out.couple);
  // Half of d is for these loads and the tool's rotation together.
  const double rotated = bonded.rotation.displacement.norm(),
               share = series_share(moved.size(u, out.dipole, out.couple) + rotated, c.displacement2);
  out.dipole *= share;
  out.couple *= share;
  out.couple += bonded.rotation.couple;
  out.rhs = linear.rhs;
  out.rhs += (series_share(rotated, c.displacement2) - share) * bonded.rotation.displacement - share * u;
  return out;
}

}  // namespace palpate::detail
