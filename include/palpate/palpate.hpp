// SPDX-License-Identifier: MIT
#pragma once

/// @file The paper's model in the order of the data flow. Three more cost compile time and are included on
/// their own: the short way in, <palpate/touch.hpp>; the response field,
/// <palpate/response/response_contact.hpp>; the extremal points of a mesh,
/// <palpate/geometry/mesh_extremal_points.hpp>. Include single headers where compile time matters.

// clang-format off
#include <palpate/version.hpp>
#include <palpate/config.hpp>

// geometry: the elastic object's undeformed surface
#include <palpate/geometry/concept.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/geometry/triangle_mesh.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/geometry/grown_surface.hpp>
#include <palpate/geometry/shared_surface.hpp>
#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/extremal_points.hpp>

// detection (III): which points of the tool touch
#include <palpate/detection/tool_points.hpp>
#include <palpate/detection/swept_pose.hpp>

// contact (II, III, IV.C): touching points to regions
#include <palpate/contact/contact_state.hpp>
#include <palpate/contact/topology.hpp>
#include <palpate/contact/coupling.hpp>

// law (IV): displacement to force, stick or slip, laws that vary over the object
#include <palpate/law/force/concept.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/force/tabulated.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/saturated.hpp>
#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/law/friction/slip.hpp>
#include <palpate/law/friction/skew.hpp>
#include <palpate/law/map/duffing_map.hpp>
#include <palpate/law/map/hertz_map.hpp>

// elasticity: the material, and what a deformation model must offer
#include <palpate/elasticity/isotropic.hpp>
#include <palpate/elasticity/concept.hpp>
#include <palpate/elasticity/none.hpp>

// luo_xiao (V, VI): the paper's body: beam skeleton, interpolation, local neighbourhood
#include <palpate/luo_xiao/beam/euler_bernoulli.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>
#include <palpate/luo_xiao/beam/section.hpp>
#include <palpate/luo_xiao/beam/rectangular_section.hpp>
#include <palpate/luo_xiao/beam/skeleton.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/luo_xiao/beam/end_release.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/luo_xiao/interpolation/smooth.hpp>
#include <palpate/luo_xiao/neighbourhood.hpp>
#include <palpate/luo_xiao/beam_skeleton.hpp>
#include <palpate/luo_xiao/make_beam_skeleton.hpp>

// resolved: contact solved at the tool's own points
#include <palpate/resolved/contact_points.hpp>
#include <palpate/resolved/elastic_contact.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/resolution.hpp>

// solver: one tick
#include <palpate/solver/contact_solver.hpp>
#include <palpate/solver/make_solver.hpp>
#include <palpate/solver/aliases.hpp>
#include <palpate/solver/stiffness.hpp>
#include <palpate/solver/largest_stiffness.hpp>
#include <palpate/solver/wrench_ramp.hpp>

// device: out to the hand
#include <palpate/device/device_model.hpp>
#include <palpate/device/stability_check.hpp>
#include <palpate/device/virtual_coupling.hpp>
#include <palpate/device/gate.hpp>
#include <palpate/device/passivity_controller.hpp>
#include <palpate/device/servo_statistics.hpp>
#include <palpate/device/spsc_ring.hpp>
#include <palpate/device/triple_buffer.hpp>
#include <palpate/device/workspace.hpp>
#include <palpate/device/servo_chain.hpp>
#include <palpate/device/recorder.hpp>
// clang-format on
