// SPDX-License-Identifier: MIT
#pragma once

/// @file What a tick knows of the tool's points.

#include <palpate/core/vector.hpp>

#include <cstdint>

namespace palpate::detail {

/// What a point of the tool has kept of the last tick.
struct PointMemory {
  std::uint32_t tick = 0;                    ///< when it touched
  bool loaded = false;                       ///< in that tick
  bool sticks = false;                       ///< likewise
  float sunk = 0;                            ///< depth less what it lacks to touch [m]
  std::uint32_t triangle = ~0u;              ///< of the load mesh
  Vec3<float> load = Vec3<float>::Zero();    ///< P on the body [m^2]
  Vec3<float> u = Vec3<float>::Zero();       ///< displacement [m]
  Vec3<float> load_step = load, u_step = u;  ///< what the tick changed
  Vec3<float> anchor = Vec3<float>::Zero();  ///< where it holds the surface [m]

  /// After a tick, before `loaded` is this tick's.
  void go_on(const Vec3<float>& new_load, const Vec3<float>& new_u) noexcept {
    load_step = loaded ? Vec3<float>(new_load - load) : Vec3<float>::Zero();
    u_step = loaded ? Vec3<float>(new_u - u) : Vec3<float>::Zero();
    load = new_load, u = new_u;
  }
};

/// A point that is beneath the surface in this tick.
template <Real S>
struct TouchingPoint {
  std::uint32_t point;  ///< of the tool
  Vec3<S> x;            ///< where friction has not carried the surface, object coordinates [m]
  Vec3<float> m;        ///< the surface's inward normal
  float depth;          ///< along it [m]
};

}  // namespace palpate::detail
