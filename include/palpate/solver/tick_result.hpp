// SPDX-License-Identifier: MIT
#pragma once

/// @file What a tick returns, and where the contact force acts.

#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>

#include <concepts>

namespace palpate {

/// Where the contact force acts on the tool.
struct AtContact {};     ///< at the pressure centre: the wrench has a torque about the centre of mass (6 DOF)
struct AtMassCentre {};  ///< at the centre of mass, the paper's assumption (section II): no torque

template <class W>
concept WrenchPolicy = std::same_as<W, AtContact> || std::same_as<W, AtMassCentre>;

/// What a tick returns. The regions behind it: ContactSolver::contacts().
template <Real S>
struct TickResult {
  Wrench<S> wrench;  ///< on the tool, object coordinates: force [N], torque about its centre of mass [N m]
  Status status;
};

/// What a tick of a moving object returns, in world coordinates.
template <Real S>
struct WorldResult {
  Wrench<S> tool;    ///< on the tool: force [N], torque about its centre of mass [N m]
  Wrench<S> object;  ///< the reaction on the object: - force [N], torque about its own origin [N m]
  Status status;
};

}  // namespace palpate
