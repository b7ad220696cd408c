// SPDX-License-Identifier: MIT
#pragma once

/// @file Topology of a resolved contact: every touching point of the tool carries a force of its own.

#include <palpate/contact/topology.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/detection/tool_points.hpp>

#include <cstdint>

namespace palpate {

/// Up to N points beneath the surface, of which half carry load when a ball is pressed; the tool is made of
/// `contact_samples`. Several contacts, edges, tilt and rolling need no rule of their own. With more than N
/// the surplus is left out (`Status::point_overflow`): the tool then is too fine. On a response field N
/// bounds the nodes of its load mesh beneath the tool, too, between 128 and 512. `Beside`: as many loads of
/// other tools on the same body are felt, those that `State::set_beside()` is given.
template <std::size_t N, std::size_t Beside = 0>
struct ContactPoints {
  static_assert(N >= 1 && N <= 1024, "palpate::ContactPoints<N>: 1 <= N <= 1024");
  static_assert(Beside <= 4096, "palpate::ContactPoints<N, Beside>: Beside <= 4096");
  static constexpr std::size_t max_regions = 1;
  static constexpr std::size_t max_points = N;
  static constexpr std::size_t max_beside = Beside;
  using Sharing = AreaSharing;
  template <Real S>
  using Tool = ToolPoints<S>;
};

namespace detail {
template <std::size_t N, std::size_t Beside>
inline constexpr bool is_shipped_topology<ContactPoints<N, Beside>> = true;
}  // namespace detail

template <class T>
concept ResolvedTopology = Topology<T> && requires { T::max_points, T::max_beside; };

/// What a point of the tool feels. With friction on a response field the wrench has a torque besides that of
/// these forces, at most some percent of it: tractions act beneath the points (docs/resolved.md).
template <Real S>
struct PointContact {
  std::uint32_t point;  ///< of the tool, its point(point)
  bool sticks;          ///< false where it slips or there is no friction
  Vec3<S> position;     ///< object coordinates [m]
  Vec3<S> normal;       ///< of the body, outward
  Vec3<S> force;        ///< on the tool [N]
  S pressure;           ///< normal force over the point's cell [Pa]
  S depth;              ///< beneath the undeformed surface [m]
};

}  // namespace palpate
