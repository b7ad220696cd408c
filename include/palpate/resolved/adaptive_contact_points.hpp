// SPDX-License-Identifier: MIT
#pragma once

/// @file Topology of a resolved contact with as many points as it needs: a tool has points at two spacings,
/// and where few of the coarse ones touch the fine ones carry the load.

#include <palpate/detection/adaptive_tool.hpp>
#include <palpate/resolved/contact_points.hpp>

#include <cstddef>

namespace palpate {

/// As ContactPoints<N, Beside>, up to N points of either spacing. By n, the effective number of coarse points
/// beneath the surface, or of as many as the fine ones there stand for,
///
///     n = (sum delta)^2/sum delta^2,   t = 2 - n/6 between 0 and 1,   s = t^2 (3 - 2 t)
///
/// with delta their depths, the fine ones carry the share s of the load: all of it up to 6, none from 12 on.
/// A ball has 4 and 8 coarse points that carry load there, or 16 and 32 fine ones. In between both are
/// solved, and force, torque, shape, and what the points carry, are the sum of the shares. Elsewhere only one
/// of them is looked at; what a contact keeps, as where it sticks, goes from one to the other. 6 and 12 are
/// chosen: a ball's force is within 2 % rms then where eight fine points and more carry load, and a tick
/// takes no longer than with that tool deeper in the body.
template <std::size_t N, std::size_t Beside = 0>
struct AdaptiveContactPoints : ContactPoints<N, Beside> {
  static constexpr float all_fine = 6, all_coarse = 12;
  template <Real S>
  using Tool = AdaptiveTool<S>;
};

namespace detail {
template <std::size_t N, std::size_t Beside>
inline constexpr bool is_shipped_topology<AdaptiveContactPoints<N, Beside>> = true;
template <Real S>
struct DefaultTopology<AdaptiveTool<S>> {
  using type = AdaptiveContactPoints<256>;
};
}  // namespace detail

template <class T>
concept AdaptiveTopology = ResolvedTopology<T> && requires { T::all_fine, T::all_coarse; };

}  // namespace palpate
