// SPDX-License-Identifier: MIT
#pragma once

/// @file Chosen constants of a response field's tick: bounds, ranges of validity, transitions. None is
/// fitted; those that are fitted are in response/second_order.hpp.
///
/// Bounds keep force and field finite and continuous on coarse meshes, thin parts and coinciding contacts;
/// where the mesh resolves the body they hardly act (docs/response_field.md, "Bounds").
///
/// Lengths are in patch radii a, displacements in the contact's displacement d, compliances in the
/// half-space's, unless a unit stands there. "Half" as a bound of a vector u means smooth_limit(u^2, (d /
/// 2)^2), and so on.

namespace palpate::detail::tick {

// Least compliances of contacts (contact_system.hpp), over the smaller compliance of the half-space.
inline constexpr double min_compliance = 0.1;           ///< of a mode of one contact
inline constexpr double min_coupled_compliance = 0.05;  ///< of a mode of several contacts
/// The same of a mode of several contacts, over the sum of all compliances, as no mesh resolves a smaller
/// part. On a plate that bends easily, such a mode is a small difference of large numbers, and the forces of
/// two contacts would jump.
inline constexpr double min_resolved_compliance = 1e-4;
/// tr(S_i K S_j K^T) of a coupling K: at most 3 by energy, as all singular values are below 1.
inline constexpr double max_coupling = 3;

// Series in depth (linear_loads.hpp, second_order_loads.hpp): the series has ended where the displacement by
// the loads beside the force exceeds half of d, or takes more than half of the force.
inline constexpr double max_load_displacement2 = 0.25;  ///< (1/2)^2 of d^2
inline constexpr double max_load_force2 = 0.25;         ///< (1/2)^2 of P^2
/// Square of the part of a compliance that a bonded patch's dipole and couples may take: a half. In theory
/// they take less than all of it.
inline constexpr double max_bonded_part2 = 0.25;
inline constexpr double max_depth = 2;  ///< d_n / a and beta: the deepest reference
/// The radial dipole and the near terms take up to this many half-space's forces for d; the universal forces
/// take one. Chosen on the slabs, whose force is 1.4 times the half-space's.
inline constexpr double max_force_ratio = 2;

// Torsional stiffness (linear_loads.hpp): range of H a, H the mean curvature, for which its first order is
// used.
inline constexpr double min_curvature = -0.5, max_curvature = 1;

// Wide patches (patch_moments.hpp), by a over the length of the boundary element mesh's edges.
inline constexpr double narrow_patch = 1;             ///< below it the slopes of w suffice
inline constexpr double wide_patch = 1.5;             ///< from it on five loads bond the patch
inline constexpr double min_moment_compliance = 0.1;  ///< eigenvalue of D, of the half-space's

// Several contacts (ContactSystem): a contact that comes in where others have moved the surface by u.
/// The contact is wholly active where the part of d that is left, 1 - u.d/d^2, is at least this.
inline constexpr double active_from = 0.25;
/// A contact is inactive while d is small against u: (1/10)^2 of u^2 is compared with d^2.
inline constexpr double moved_share2 = 0.01;

// Distance from the surface (placement.hpp).
/// A patch's node is left out where its weight is below this.
inline constexpr double min_node_weight = 1e-12;
/// Depth at which the field of a disc is taken that stands for a mean over a patch [radii]. A disc's own
/// field has an infinite slope at its edge, a mean over a patch has not.
inline constexpr double mean_disc_depth = 0.05;

// Near field (near_field.hpp). Outside a patch, the patch's own displacement of second order is subtracted
// with powers of a/r. They fall to 1 % at two radii, so nothing changes far away. Chosen on the half-space.
//   a push: s^-8; a slope: s^-7 times r/a
inline constexpr float min_distance2 = 1e-12f;  ///< r^2 / a^2: keeps a/r finite on the axis
/// A sphere's dipole is drawn with the factor (1 - s^-6) / (1 + 0.9 s^-2 + 0.7 s^-4), chosen with its other
/// near terms. The closed form's own field over s^-2 is less than the divisor: 1.09 at s = 2, 2.36 at the
/// rim.
inline constexpr float hertz_dipole_2 = 0.9f, hertz_dipole_4 = 0.7f;
/// Least nu/(1-nu) by which the near term's pole is set; at nu = 0 there is no dipole.
inline constexpr double min_dipole_ratio = 0.01;

// Rotation correction (rotation_correction.hpp): 0 up to one radius, 1 from here on [radii].
inline constexpr double rotation_from = 1, rotation_to = 1.5;
inline constexpr double max_rotation_field2 = 4;  ///< (2 d)^2
inline constexpr double max_load_field2 = 4;      ///< (2 d)^2: field of the loads beside the force
inline constexpr double max_field2 = 16;  ///< (4 d)^2: a body moves farther than the tool by its levers

// Display (drawing.hpp, mid_edge_correction.hpp), in edges of the boundary element mesh.
inline constexpr double mid_edge_reach =
    2.5;  ///< on 16 references 2 has 0.03 % more error, 3 and 4 0.01 % less
inline constexpr double near_field_reach = 1;  ///< 3/4 saves 4 us and costs 0.05 % of error
inline constexpr float reach_fade = 0.25f;     ///< last part of a reach, over which what is drawn fades
inline constexpr double max_vertex_correction = 0.5;  ///< of d: 2 (d / 4), see VertexCorrection
inline constexpr float patch_edge =
    0.02f;  ///< over this last part of a patch its motion goes over to the field's

// Sphere (pressed_sphere.hpp, sphere_contact.hpp).
inline constexpr double max_contact_radius = 0.95;      ///< a / R
inline constexpr double max_body_share = 0.5;           ///< of d_H: the part that a stiff layer may add
inline constexpr double min_relative_curvature = 1e-3;  ///< of 1 / R_s: a hollow that fits is a plane to it
inline constexpr double max_lean2 = 0.0625;             ///< (1/4)^2: force across, of the normal force
inline constexpr double max_lean_feedback2 = 0.25;  ///< (1/2)^2: norm of what that force does to w_t and s
inline constexpr double max_center_shift2 = 0.25;   ///< (1/2)^2 of a^2
inline constexpr double max_lift2 = 0.01;           ///< (1/10)^2 of d^2
inline constexpr double max_stiffening = 0.25;      ///< of the half-space's compliance
inline constexpr int sphere_passes = 3;  ///< they suffice: the quantities depend weakly on each other

}  // namespace palpate::detail::tick
