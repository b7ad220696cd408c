// SPDX-License-Identifier: MIT
#pragma once

/// @file What a force law with memory remembers of each region: advanced every tick, carried over when
/// regions merge or split, met again where a contact ended.

#include <palpate/contact/contact_state.hpp>
#include <palpate/contact/region_slot.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/law/force/concept.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace palpate::detail {

/// Of one region, or of one that was there.
template <StatefulForceLaw Law>
struct LawMemory {
  using S = typename Law::Scalar;
  typename Law::State state{};
  S weight{};                          ///< w, the greatest so far [-]
  S force{};                           ///< of the law without memory in the last tick [N]
  S depth{};                           ///< D of the last tick [m]
  Vec3<S> position = Vec3<S>::Zero();  ///< on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::Zero();    ///< outward, unit
  S area{};                            ///< that carried the force, the greatest so far [m^2]
  std::uint32_t id = 0;                ///< of the region
  bool kept = false;                   ///< there is something to remember
};

/// What stays where a region was: a contact without points and force whose displacement is the depth at which
/// the law gives no force in this state; nothing below the rounding of its position, which what relaxes
/// reaches.
template <StatefulForceLaw Law, class Contacts>
void add_dent(const Law& law, const LawMemory<Law>& m, Contacts& contacts) noexcept {
  using S = typename Law::Scalar;
  const S depth = m.kept ? law.depth(S(0), m.state) : S(0);
  if (!(depth > std::numeric_limits<S>::epsilon() * m.position.norm())) return;
  const Vec3<S> D = -depth * m.normal, zero = Vec3<S>::Zero();
  contacts.push_back(
      {m.id, 0, ContactMode::frictionless, m.position + D, m.normal, D, zero, zero, S(0), m.area, depth});
}
/// All of those in which nothing touches.
template <StatefulForceLaw Law, class Regions, std::size_t N, class Contacts>
void add_dents(const Law& law, const Regions& regions, const std::array<LawMemory<Law>, N>& memory,
               Contacts& contacts) noexcept {
  for (std::size_t k = 0; k < N; ++k)
    if (!regions.slot(k).active) add_dent(law, memory[k], contacts);
}

/// A tick of laws with memory, dt [s] long.
template <class Memory, Real S>
struct LawTick {
  Memory& memory;
  S dt;
};

/// The region's depth D [m] for the law: that of a flat one of its weight w with the same energy, w W(D) = E
/// = sum w_i W(d_i). With it the region's force F(D, s)/law(D) dE/dX is that of the potential w U(D, s) for a
/// constant state s, whatever the tool does, because dE = w law(D) dD; the depth of the same force has no
/// potential once the tool tilts. The weight only grows while the region lives, which takes energy: the set
/// reaches more of the body. Newton's method from above, where it converges steadily, W being convex; 30
/// steps bring any ratio of start and root below 2^30 home.
template <StatefulForceLaw Law, Real S, class Base>
[[nodiscard]] S depth_of(const Law& law, const EnergySum<S, Base>& sum, S weight) noexcept {
  S depth = sum.deepest;
  const S energy = sum.energy / weight;
  if (!(energy > S(0)) || !is_finite(energy)) return depth;
  for (int i = 0; i < 30; ++i) {
    const S force = law.force(depth);
    if (!(force > S(0))) break;
    const S step = (law.energy(depth) - energy) / force;
    depth = (std::max)(depth - step, depth / S(4));
    if (std::abs(step) <= S(4) * std::numeric_limits<S>::epsilon() * depth) break;
  }
  return depth;
}
template <StatefulForceLaw Law, Real S>
[[nodiscard]] S depth_of(const Law&, const PointForce<S>& sum, S /*weight*/) noexcept {
  return sum.deepest;
}
template <Real S, class Base>
[[nodiscard]] S weight_of(const EnergySum<S, Base>& sum) noexcept {
  return sum.weight();
}
template <Real S>
[[nodiscard]] S weight_of(const PointForce<S>&) noexcept {
  return S(1);
}

/// Where the region is on the undeformed surface, up to its curvature [m].
template <class Sum, Real S>
[[nodiscard]] Vec3<S> origin_of(const Sum& sum, S depth) noexcept {
  return sum.centre() + depth * sum.normal();
}

/// A new region in slot k takes over what a contact left nearest to it, within the law's extent; what slot k
/// held goes to a free slot if there is one.
template <StatefulForceLaw Law, class Regions, Real S, std::size_t N>
void recall(const Law& law, const Regions& regions, std::size_t k, const Vec3<S>& position,
            std::array<LawMemory<Law>, N>& memory) noexcept {
  std::size_t found = N, empty = N;
  if constexpr (HasExtent<Law>) {
    S nearest = law.extent();
    for (std::size_t j = 0; j < N; ++j) {
      if (j != k && regions.slot(j).active) continue;
      if (!memory[j].kept) {
        empty = j;
        continue;
      }
      const S distance = (memory[j].position - position).norm();
      if (!(distance <= nearest)) continue;
      nearest = distance;
      found = j;
    }
  }
  if (found < N) {
    if (found != k) std::swap(memory[found], memory[k]);
    return;
  }
  if (empty < N && empty != k) memory[empty] = memory[k];
  memory[k] = {};
}

/// The law's own way to merge states, or the one with the greatest share.
template <StatefulForceLaw Law>
[[nodiscard]] typename Law::State carried(const Law& law, std::span<const CarriedState<Law>> parts,
                                          typename Law::Scalar depth) noexcept {
  if constexpr (HasCarried<Law>) {
    return law.carried(parts, depth);
  } else {
    return std::max_element(parts.begin(), parts.end(),
                            [](const auto& a, const auto& b) { return a.share < b.share; })
        ->state;
  }
}

/// Carries states over when regions merge or split: each region takes the states of all its predecessors,
/// weighted with the force that it has of each, so that the force goes on; where that would store more than
/// they did, with the energy that it has of each: energy is convex in what the shipped laws remember, so none
/// is added.
template <StatefulForceLaw Law, class Regions, class Sum, std::size_t N>
void carry(const Law& law, const Regions& regions, const std::array<Sum, N>& sums,
           std::array<LawMemory<Law>, N>& memory) noexcept {
  using S = typename Law::Scalar;
  const std::array<LawMemory<Law>, N> last = memory;
  std::array<S, N> share{};  // of all that carry on region p: their energy [J]
  std::array<int, N> heirs{};
  for (std::size_t p = 0; p < N; ++p) {
    for (std::size_t k = 0; k < N; ++k) {
      if (!regions.slot(k).inherits(p)) continue;
      share[p] += sums[k].energy;
      ++heirs[p];
    }
  }
  for (std::size_t k = 0; k < N; ++k) {
    if (heirs[k] > 0 && !regions.slot(k).active) memory[k].kept = false;  // goes on elsewhere
  }
  for (std::size_t k = 0; k < N; ++k) {
    const RegionSlot& slot = regions.slot(k);
    if (!slot.active || (slot.merged == std::uint64_t(1) << k && heirs[k] == 1))
      continue;  // lives on unchanged
    FixedVector<CarriedState<Law>, N> parts;
    std::array<S, N> by_energy{};
    S force_sum = S(0), energy_sum = S(0), stored = S(0), weight = S(0);
    for (std::size_t p = 0; p < N; ++p) {
      if (!slot.inherits(p) || !(share[p] > S(0))) continue;
      const S fraction = sums[k].energy / share[p], depth = last[p].depth;
      by_energy[parts.size()] = fraction * last[p].weight * law.energy(depth);
      energy_sum += by_energy[parts.size()];
      stored += fraction * last[p].weight * law.energy(depth, last[p].state);
      weight += fraction * last[p].weight;
      parts.push_back({last[p].state, depth, fraction * last[p].force});
      force_sum += fraction * last[p].force;
    }
    if (!(energy_sum > S(0)) || !(force_sum > S(0))) continue;  // new, or from regions without depth
    weight = (std::max)(weight, weight_of(sums[k]));
    memory[k].weight = weight;
    const S depth = depth_of(law, sums[k], weight);
    for (CarriedState<Law>& part : parts) part.share /= force_sum;
    memory[k].state = carried(law, std::span<const CarriedState<Law>>(parts.begin(), parts.size()), depth);
    // Both as shares of the energy without memory, which the motion of this tick has changed.
    if (!(weight * law.energy(depth, memory[k].state) * energy_sum > stored * sums[k].energy)) continue;
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].share = by_energy[i] / energy_sum;
    memory[k].state = carried(law, std::span<const CarriedState<Law>>(parts.begin(), parts.size()), depth);
  }
}

/// What a tick begins with: states carried over mergers and splits, or met where a contact ended; where
/// nothing touches they go on by themselves.
template <StatefulForceLaw Law, class Regions, class Sum, Real S, std::size_t N>
void remember(const Law& law, const Regions& regions, S dt, const std::array<Sum, N>& sums,
              std::array<LawMemory<Law>, N>& memory) noexcept {
  if constexpr (N > 1) {
    if (regions.changed()) carry(law, regions, sums, memory);
  }
  for (std::size_t k = 0; k < N; ++k) {
    const RegionSlot& slot = regions.slot(k);
    if (slot.active && slot.merged == 0 && slot.parent == RegionSlot::none)
      recall(law, regions, k, origin_of(sums[k], sums[k].deepest), memory);
  }
  for (std::size_t k = 0; k < N; ++k) {
    LawMemory<Law>& m = memory[k];
    if (!regions.slot(k).active && m.kept) m.state = law.advance(m.state, S(0), dt);
  }
}

/// A tick of region `id`, which touches: its depth is D, and the state that of a region pressed to `felt`
/// [m].
template <StatefulForceLaw Law, class Sum, Real S>
[[nodiscard]] LawMemory<Law> advanced(const Law& law, const LawMemory<Law>& m, std::uint32_t id,
                                      const Sum& sum, S weight, S depth, S felt, S dt) noexcept {
  return {.state = law.advance(m.state, felt, dt),
          .weight = weight,
          .force = sum.normal_force(),
          .depth = depth,
          .position = origin_of(sum, sum.deepest),
          .normal = sum.normal(),
          .area = (std::max)(m.area, sum.area()),
          .id = id,
          .kept = true};
}

/// One tick of all that is remembered; scales each region's forces to what the law gives in its state.
template <StatefulForceLaw Law, class Regions, class Sum, Real S, std::size_t N>
void advance(const Law& law, const Regions& regions, S dt, std::array<Sum, N>& sums,
             std::array<LawMemory<Law>, N>& memory) noexcept {
  remember(law, regions, dt, sums, memory);
  for (std::size_t k = 0; k < N; ++k) {
    if (!regions.slot(k).active) continue;
    LawMemory<Law>& m = memory[k];
    const S weight = (std::max)(m.weight, weight_of(sums[k]));
    const S depth = depth_of(law, sums[k], weight), fresh = law.force(depth);
    m = advanced(law, m, regions.slot(k).id, sums[k], weight, depth, depth, dt);
    if (fresh > S(0)) sums[k].scale(law.force(depth, m.state) / fresh);
  }
}

}  // namespace palpate::detail
