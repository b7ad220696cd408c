// SPDX-License-Identifier: MIT
#pragma once

/// @file What friction remembers of a region, and how that is carried over when regions merge or split.

#include <palpate/contact/region_slot.hpp>
#include <palpate/law/friction/anchor.hpp>
#include <palpate/law/map/concept.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace palpate::detail {

/// Of one region, from tick to tick.
template <Real S>
struct FrictionMemory {
  Anchor<S> anchor;
  Vec3<S> friction;  ///< of the last tick [N]
  S depth;           ///< D_n of the last tick [m]
};

/// Each region takes the share of every predecessor's tangential force and elastic energy that its normal
/// force is of all of that predecessor's successors; so the sum of the forces is kept and no energy is added.
/// `regions`: the collector's state, whose slots say who inherits from whom; `sums`: this tick's, by slot.
template <FrictionLaw Friction, ForceModel Force, class Regions, class Sum, Real S, std::size_t N>
void inherit(const Friction& law_of_friction, const Force& force, const Regions& regions,
             const std::array<Sum, N>& sums, const Pose<S>& X,
             std::array<FrictionMemory<S>, N>& memory) noexcept {
  using Skew = typename Friction::Skew;
  const std::array<FrictionMemory<S>, N> last = memory;
  std::array<S, N> share{};  // of the predecessors' total normal force
  std::array<int, N> heirs{};
  for (std::size_t p = 0; p < N; ++p) {
    for (std::size_t k = 0; k < N; ++k) {
      if (!regions.slot(k).inherits(p)) continue;
      share[p] += sums[k].magnitude;
      ++heirs[p];
    }
  }
  for (std::size_t k = 0; k < N; ++k) {
    const RegionSlot& slot = regions.slot(k);
    if (!slot.active || (slot.merged == std::uint64_t(1) << k && heirs[k] == 1))
      continue;  // lives on unchanged
    Vec3<S> friction = Vec3<S>::Zero(), point_T = Vec3<S>::Zero(), tip = Vec3<S>::Zero(),
            normal = Vec3<S>::Zero();
    S weight = S(0), strength = S(1), energy = S(0);
    bool sliding = false;
    for (std::size_t p = 0; p < N; ++p) {
      if (!slot.inherits(p) || !(share[p] > S(0))) continue;
      const Anchor<S>& before = last[p].anchor;
      const S fraction = sums[k].magnitude / share[p];
      const S w = fraction * last[p].friction.norm() + std::numeric_limits<S>::epsilon() * sums[k].magnitude;
      friction += fraction * last[p].friction;
      point_T += w * before.point_T;
      tip += w * before.tip;
      normal += w * before.normal;
      weight += w;
      const S stretched = tangential<S>(before.tip - before.origin, before.normal).norm();
      energy +=
          fraction * before.slip.springs * Skew::energy(law_at(force, before.tip), last[p].depth, stretched);
      strength = (std::max)(strength, before.slip.strength);
      sliding = sliding || before.slip.sliding;
    }
    Anchor<S>& anchor = memory[k].anchor;
    const auto& law = law_at(force, sums[k].centre());
    const S normal_force = sums[k].normal_force();
    const S depth = law.depth(normal_force);
    if (!(weight > S(0))) {  // new, or from regions without force
      anchor = Anchor<S>::begin(X, sums[k].centre(), sums[k].normal(), depth);
      continue;
    }
    anchor.point_T = point_T / weight;
    anchor.tip = tip / weight;
    // A normal across the force keeps all of it where regions on both sides of an edge merge; slips turn it
    // back.
    const Vec3<S> along = unit_or<S>(friction, Vec3<S>::Zero());
    const S carried = friction.norm();
    anchor.normal =
        unit_or<S>(tangential<S>(unit_or<S>(normal, sums[k].normal()), along), perpendicular<S>(along));
    // A merged region's limit may be below the sum of its parts' (beta < 1): the excess wears off with
    // travel.
    const S limit =
        sliding ? law_of_friction.sliding_limit(normal_force) : law_of_friction.static_limit(normal_force);
    if (limit > S(0))
      strength = (std::max)(strength, (std::min)(carried / limit, S(1) / (std::numeric_limits<S>::min)()));
    anchor.slip = {sliding, strength};
    const S stretch = carried_stretch<Skew>(law, depth, carried, energy, anchor.slip);
    anchor.slip.slid = stretch;
    anchor.origin = anchor.tip + stretch * along + depth * anchor.normal;
  }
}

}  // namespace palpate::detail
