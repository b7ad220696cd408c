// SPDX-License-Identifier: MIT
#pragma once

/// @file The stages of a contact in a tick of a response field. A stage is a value: made by one function from
/// those before it, constant afterwards.
///
/// | stage | type | made in | contents |
/// |---|---|---|---|
/// | given | Indenter | response_contact.hpp | what presses, where, by how much |
/// | placed | PlacedContact | placement.hpp | nodes of the load mesh, w, compliance of the mean |
/// | bonded | BondedContact | linear_loads.hpp | compliance with what bonds the patch; the tool's rotation |
/// | linear | LinearContact | contact_system.hpp | force of first order |
/// | second order | SecondOrderContact | second_order_loads.hpp | loads beside the force, felt forces |
/// | solved | SolvedContact | contact_system.hpp | force, moments of a wide patch |
/// | drawn | DrawnContact | near_coefficients.hpp | coefficients of the near field |
///
/// All forces and moments are divided by mu.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/response/tick/near_field.hpp>
#include <palpate/response/tick/patch_moments.hpp>
#include <palpate/response/tick/solved_nodes.hpp>

#include <algorithm>
#include <memory>
#include <new>

namespace palpate::detail {

/// A bonded flat patch that moves and rotates, or a frictionless sphere.
struct Indenter {
  Vec3<double> x;         ///< middle of the patch; of a sphere where it touches first [m]
  Vec3<double> m;         ///< unit normal into the body
  Vec3<double> d;         ///< displacement [m]
  Vec3<double> rotation;  ///< of the tool [rad]
  double a = 0;           ///< radius of the contact [m]
  double sphere = 0;      ///< radius of the sphere; 0: bonded patch [m]

  [[nodiscard]] bool is_sphere() const noexcept { return sphere > 0; }
  [[nodiscard]] bool is_rotated() const noexcept { return rotation.squaredNorm() > 0; }
  /// Tangents of the patch.
  [[nodiscard]] Vec3<double> t1() const noexcept { return perpendicular(Vec3<double>(-m)); }
  [[nodiscard]] Vec3<double> t2() const noexcept { return t1().cross(m); }
  /// Slope of the patch's normal displacement by the tool's rotation.
  [[nodiscard]] Vec3<double> slope() const noexcept { return m.cross(rotation); }
  /// Square of the displacement: of the patch's middle, and of its edge by the rotation.
  [[nodiscard]] double displacement2() const noexcept {
    return d.squaredNorm() + a * a * rotation.squaredNorm();
  }
  /// s^2 of the flat punch whose load has the same mean r^2 as that of a contact of radius r: the punch's is
  /// 2/3 s^2, Hertz's pressure has 2/5 r^2. `seen2`: the mean of that and of a^2, for the displacement is
  /// averaged with the punch's weight.
  [[nodiscard]] double loaded2(double r) const noexcept { return (is_sphere() ? 0.6 : 1) * r * r; }
  [[nodiscard]] double seen2() const noexcept { return (is_sphere() ? 0.8 : 1) * a * a; }
};

/// Placed on the load mesh: C = C_near + w with its modes bounded from below.
struct PlacedContact {
  Indenter tool;
  LoadPosition position;
  FixedVector<NodeWeight, LoadMesh::most_beneath, Spare::undefined> nodes;
  double regular = 1;        ///< share of w that counts: 1 on the surface, 0 far from it
  double carried = 1;        ///< part of the force that does not fall on the fixed region
  PatchTable::Level level;   ///< of the radius
  double sagitta = 0;        ///< how deep the patch's edge lies below its plane, at most [m]
  double wide = 0;           ///< share of PatchMoments by the patch's width
  double displacement2 = 0;  ///< Indenter::displacement2 [m^2]
  FlatPunchCompliance near;  ///< of the half-space, times mu [1/m]
  Mat3<double> w, C, S;      ///< regular part, compliance, times mu; the compliance's inverse

  [[nodiscard]] double min_near() const noexcept { return (std::min)(near.normal, near.tangential); }
};

/// Loads by which the tool's rotation rotates its patch.
struct RotationLoads {
  Vec3<double> couple = Vec3<double>::Zero();        ///< bending couple of a narrow patch [m^3]
  double torsion = 0;                                ///< couple about m [m^3]
  Vec3<double> displacement = Vec3<double>::Zero();  ///< of the patch by all of them [m]
};

/// With the loads that bond the patch: C, S are those of a patch whose moments are kept at zero.
struct BondedContact {
  double activation = 1;  ///< 0: others have moved the patch as far as it would (ContactSystem::activate)
  PatchMoments moments;   ///< of a wide patch
  Mat3<double> C, S;
  RotationLoads rotation;
};

/// First order.
struct LinearContact {
  Vec3<double> P;        ///< force [m^2]
  Vec3<double> imposed;  ///< by the other contacts' forces beneath the patch: spread, slopes along t1, t2
  Vec3<double> rhs;      ///< d less the patch's displacement by others' loads and by rotated tools [m]
};

/// Near terms of second order.
struct NearTerms {
  double dn2;            ///< delta_n d_n [m^2]
  double beta;           ///< delta_n / a
  Vec3<double> delta_t;  ///< [m]
  Vec3<double> couple;   ///< bending couple of second order [m^3]
  Vec3<double> push;     ///< displacement of the patch by the universal forces [m]
  double spread;         ///< of a sphere: radial displacement by r at the middle
  double raised;         ///< of a sphere: what its own field is too deep by at the middle [m]

  [[nodiscard]] static NearTerms none() noexcept {
    const Vec3<double> zero = Vec3<double>::Zero();
    return {0, 0, zero, zero, zero, 0, 0};
  }
};

/// Loads beside the force.
struct SecondOrderContact {
  double dipole;             ///< radial force dipole [m^3]
  Vec3<double> couple;       ///< bending couple [m^3]
  Vec3<double> felt_couple;  ///< part of it that the tool feels [m^3]
  Vec3<double> extra;        ///< force that the tool feels and the field does not [m^2]
  double share;              ///< of second order, by the end of the series
  NearTerms near;
  Vec3<double> rhs;  ///< right-hand side with all loads [m]
};

/// The solved contact.
struct SolvedContact {
  Vec3<double> x;  ///< where it acts: a sphere's contact moves on the body [m]
  double a = 0;    ///< radius [m]
  Vec3<double> P;  ///< force [m^2]
  Moments y;       ///< loads that bond a wide patch [m^3]
};

/// What the drawing of the field reads.
struct DrawnContact {
  Indenter tool;       ///< x, a: where and how wide the near field is drawn
  Vec3<double> first;  ///< of a sphere: where it touches first [m]
  NearField near;

  [[nodiscard]] double displacement2() const noexcept { return tool.displacement2(); }
};

/// Constructs a stage where it is kept, without a copy.
template <class Stage, class Make>
void construct(Stage& at, const Make& make) noexcept {
  ::new (static_cast<void*>(std::addressof(at))) Stage(make());
}

/// Factor that bounds a displacement of length `size` by loads beside the force: the series in depth ends
/// where it is half of d. `displacement2`: Indenter::displacement2.
[[nodiscard]] inline double series_share(double size, double displacement2) noexcept {
  return smooth_limit(size * size, tick::max_load_displacement2 * displacement2);
}
/// Size of the displacement by a dipole and a couple, given those by unit loads. Not that of their sum: where
/// two large ones cancel each other, what is left is noise.
[[nodiscard]] inline double size_of_both(double by_dipole, double dipole, double by_couple,
                                         const Vec3<double>& couple) noexcept {
  return by_dipole * std::abs(dipole) + by_couple * couple.norm();
}

/// True when a contact has loads beside its force.
[[nodiscard]] inline bool has_loads(const Indenter& tool, const SecondOrderContact& second) noexcept {
  return second.dipole != 0 || tool.is_rotated();
}

}  // namespace palpate::detail
