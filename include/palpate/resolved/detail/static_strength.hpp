// SPDX-License-Identifier: MIT
#pragma once

/// @file From static to sliding friction where a whole contact breaks away.

#include <palpate/core/scalar.hpp>

#include <algorithm>
#include <cmath>

namespace palpate::detail {

/// Static strength fades while the whole contact slides, and returns with the load that sticks. It fades
/// by e over twice the length by which the surface springs back when it is gone: so friction falls no faster
/// than it rose, however large the drop, and does not fall in a tick.
class StaticStrength {
 public:
  /// mu for the normal force of the whole contact [N], > 0.
  template <class Friction, Real S>
  [[nodiscard]] float coefficient(const Friction& friction, S normal) noexcept {
    const S held = friction.static_limit(normal), sliding = friction.sliding_limit(normal);
    drop_ = held > sliding ? static_cast<float>(1 - sliding / held) : 0.f;
    return static_cast<float>(std::lerp(sliding, held, static_cast<S>(left_)) / normal);
  }
  /// After a tick in which points stuck that carry this share of the load.
  void hold(float share) noexcept { left_ = (std::max)(left_, share); }
  /// After a tick in which the whole contact slid by `slip` and the surface is stretched by `stretch`, any
  /// unit.
  void fade(float slip, float stretch) noexcept {
    const float spring = 2 * drop_ * stretch, whole = spring + slip;
    if (whole > 0) left_ *= spring / whole;
  }

 private:
  float left_ = 1;  // of static strength
  float drop_ = 0;  // 1 - mu_sliding / mu_static
};

}  // namespace palpate::detail
