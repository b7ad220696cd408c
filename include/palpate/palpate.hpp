// SPDX-License-Identifier: MIT
#pragma once

/// @file  The paper's model in the order of the data flow. Beside it stand two that cost compile time: the response field,
/// <palpate/response/response_contact.hpp>, and the extremal points of a mesh, <palpate/surface/mesh_extremal_points.hpp>.
/// Include single headers where compile time matters.

// clang-format off
#include <palpate/version.hpp>
#include <palpate/config.hpp>

// the elastic object's undeformed surface
#include <palpate/surface/concept.hpp>
#include <palpate/surface/sphere.hpp>
#include <palpate/surface/ellipsoid.hpp>
#include <palpate/surface/box.hpp>
#include <palpate/surface/cylinder.hpp>
#include <palpate/surface/superellipsoid.hpp>
#include <palpate/surface/triangle_mesh.hpp>
#include <palpate/surface/mesh_surface.hpp>
#include <palpate/surface/sampled_surface.hpp>
#include <palpate/surface/extremal_points.hpp>

// which points of the tool touch
#include <palpate/detection/tool_points.hpp>
#include <palpate/detection/deformed_surface.hpp>
#include <palpate/detection/swept_pose.hpp>

// touching points to regions
#include <palpate/region/topology.hpp>

// displacement to force
#include <palpate/force/concept.hpp>
#include <palpate/force/duffing.hpp>
#include <palpate/force/hertz.hpp>
#include <palpate/force/linear.hpp>
#include <palpate/force/power_law.hpp>
#include <palpate/force/tabulated.hpp>
#include <palpate/force/damped.hpp>
#include <palpate/force/saturated.hpp>

// stick or slip
#include <palpate/friction/concept.hpp>
#include <palpate/friction/none.hpp>
#include <palpate/friction/coulomb.hpp>
#include <palpate/friction/power_law.hpp>
#include <palpate/friction/slip.hpp>

// forces to the beams of a skeleton
#include <palpate/material/isotropic.hpp>
#include <palpate/beam/euler_bernoulli.hpp>
#include <palpate/beam/timoshenko.hpp>
#include <palpate/beam/section.hpp>
#include <palpate/beam/rectangular_section.hpp>
#include <palpate/beam/skeleton.hpp>
#include <palpate/beam/regions.hpp>
#include <palpate/beam/release.hpp>

// displacements of corners to vertices and normals
#include <palpate/interpolation/linear.hpp>
#include <palpate/interpolation/phong.hpp>
#include <palpate/interpolation/smooth.hpp>
#include <palpate/interpolation/neighbourhood.hpp>
#include <palpate/deformation/none.hpp>
#include <palpate/deformation/beam_skeleton.hpp>

// one tick
#include <palpate/solver/contact_solver.hpp>
#include <palpate/solver/duffing_map.hpp>
#include <palpate/solver/hertz_map.hpp>

// out to the hand
#include <palpate/device/energy_limit.hpp>
#include <palpate/device/gate.hpp>
#include <palpate/device/servo_statistics.hpp>
#include <palpate/device/spsc_ring.hpp>
#include <palpate/device/triple_buffer.hpp>
#include <palpate/device/workspace.hpp>
// clang-format on
