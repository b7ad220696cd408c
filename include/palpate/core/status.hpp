// SPDX-License-Identifier: MIT
#pragma once

/// @file  What a tick reports beside its numbers. Bits, so that the servo thread never branches on text.

#include <cstdint>

namespace palpate {

enum class Status : std::uint32_t {
  ok = 0,
  contact = 1u << 0,  ///< at least one point touches
  invalid_pose =
      1u << 1,  ///< NaN, infinite, absurd or not a rotation: the wrench is zero, contact is forgotten
  invalid_step = 1u << 2,     ///< dt is not finite or not > 0: rate-dependent terms are left out of this tick
  region_overflow = 1u << 3,  ///< more regions than the topology holds: the surplus joined the nearest one
  point_overflow = 1u << 4,   ///< more points touch than the topology holds: the surplus is left out
  beyond_reach = 1u << 5,     ///< deeper than the surface's reach: the closest point is not unique there
  beyond_stable = 1u << 6,    ///< past the force law's stable branch: the force is held at its maximum
  non_finite_result = 1u << 7,  ///< a law gave NaN or infinity: the wrench is zero
  held_back = 1u << 8,  ///< the tool would have gone through: it is kept on the side it came from (SweptPose)
  stress_bounded = 1u << 9,  ///< other regions' beams would have pulled: their stress force is bounded
  coarsened = 1u << 10,      ///< the tool has fewer points than it was given, to keep a budget of time
  unconverged = 1u << 11,    ///< a resolved contact's conditions are not met to ten times their tolerance
  near_field_only =
      1u << 12,  ///< a resolved contact where the body's response is no elastic body's (fixed at too few
                 ///< elements, too thin for them): as on a half-space, until the tool has left
  invalid_load = 1u << 13,  ///< a load is not finite or absurd (contact/surface_load.hpp): it is left out
};

[[nodiscard]] constexpr Status operator|(Status a, Status b) noexcept {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr Status& operator|=(Status& a, Status b) noexcept { return a = a | b; }
/// True when `all` has every bit of `asked`.
[[nodiscard]] constexpr bool has(Status all, Status asked) noexcept {
  return (static_cast<std::uint32_t>(all) & static_cast<std::uint32_t>(asked)) ==
         static_cast<std::uint32_t>(asked);
}

}  // namespace palpate
