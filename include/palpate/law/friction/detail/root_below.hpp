// SPDX-License-Identifier: MIT
#pragma once

/// @file  A bracketed root of a function of one number, for skew rules without a closed form.

#include <palpate/core/scalar.hpp>

#include <algorithm>
#include <limits>

namespace palpate {

namespace detail {
/// Root of g on [0, high], or the lower end of an epsilon around it. g changes sign once there, from <= 0 to
/// g(high) > 0. False position with the stale end's value reduced [anderson1973]. The bracket is halved where
/// false position has not halved it in four steps, or where g is 0 at the lower end, as it may be at 0
/// itself. At most 240 steps: four for each halving down to a double's epsilon, and some.
template <Real S, class G>
[[nodiscard]] S root_below(S high, const G& g) noexcept {
  constexpr S epsilon = std::numeric_limits<S>::epsilon();
  S low = S(0), at_low = g(S(0)), at_high = g(high), goal = high;  // goal: what the bracket must be below
  S least = epsilon;  // of high: distance from the ends, so that the bracket closes on both sides
  int stale = 0;
  bool last_was_high = false;
  for (int i = 0; i < 240 && high - low > epsilon * high; ++i) {
    const S width = high - low;
    stale = width <= goal ? 0 : stale + 1;
    if (stale == 0) goal = width / S(2);
    S x = low + width / S(2);
    if (at_low < S(0) && stale < 4) {
      const S off = (std::min)(least * high, width / S(2));
      x = std::clamp(high - at_high / (at_high - at_low) * width, low + off, high - off);
    }
    const S value = g(x);
    if (value == S(0)) return x;
    const bool is_high = value > S(0);
    S& replaced = is_high ? at_high : at_low;
    if (i > 0 && is_high == last_was_high) {
      const S reduced = S(1) - value / replaced;
      (is_high ? at_low : at_high) *= reduced > S(0) ? reduced : S(0.5);
      least *= S(8);
    } else {
      least = epsilon;
    }
    last_was_high = is_high;
    replaced = value;
    (is_high ? high : low) = x;
  }
  return low;
}
}  // namespace detail

}  // namespace palpate
