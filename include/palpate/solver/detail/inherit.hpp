// SPDX-License-Identifier: MIT
#pragma once

/// @file What friction remembers of a region, and how that is carried over when regions merge or split.

#include <palpate/contact/region_slot.hpp>
#include <palpate/contact/topology.hpp>
#include <palpate/law/friction/anchor.hpp>
#include <palpate/law/map/concept.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace palpate::detail {

/// True where regions of this friction law and topology resist twist about their normal. The printed slip
/// rule has no such thing, a point has no area, and a wrench at the centre of mass no torque.
template <class Friction, class Contacts, bool has_torque>
struct Twists {
  static constexpr bool value = false;
};
template <class Friction, class Contacts>
  requires(Friction::active && !std::same_as<Contacts, SinglePoint>)
struct Twists<Friction, Contacts, true> {
  static constexpr bool value =
      HasTorsionalRatio<typename Friction::Skew> && !Friction::Slip::shifts_by_travel;
};

/// Of one region, from tick to tick.
template <Real S, bool twists>
struct FrictionMemory {
  Anchor<S> anchor;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<twists, Twist<S>, NoTwist> twist;
  Vec3<S> friction;  ///< of the last tick [N]
  S normal_force;    ///< F_cn of the last tick [N]
  S depth;           ///< D_n of the last tick [m]
};

/// The region as a disc. Its stiffness, were it pressed flat, is the law's at the deepest point times the sum
/// of the points' weights.
template <ForceLaw Law, class Sum, Real S, class Skew>
[[nodiscard]] TwistedDisc<S> disc_of(const Law& law, const Sum& sum, S normal_force,
                                     const Skew& skew) noexcept {
  if constexpr (HasTorsionalRatio<Skew>) {
    const S a = radius_of(sum.area()), f = law.force(sum.deepest);
    const S stiffness = f > S(0) ? law.stiffness(sum.deepest) * (normal_force / f) : S(0);
    return {a, static_cast<S>(skew.torsional_ratio()) * a * a * stiffness};
  } else {
    return {S(0), S(0)};
  }
}

/// Each region takes the share of every predecessor's tangential force and elastic energy that its normal
/// force is of all of that predecessor's successors; so the sum of the forces is kept and no energy is added.
/// Torque against twist goes with it, and so does the couple of friction forces that act at different points
/// and now act at one. `regions`: the collector's state, whose slots say who inherits from whom; `sums`: this
/// tick's, by slot; `rotation`: the tool's in the last tick.
template <FrictionLaw Friction, ForceModel Force, class Regions, class Sum, Real S, bool twists,
          std::size_t N>
void inherit(const Friction& law_of_friction, const Force& force, const Regions& regions,
             const std::array<Sum, N>& sums, const Pose<S>& X, [[maybe_unused]] const Mat3<S>& rotation,
             std::array<FrictionMemory<S, twists>, N>& memory) noexcept {
  const auto& skew = skew_of(law_of_friction);
  const std::array<FrictionMemory<S, twists>, N> last = memory;
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
    S weight = S(0), pressed = S(0), energy = S(0);
    [[maybe_unused]] Vec3<S> torque = Vec3<S>::Zero();  // about the origin [N m]
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
          fraction * before.slip.springs * skew.energy(law_at(force, before.tip), last[p].depth, stretched);
      if constexpr (twists) {
        const Twist<S>& twist = last[p].twist;
        energy += fraction * twist.about_normal() * twist.angle / S(2);
        torque += fraction * (twist.torque + before.tip.cross(last[p].friction));
      }
      pressed += fraction * last[p].normal_force;
      sliding = sliding || before.slip.sliding;
    }
    Anchor<S>& anchor = memory[k].anchor;
    const auto& law = law_at(force, sums[k].centre());
    const S normal_force = sums[k].normal_force();
    const S depth = law.depth(normal_force);
    if (!(weight > S(0))) {  // new, or from regions without force
      anchor = Anchor<S>::begin(X, sums[k].centre(), sums[k].normal(), depth);
      if constexpr (twists) memory[k].twist.release(X.rotation);
      continue;
    }
    anchor.point_T = point_T / weight;
    anchor.tip = tip / weight;
    // A normal across the force keeps all of it where regions on both sides of an edge merge; slips turn it
    // back.
    if constexpr (twists) {  // what is left where opposite forces cancel has no direction
      if (!(friction.norm() > S(64) * std::numeric_limits<S>::epsilon() * normal_force)) friction.setZero();
    }
    const Vec3<S> along = unit_or<S>(friction, Vec3<S>::Zero());
    const S carried = friction.norm();
    S joint = carried;  // with the torque: what the limit bounds
    [[maybe_unused]] S about_normal = S(0);
    anchor.normal =
        unit_or<S>(tangential<S>(unit_or<S>(normal, sums[k].normal()), along), perpendicular<S>(along));
    if constexpr (twists) {
      const S lever = friction_lever(radius_of(sums[k].area()));
      about_normal = anchor.normal.dot(torque - anchor.tip.cross(friction));
      if (lever > S(0)) joint = std::hypot(carried, about_normal / lever);
    }
    // A part that sticks carries more than one that slides, and a merged region's limit may be below the sum
    // of its parts' (beta < 1): both wear off with travel. By the last tick's load, under which the parts
    // bore it: by this one's, friction would stay where the load leaves.
    S limit = law_of_friction.static_limit(pressed), static_share = S(0), strength = S(1);
    if (sliding) {
      const S slides = law_of_friction.sliding_limit(pressed), more = limit - slides;
      if (joint > slides && more > S(0)) static_share = (std::min)((joint - slides) / more, S(1));
      limit = slides + static_share * more;
    }
    if (joint > limit && limit > S(0))
      strength = (std::min)(joint / limit, S(1) / (std::numeric_limits<S>::min)());
    anchor.slip = {.sliding = sliding, .strength = strength, .static_share = static_share};
    const S stretch = carried_stretch(skew, law, depth, carried, energy, anchor.slip);
    anchor.slip.slid = stretch;
    if constexpr (twists) {
      // As stiff as it takes to hold the torque with what energy is left.
      const S left = energy - anchor.slip.springs * skew.energy(law, depth, stretch);
      memory[k].twist.release(rotation);
      // Half of the digits: where the stretch takes all, the difference is rounding, and neither its sign nor
      // its size must count.
      constexpr S rounding = S(1) / S(std::uint64_t(1) << std::numeric_limits<S>::digits / 2);
      const S stiffness = about_normal * (about_normal / (S(2) * left));
      const S angle = -about_normal / stiffness;
      if (left > rounding * energy && is_finite(angle)) {  // not finite: the torque is none in S
        memory[k].twist.stiffness = stiffness;
        set_twist(memory[k].twist, rotation, anchor.normal, angle, S(0));
      }
    }
    anchor.origin = anchor.tip + stretch * along + depth * anchor.normal;
  }
}

}  // namespace palpate::detail
