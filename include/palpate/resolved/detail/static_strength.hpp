// SPDX-License-Identifier: MIT
#pragma once

/// @file From static to sliding friction where a whole contact breaks away.

#include <palpate/core/scalar.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>

#include <algorithm>
#include <cmath>

namespace palpate::detail {

/// Static strength fades while the whole contact slides, and returns with the load that sticks. It fades
/// by e over twice the length by which the surface springs back when it is gone: so friction falls no faster
/// than it rose, however large the drop, and does not fall in a tick.
class StaticStrength {
 public:
  using V = VectorList::V;
  /// mu of every point: the law's limit for the normal force of the whole contact [N], over that; 0 for none.
  template <class Friction, Real S>
  [[nodiscard]] float coefficient(const Friction& friction, S normal) noexcept {
    if (!(normal > S(0))) return 0;
    const S highest = friction.static_limit(normal), sliding = friction.sliding_limit(normal);
    drop_ = highest > sliding ? static_cast<float>(1 - sliding / highest) : 0.f;
    return static_cast<float>(std::lerp(sliding, highest, static_cast<S>(left_)) / normal);
  }
  /// After a tick with the sum `total` of normal loads, of which `sticking` at points that stick; points that
  /// have just come in do not hold a contact. Returns whether the whole contact slides.
  bool remember(float total, float sticking, const PointSystem& system, const PressureLists& pressure,
                const FrictionLists& friction) noexcept {
    constexpr float sticks = 0.01f;  // of the load (chosen)
    if (!(total > 0) || sticking >= sticks * total) {
      left_ = (std::max)(left_, total > 0 ? sticking / total : 1.f);
      return false;
    }
    SimdVec3<V> slip{}, stretch{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i);
      const V q(&pressure.q[i]);
      const SimdVec3<V> u = across(m, friction.u.load(i));
      slip += (q * V(&friction.anchored[i])) * (across(m, friction.anchor.load(i)) - u);
      stretch += q * u;
    }
    const float spring = 2 * drop_ * sum_of(stretch).norm(), whole = spring + sum_of(slip).norm();
    if (whole > 0) left_ *= spring / whole;
    return true;
  }

 private:
  float left_ = 1;  // of static strength
  float drop_ = 0;  // 1 - mu_sliding / mu_static
};

}  // namespace palpate::detail
