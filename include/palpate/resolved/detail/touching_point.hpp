// SPDX-License-Identifier: MIT
#pragma once

/// @file What a tick knows of the tool's points.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::detail {

/// What a point of the tool has kept of the last tick.
struct PointMemory {
  std::uint32_t tick = 0;                    ///< when it touched
  bool loaded = false;                       ///< in that tick
  bool sticks = false;                       ///< likewise
  float sunk = 0;                            ///< depth less what it lacks to touch [m]
  float held = 0;                            ///< of the depth: what kept it out when w was left out [m]
  std::uint32_t triangle = ~0u;              ///< of the load mesh
  Vec3<float> load = Vec3<float>::Zero();    ///< P on the body [m^2]
  Vec3<float> u = Vec3<float>::Zero();       ///< displacement [m]
  Vec3<float> load_step = load, u_step = u;  ///< what the tick changed
  /// Where it holds the surface; along the direction of pressing what the surface is displaced by, for that
  /// turns as the contact moves on a curved body [m].
  Vec3<float> anchor = Vec3<float>::Zero();

  /// Is beneath the surface in tick `now`.
  void touch(std::uint32_t now) noexcept {
    if (tick + 1 != now) *this = {};
    tick = now;
  }
  /// After a tick, before `loaded` is this tick's.
  void go_on(const Vec3<float>& new_load, const Vec3<float>& new_u) noexcept {
    load_step = loaded ? Vec3<float>(new_load - load) : Vec3<float>::Zero();
    u_step = loaded ? Vec3<float>(new_u - u) : Vec3<float>::Zero();
    load = new_load, u = new_u;
  }
};

/// The same of the points that a tick solves for, for registers.
struct MemoryLists {
  VectorList load, u, load_step, u_step, anchor;
  AlignedList<float> loaded, sticks;  ///< 1, or 0

  void resize(std::size_t size) {
    for (auto* list : {&load, &u, &load_step, &u_step, &anchor}) list->resize(size);
    for (auto* list : {&loaded, &sticks}) list->resize(size);
  }
  void set(std::size_t i, const PointMemory& p) noexcept {
    load.set(i, p.load), u.set(i, p.u);
    load_step.set(i, p.load_step), u_step.set(i, p.u_step);
    anchor.set(i, p.anchor);
    loaded[i] = p.loaded ? 1.f : 0.f;
    sticks[i] = p.sticks ? 1.f : 0.f;
  }
};

/// A point that is beneath the surface in this tick.
struct TouchingPoint {
  std::uint32_t point;  ///< of the tool
  float depth;          ///< along m [m]
  Vec3<float> x;        ///< where friction has not carried the surface, from the tick's origin [m]
  Vec3<float> m;        ///< the surface's inward normal
  Vec3<float> outward;  ///< the tool's normal; m where it is not known
  std::uint32_t group;  ///< of points that lie side by side (PointSystem::touch)
  float shifted = 0;    ///< of the body's shift, by which x is where the body was not bent
};

/// With how much of its depth a point presses, from the product of the tool's normal and the surface's inward
/// one. What faces away from the body cannot press on it; a wall fades out over some ten degrees, and is out
/// before it is upright: rounding would bring it in and out.
template <SimdOrReal W>
[[nodiscard]] PALPATE_INLINE W facing_share(const W& product) noexcept {
  constexpr float upright = 1e-4f, whole = 0.2f;
  return clamp(W(1 / whole) * (product - W(upright)), 0.f, 1.f);
}

}  // namespace palpate::detail
