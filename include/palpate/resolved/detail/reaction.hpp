// SPDX-License-Identifier: MIT
#pragma once

/// @file What comes of a tick's loads: without friction for the tool, with friction for the surface.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
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
  /// -f/(4 pi mu)
  [[nodiscard]] Vec3<float> felt(const LoadLists& /*result*/, std::size_t i) const noexcept {
    return felt_[i];
  }
  [[nodiscard]] static float held() noexcept { return 0; }

 private:
  VectorList felt_;
};

/// With friction the tool feels the loads themselves. Which points stick, and where these hold the surface.
template <>
class Reaction<true> {
 public:
  using V = VectorList::V;

  void resize(std::size_t size) { anchor_.resize(size), sticks_.resize(size); }
  /// Of the loads `result` on cones about `axes`, normal ones q. `given`: displacements by others' loads and
  /// by sway; `moved`: what the solve has left out of all displacements.
  void measure(const PointSystem& system, const VectorList& axes, const AlignedList<float>& q,
               const FrictionLists& result, const auto& given, const Vec3<float>& moved) noexcept {
    const V zero(0.f), one(1.f), tiny((std::numeric_limits<float>::min)());
    const SimdVec3<V> all = each<V>(moved);
    V total{}, sticking{}, rubbed{}, sizes{};
    SimdVec3<V> sum{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> u = result.u.load(i);
      const V qi(&q[i]), limit = V(result.mu) * V(&result.per_mu[i]) * qi, limit2 = limit * limit;
      const SimdVec3<V> t = result.load.load(i) - qi * axes.load(i);
      const V t2 = dot(t, t);
      const auto sticks = t2 < V(slips_from) * limit2, holds = sticks && V(&result.anchored[i]) > zero;
      const SimdVec3<V> a = result.anchor.load(i),
                        kept{select(holds, a.x, u.x), select(holds, a.y, u.y), select(holds, a.z, u.z)};
      const SimdVec3<V> m = system.directions().load(i);
      // Along m the surface's own: as m turns on with the contact, it comes to lie partly across.
      anchor_.store(i, given.load(i) + all + kept + dot(m, u - kept) * m);
      select(sticks, one, zero).copy_to(&sticks_[i]);
      total += qi, sticking += select(sticks, qi, zero);
      rubbed += qi * select(sticks, t2 / (max)(limit2, tiny), one);
      sum += t, sizes += t2 * inverse_sqrt((max)(t2, tiny));
    }
    tractions_ = sum_of(sum);
    total_ = reduce(total), sticking_ = reduce(sticking);
    held_ = total_ > 0 ? 1 - reduce(rubbed) / total_ : 1;
    const float size = reduce(sizes);
    // At a first touch loads are so small that their squares vanish, and sizes with them.
    const float same = size > 0 ? (std::min)((tractions_ / size).squaredNorm(), 1.f) : 0;
    passes_ += (same - passes_) / 8;
  }
  void forget() noexcept { held_ = 1, passes_ = 0, tractions_.setZero(); }

  [[nodiscard]] static Vec3<float> felt(const FrictionLists& result, std::size_t i) noexcept {
    return result.load[i];
  }
  [[nodiscard]] Vec3<float> anchor(std::size_t i) const noexcept { return anchor_[i]; }  ///< [m]
  [[nodiscard]] bool sticks(std::size_t i) const noexcept { return sticks_[i] > 0; }
  /// Sums of normal loads: of all points, and of those that stick.
  [[nodiscard]] float total() const noexcept { return total_; }
  [[nodiscard]] float sticking() const noexcept { return sticking_; }
  /// Sum of what friction exerts.
  [[nodiscard]] const Vec3<float>& tractions() const noexcept { return tractions_; }
  /// How firmly friction holds the contact: mean by load of 1 - (t/limit)^2; 1 as it begins.
  [[nodiscard]] float held() const noexcept { return held_; }
  /// How far all tractions point the same way, |sum t|^2/(sum |t|)^2: 1 where a tool slides on. Mean of some
  /// ticks, or the limit of a contact that is not solved yet would change by up to half from tick to tick.
  [[nodiscard]] float passes() const noexcept { return passes_; }

 private:
  VectorList anchor_;
  AlignedList<float> sticks_;  // 1, or 0
  Vec3<float> tractions_ = Vec3<float>::Zero();
  float total_ = 0, sticking_ = 0, held_ = 1, passes_ = 0;
};

}  // namespace palpate::detail
