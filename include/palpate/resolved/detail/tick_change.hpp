// SPDX-License-Identifier: MIT
#pragma once

/// @file What a tick begins with: how much of what the last one changed goes on.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/convex_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/touching_point.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <cstddef>
#include <limits>

namespace palpate::detail {

/// The share s by which loads and displacements go on, P + s dP and u + s du, so that the conditions of
/// contact are met best: least squares over the loaded points. Each, pressing along m, is to be displaced by
/// its depth along it; where it has an anchor a, it sticks to it, or slips with t + s dt along a - u - s du.
/// `given`: displacements by others' loads and by sway; `moved`: what the surface is displaced by besides.
template <bool has_friction, class Given>
[[nodiscard]] float share_that_goes_on(std::size_t n, const MemoryLists& last, const PointSystem& system,
                                       const Given& given, const Vec3<float>& moved) noexcept {
  using V = VectorList::V;
  constexpr float most = 3;  // a tick may change this many times what the last one did, or undo it
  const V zero(0.f), tiny((std::numeric_limits<float>::min)());
  const SimdVec3<V> all = each<V>(moved);
  V meets = zero, size2 = zero;
  for (std::size_t i = 0; i < n; i += V::size()) {
    const SimdVec3<V> mi = system.directions().load(i), u = last.u.load(i), du = last.u_step.load(i);
    const V loaded(&last.loaded[i]), goes = dot(mi, du);
    V meeting = (V(&system.depth[i]) - dot(mi, u)) * goes, going2 = goes * goes;
    if constexpr (has_friction) {
      const SimdVec3<V> off = across(mi, last.anchor.load(i) - given.load(i) - all - u),
                        step = across(mi, du), t = across(mi, last.load.load(i)),
                        dt = across(mi, last.load_step.load(i));
      const V t2 = dot(t, t), per_t = select(t2 > zero, inverse_sqrt((max)(t2, tiny)), zero),
              lacks = per_t * dot(mi, cross(t, off)),
              turns = per_t * dot(mi, cross(t, step) - cross(dt, off));
      const auto sticks = V(&last.sticks[i]) > zero;
      meeting += select(sticks, dot(step, off), lacks * turns);
      going2 += select(sticks, dot(step, step), turns * turns);
    }
    meets += loaded * meeting;
    size2 += loaded * going2;
  }
  const float whole = reduce(size2);
  return whole > 0 ? clamp(reduce(meets) / whole, -most, most) : 0.f;
}

/// The loads P + share dP; with friction also the anchors, less what the surface is displaced by besides:
/// `given` and `moved`, as above.
template <bool has_friction, class Given>
void begin_with(const PointSystem& system, const MemoryLists& last, float share, const Given& given,
                const Vec3<float>& moved, PressureLists& pressure, auto& result) noexcept {
  using V = VectorList::V;
  const SimdVec3<V> all = each<V>(moved);
  for (std::size_t i = 0; i < system.stride(); i += V::size()) {
    const SimdVec3<V> P = last.load.load(i) + V(share) * last.load_step.load(i);
    (max)(dot(system.directions().load(i), P), V(0.f)).copy_to(&pressure.q[i]);
    if constexpr (has_friction) {
      result.load.store(i, P);
      result.anchor.store(i, last.anchor.load(i) - given.load(i) - all);
      V(&last.loaded[i]).copy_to(&result.anchored[i]);
    }
  }
}

}  // namespace palpate::detail
