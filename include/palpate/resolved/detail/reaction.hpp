// SPDX-License-Identifier: MIT
#pragma once

/// @file What comes of a tick's loads: for the tool, and with friction for the surface.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <cstddef>
#include <limits>

namespace palpate::detail {

/// Without friction: minus the gradient of the energy.
template <bool has_friction>
class Reaction {
 public:
  using V = VectorList::V;

  void resize(std::size_t size) { felt_.resize(size); }
  /// Of normal loads q: of the depth along the direction of pressing, and of the regular part, `gradient`.
  void measure(const PointSystem& system, const AlignedList<float>& q, const auto& gradient) noexcept {
    const V tiny((std::numeric_limits<float>::min)());
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i), n = system.normals().load(i);
      const SimdVec3<V> deeper = V(1.f) / (max)(dot(n, m), tiny) * n;
      felt_.store(i, V(&q[i]) * (deeper - gradient.less(system, i, n)));
    }
  }
  [[nodiscard]] Vec3<float> felt(std::size_t i) const noexcept { return felt_[i]; }  ///< -f/(4 pi mu)

 private:
  VectorList felt_;
};

/// With friction: the loads, and the gradient of the depth as far as a point slips, by the square of its
/// share of the limit; where it sticks the body goes with the tool. Which do, and where these hold the
/// surface.
template <>
class Reaction<true> {
 public:
  using V = VectorList::V;

  void resize(std::size_t size) {
    for (auto* list : {&felt_, &anchor_}) list->resize(size);
    sticks_.resize(size);
  }
  /// Of the loads `result` on cones about `axes`, normal ones q. `beside`: displacements by others' loads;
  /// `moved`: what the solve has left out of all displacements.
  void measure(const PointSystem& system, const VectorList& axes, const AlignedList<float>& q,
               const FrictionLists& result, const auto& beside, const Vec3<float>& moved) noexcept {
    const V zero(0.f), one(1.f), tiny((std::numeric_limits<float>::min)());
    const SimdVec3<V> all = each<V>(moved);
    V total{}, sticking{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i), n = system.normals().load(i),
                        P = result.load.load(i), u = result.u.load(i);
      const V qi(&q[i]), limit = V(result.mu) * V(&result.per_mu[i]) * qi, limit2 = limit * limit;
      const SimdVec3<V> t = P - qi * axes.load(i);
      const V held2 = dot(t, t);
      const auto sticks = held2 < V(slips_from) * limit2, holds = sticks && V(&result.anchored[i]) > zero;
      const SimdVec3<V> a = result.anchor.load(i),
                        kept{select(holds, a.x, u.x), select(holds, a.y, u.y), select(holds, a.z, u.z)};
      anchor_.store(i, across(m, beside.load(i) + kept + all));
      select(sticks, one, zero).copy_to(&sticks_[i]);
      total += qi, sticking += select(sticks, qi, zero);
      const V slips = select(sticks, held2 / (max)(limit2, tiny), one);
      felt_.store(i, P + (slips * qi) * (one / (max)(dot(n, m), tiny) * n - m));
    }
    total_ = reduce(total), sticking_ = reduce(sticking);
  }

  [[nodiscard]] Vec3<float> felt(std::size_t i) const noexcept { return felt_[i]; }      ///< -f/(4 pi mu)
  [[nodiscard]] Vec3<float> anchor(std::size_t i) const noexcept { return anchor_[i]; }  ///< [m]
  [[nodiscard]] bool sticks(std::size_t i) const noexcept { return sticks_[i] > 0; }
  /// Sums of normal loads: of all points, and of those that stick.
  [[nodiscard]] float total() const noexcept { return total_; }
  [[nodiscard]] float sticking() const noexcept { return sticking_; }

 private:
  VectorList felt_, anchor_;
  AlignedList<float> sticks_;  // 1, or 0
  float total_ = 0, sticking_ = 0;
};

}  // namespace palpate::detail
