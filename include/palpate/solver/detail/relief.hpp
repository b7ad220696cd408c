// SPDX-License-Identifier: MIT
#pragma once

/// @file What the dents that a tool's patches press take off each other's force (VI), for a topology of N
/// regions. The theory: contact/compliant_regions.hpp.

#include <palpate/contact/coupling.hpp>
#include <palpate/contact/detail/tool_patches.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/leaf_share.hpp>

#include <array>
#include <concepts>
#include <cstdint>
#include <span>

namespace palpate::detail {

/// A region that others relieve.
template <Real S>
struct RelievedSum : RegionSum<S> {
  S full = S(0);  ///< sum of |F_i| without the others [N]

  /// |force| without the others [N].
  [[nodiscard]] S full_normal_force() const noexcept {
    return this->magnitude > S(0) ? this->normal_force() * (full / this->magnitude) : full;
  }
};

/// Absent: where the coupling is not `CompliantRegions`.
template <class Coupling, std::size_t N, MassSharing Sharing, Real S>
class Relief {
 public:
  static constexpr bool active = false;
  using Sum = RegionSum<S>;
  Relief(const Coupling&, const ToolPoints<S>&, const ProximityGraph<S>&) noexcept {}
  template <class... Tick>
  [[nodiscard]] static AllLeft relieve(const Tick&...) noexcept {
    return {};
  }
  [[nodiscard]] static AllLeft left(AllLeft, std::uint32_t) noexcept { return {}; }
};

template <ComplianceRatio C, std::size_t N, MassSharing Sharing, Real S>
class Relief<CompliantRegions<C>, N, Sharing, S> {
 public:
  static constexpr bool active = true;
  using Sum = RelievedSum<S>;
  /// Of one tick.
  struct Tick {
    ToolPatches::List factor;  ///< of each patch's force [-]
    std::array<S, N> full;     ///< of each slot: sum of |F_i| without the others [N]
  };

  Relief(const CompliantRegions<C>& coupling, const ToolPoints<S>& tool, const ProximityGraph<S>& graph)
      : patches_(coupling.compliance, tool, graph, !std::same_as<Sharing, SurfacePressure>) {}

  /// From the leaves with touching points.
  template <ForceModel Force, class Leaf>
  [[nodiscard]] Tick relieve(const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                             std::span<const Leaf> touching,
                             const Leaves<Sharing, S>& leaves) const noexcept {
    std::array<S, N> norm{};
    for (const Leaf& leaf : touching) {
      for (std::size_t i = 0; i < batch_size; ++i)
        if (leaf.in.depth[i] > S(0)) norm[leaf.slot[i]] += S(1);
    }
    for (S& n : norm) n = n > S(0) ? Sharing::norm(n) : S(0);
    Tick tick;
    tick.full.fill(S(0));
    ToolPatches::List energy{};
    for (const Leaf& leaf : touching) {
      std::array<S, batch_size> U, f;
      leaves.alone(tool, leaf.begin, force, X, leaf.in, U, f);
      for (std::size_t i = 0; i < batch_size; ++i) {
        if (!(leaf.in.depth[i] > S(0))) continue;
        const std::size_t slot = leaf.slot[i];
        energy[patches_.of(leaf.begin + i)] += static_cast<double>(norm[slot] * U[i]);
        tick.full[slot] += norm[slot] * f[i];
      }
    }
    patches_.relieve(energy, tick.factor);
    return tick;
  }

  /// What is left of the forces of the leaf that begins at point `begin`.
  [[nodiscard]] std::array<S, batch_size> left(const Tick& tick, std::uint32_t begin) const noexcept {
    std::array<S, batch_size> part;
    for (std::size_t i = 0; i < batch_size; ++i)
      part[i] = static_cast<S>(tick.factor[patches_.of(begin + i)]);
    return part;
  }

 private:
  ToolPatches patches_;
};

}  // namespace palpate::detail
