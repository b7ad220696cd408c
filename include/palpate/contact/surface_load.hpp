// SPDX-License-Identifier: MIT
#pragma once

/// @file What a resolved contact hands to a shape: a load on a part of the body's surface.

#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>

namespace palpate {

/// A force on a cell of the surface. A plain value in object coordinates, as ContactState is.
template <Real S>
struct SurfaceLoad {
  Vec3<S> position;                       ///< on the undeformed surface [m]
  Vec3<S> direction;                      ///< of pressing, into the body, unit
  Vec3<S> force;                          ///< on the body, seen from afar: with what makes it sway [N]
  S area;                                 ///< of the cell [m^2]
  Vec3<S> by_strain = Vec3<S>::Zero();    ///< finite strain: near it force + by_strain acts [N]
  Vec3<S> shift = Vec3<S>::Zero();        ///< finite strain: seen from afar it acts at position + shift [m]
  Vec3<S> tool_point = Vec3<S>::Zero();   ///< which of the tool presses there [m]
  Vec3<S> tool_normal = Vec3<S>::Zero();  ///< outward there, unit; 0: the shape may overlap with the tool
  S raised = S(0);                        ///< finite strain: its cell sinks by so much less [m]
};

/// Whether a body of Young's modulus E [Pa] can have it: position and direction as a pose's, an area of 1e-18
/// to 1e12 m^2, no component of the mean stress above 1e4 E, where E times depth over width is common.
template <Real S>
[[nodiscard]] inline bool is_usable(const SurfaceLoad<S>& load, S E) noexcept {
  return is_within(load.position, S(1e6)) && is_within(load.direction, S(2)) &&
         is_within(load.direction.squaredNorm() - S(1), S(1e-3)) && is_within(load.area, S(1e12)) &&
         load.area >= S(1e-18) && is_within(load.force, S(1e4) * E * load.area) &&
         is_within(load.by_strain, S(1e4) * E * load.area) && is_within(load.tool_point, S(1e6)) &&
         is_within(load.tool_normal, S(2)) && is_within(load.shift, S(1e6)) && is_within(load.raised, S(1e6));
}

}  // namespace palpate
