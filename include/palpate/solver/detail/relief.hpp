// SPDX-License-Identifier: MIT
#pragma once

/// @file What the dents that a tool's patches press take off each other's force (VI), for a topology of N
/// regions. The theory: contact/compliant_regions.hpp.

#include <palpate/contact/coupling.hpp>
#include <palpate/contact/detail/tool_patches.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/law_memory.hpp>
#include <palpate/solver/detail/leaf_share.hpp>
#include <palpate/solver/detail/tick_sums.hpp>

#include <algorithm>
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

/// R/W [-] at the depth D [m]: what is given back if the tool leaves in this state, over the energy without
/// memory.
template <StatefulForceLaw Law, Real S>
[[nodiscard]] S given_back(const Law& law, const typename Law::State& state, S depth) noexcept {
  const S free = law.depth(S(0), state), energy = law.energy(depth);
  if (!(depth > free) || !(energy > S(0))) return S(0);
  return (std::max)(law.energy(depth, state) - law.energy(free, state), S(0)) / energy;
}

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
  [[nodiscard]] static AllLeft left(AllLeft, std::uint32_t, std::size_t) noexcept { return {}; }
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

  struct MemoryTick {
    std::array<ToolPatches::List, N> factor;  ///< of each region's force in each patch [-]
    std::array<S, N> full;
  };

  Relief(const CompliantRegions<C>& coupling, const ToolPoints<S>& tool, const ProximityGraph<S>& graph)
      : patches_(coupling.compliance, tool, graph, !std::same_as<Sharing, SurfacePressure>) {}

  /// From the leaves with touching points.
  template <ForceModel Force, class Leaf, class Regions, class Sums>
  [[nodiscard]] Tick relieve(const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                             std::span<const Leaf> touching, const Leaves<Sharing, S>& leaves, const Regions&,
                             const Sums&) const noexcept {
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

  /// The same of a law with memory, and a tick of all that is remembered. In a state s region k gives back
  /// R_k = U(D, s) - U(D_free, s) from its depth D, of the W(D) that it has without memory; its patches'
  /// shares of that are their energies U_j. With f_j = x_j/e_j a state goes on at the depth
  ///
  ///     D' = D_free + f (D - D_free),   f = sum f_j U_j / R_k
  ///
  /// so that it loses energy: W + sum U(D_free, s) falls at a pose by what each region loses at D'
  /// (docs/contact.md). The force is that of W at constant states: of a point in patch j its own times
  ///
  ///     f_j R_k/W + f (F(D, s)/F(D) - R_k/W)
  template <StatefulForceLaw Law, class Leaf, class Regions, class Sums, class Memory>
  [[nodiscard]] MemoryTick relieve(const ToolPoints<S>& tool, const Law& law, const Pose<S>& X,
                                   std::span<const Leaf> touching, const Leaves<Sharing, S>& leaves,
                                   const Regions& regions, const Sums& sums,
                                   const LawTick<Memory, S>& tick) const noexcept {
    remember(law, regions, tick.dt, sums, tick.memory);
    std::array<ToolPatches::List, N> energy{};  // of each region in each patch, without memory [J]
    for (const Leaf& leaf : touching) {
      std::array<S, batch_size> U, f;
      leaves.alone(tool, leaf.begin, law, X, leaf.in, U, f);
      for (std::size_t i = 0; i < batch_size; ++i)
        if (leaf.in.depth[i] > S(0)) energy[leaf.slot[i]][patches_.of(leaf.begin + i)] += double(U[i]);
    }
    std::array<S, N> weight{}, depth{}, share{};  // w, D [m], R/W
    std::array<double, N> mean{};                 // f
    ToolPatches::List factor;                     // f_j
    const auto solve = [&]() noexcept {
      ToolPatches::List total{};
      for (std::size_t k = 0; k < N; ++k) {
        if (!regions.slot(k).active) continue;
        share[k] = given_back(law, tick.memory[k].state, depth[k]);
        const double scale = double(share[k] * Sharing::norm(static_cast<S>(sums[k].points)));
        for (std::size_t j = 0; j < patches_.size(); ++j) total[j] += scale * energy[k][j];
      }
      patches_.relieve(total, factor);
      for (std::size_t k = 0; k < N; ++k) {
        double all = 0, left = 0;
        for (std::size_t j = 0; j < patches_.size(); ++j)
          all += energy[k][j], left += factor[j] * energy[k][j];
        mean[k] = all > 0 ? left / all : 1;
      }
    };
    for (std::size_t k = 0; k < N; ++k) {
      if (!regions.slot(k).active) continue;
      weight[k] = (std::max)(tick.memory[k].weight, weight_of(sums[k]));
      depth[k] = depth_of(law, sums[k], weight[k]);
    }
    solve();
    for (std::size_t k = 0; k < N; ++k) {
      if (!regions.slot(k).active) continue;
      LawMemory<Law>& m = tick.memory[k];
      const S free = law.depth(S(0), m.state);
      const S felt = mean[k] < 1 && depth[k] > free ? free + S(mean[k]) * (depth[k] - free) : depth[k];
      m = advanced(law, m, regions.slot(k).id, sums[k], weight[k], depth[k], felt, tick.dt);
    }
    solve();
    MemoryTick left;
    left.full.fill(S(0));
    for (std::size_t k = 0; k < N; ++k) {
      if (!regions.slot(k).active) continue;
      const S fresh = law.force(depth[k]);
      const S own = fresh > S(0) ? law.force(depth[k], tick.memory[k].state) / fresh : S(0);
      for (std::size_t j = 0; j < patches_.size(); ++j)
        left.factor[k][j] = (std::max)(0.0, factor[j] * double(share[k]) + mean[k] * double(own - share[k]));
      left.full[k] = own * sums[k].magnitude;
    }
    return left;
  }

  /// What is left of the forces of the leaf that begins at point `begin`, in region `slot`.
  [[nodiscard]] std::array<S, batch_size> left(const Tick& tick, std::uint32_t begin,
                                               std::size_t) const noexcept {
    return of_points(tick.factor, begin);
  }
  [[nodiscard]] std::array<S, batch_size> left(const MemoryTick& tick, std::uint32_t begin,
                                               std::size_t slot) const noexcept {
    return of_points(tick.factor[slot], begin);
  }
  [[nodiscard]] static AllLeft left(AllLeft, std::uint32_t, std::size_t) noexcept { return {}; }

 private:
  [[nodiscard]] std::array<S, batch_size> of_points(const ToolPatches::List& of_patches,
                                                    std::uint32_t begin) const noexcept {
    std::array<S, batch_size> part;
    for (std::size_t i = 0; i < batch_size; ++i) part[i] = static_cast<S>(of_patches[patches_.of(begin + i)]);
    return part;
  }

  ToolPatches patches_;
};

/// collect() of a law with memory, and a tick of all that is remembered.
template <class Collector, class Object, class Tool, StatefulForceLaw Law, Real S, class Regions, class Sum,
          std::size_t N>
Status collect_and_remember(const Collector& collector, const Object& object, const Tool& tool,
                            const Law& law, const Pose<S>& X, S dt, Regions& regions,
                            std::array<LawMemory<Law>, N>& memory, TickSums<Sum, N>& sums) noexcept {
  constexpr bool relieved = std::derived_from<Sum, RelievedSum<S>>;
  sums.begin();
  Status status;
  if constexpr (relieved) {
    status = collector.collect(object, tool, law, X, regions, sums,
                               LawTick<std::array<LawMemory<Law>, N>, S>{memory, dt});
  } else {
    status = collector.collect(object, tool, law, X, regions, sums);
  }
  if (!relieved || !has(status, Status::contact)) advance(law, regions, dt, sums.list(), memory);
  return status;
}

}  // namespace palpate::detail
