// SPDX-License-Identifier: MIT
#pragma once

/// @file Contact topology: how many contact regions a scene can have (sections II and III).
///
/// | shipped                    | regions                  | tool           | use it when                |
/// |----------------------------|--------------------------|----------------|----------------------------|
/// | `SinglePoint`              | 1, of one point          | `PointTool`    | a stylus tip; the cheapest |
/// | `SingleRegion`             | 1, all points that touch | `ToolPoints`   | a tool with one patch      |
/// | `Regions<N>`               | up to N, clustered by r  | `ToolPoints`   | the general case           |
/// | `Coarse<T>`                | as T, of the last two    | `CoarseTool`   | a tick has a budget        |
/// | `ContactPoints<N>`         | none: see resolved/      | `ToolPoints`   | accuracy, any tool         |
/// | `AdaptiveContactPoints<N>` | the same                 | `AdaptiveTool` | light touch, too           |
///
/// With regions, the surplus over N joins the nearest region and `Status::region_overflow` is set. The normal
/// force is a sum over points and does not depend on the clustering; only friction does.

#include <palpate/contact/mass_sharing.hpp>
#include <palpate/detection/coarse_tool.hpp>
#include <palpate/detection/tool_points.hpp>

#include <concepts>
#include <cstddef>

namespace palpate {

struct SinglePoint {
  static constexpr std::size_t max_regions = 1;
  using Sharing = AreaSharing;
  template <Real S>
  using Tool = PointTool<S>;
};

template <MassSharing W = SurfacePressure>
struct SingleRegion {
  static constexpr std::size_t max_regions = 1;
  using Sharing = W;
  template <Real S>
  using Tool = ToolPoints<S>;
};

/// Regions are the connected components of the graph that joins touching points nearer than `distance`.
template <std::size_t N, MassSharing W = SurfacePressure>
struct Regions {
  static_assert(N >= 1 && N <= 64, "palpate::Regions<N>: 1 <= N <= 64");
  static constexpr std::size_t max_regions = N;
  using Sharing = W;
  template <Real S>
  using Tool = ToolPoints<S>;

  double distance;  ///< threshold r [m] of section II: points strictly nearer than r belong together
};

/// Topology T for a tool that was made coarse at set-up, so that no tick takes longer than the user's budget.
/// Each tick of a tool that has lost points says so: `Status::coarsened`.
template <class T>
struct Coarse : T {
  static_assert(T::max_regions > 0 && std::same_as<typename T::template Tool<double>, ToolPoints<double>>,
                "palpate::Coarse<T>: T is SingleRegion or Regions<N>");
  template <Real S>
  using Tool = CoarseTool<S>;
};

namespace detail {
template <class T>
inline constexpr bool is_shipped_topology = false;
template <>
inline constexpr bool is_shipped_topology<SinglePoint> = true;
template <MassSharing W>
inline constexpr bool is_shipped_topology<SingleRegion<W>> = true;
template <std::size_t N, MassSharing W>
inline constexpr bool is_shipped_topology<Regions<N, W>> = true;
template <class T>
inline constexpr bool is_shipped_topology<Coarse<T>> = is_shipped_topology<T>;
/// What suits a tool where nothing is said.
template <class Tool>
struct DefaultTopology {
  using type = SingleRegion<>;
};
template <Real S>
struct DefaultTopology<PointTool<S>> {
  using type = SinglePoint;
};
template <Real S>
struct DefaultTopology<CoarseTool<S>> {
  using type = Coarse<SingleRegion<>>;
};
template <class Tool>
using TopologyOf = typename DefaultTopology<Tool>::type;
}  // namespace detail

/// One of those above: the solver knows how to collect points for these and for no other.
template <class T>
concept Topology = detail::is_shipped_topology<T>;

/// True for topologies that cluster (`Regions<N>`).
template <class T>
concept ClusteredTopology = Topology<T> && requires(const T& t) {
  { t.distance } -> std::convertible_to<double>;
};

static_assert(Topology<SinglePoint> && Topology<SingleRegion<>> && ClusteredTopology<Regions<4>>);

}  // namespace palpate
