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
  float sunk = 0;                            ///< depth less what it lacks to touch [m]
  std::uint32_t triangle = ~0u;              ///< of the load mesh
  Vec3<float> load = Vec3<float>::Zero();    ///< P on the body [m^2]
  Vec3<float> anchor = Vec3<float>::Zero();  ///< where it holds the surface [m]
};

/// A point that is beneath the surface in this tick.
template <Real S>
struct TouchingPoint {
  std::uint32_t point;  ///< of the tool
  Vec3<S> x;            ///< object coordinates [m]
  Vec3<float> m;        ///< the surface's inward normal
  float depth;          ///< along it [m]
};

}  // namespace palpate::detail
