// SPDX-License-Identifier: MIT
#pragma once

/// @file The area of a resolved contact.

#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/convex_problem.hpp>
#include <palpate/resolved/detail/point_system.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::detail {

/// Points beneath the surface that do not touch.
class Unloaded {
 public:
  using V = VectorList::V;
  explicit Unloaded(std::size_t capacity) { x_.resize(capacity); }
  void clear() noexcept { size_ = 0; }
  /// Precondition: fewer than the capacity.
  void add(const Vec3<float>& x) noexcept { x_.set(size_++, x); }
  /// After the last add().
  void pad() noexcept {
    for (std::size_t i = size_; i < padded<V>(size_); ++i) x_.set(i, PointSystem::apart());
  }
  /// After pad(): whether one is nearer to x than the root of `distance2`.
  [[nodiscard]] bool is_near(const Vec3<float>& x, float distance2) const noexcept {
    const SimdVec3<V> here = each(x);
    V nearest(distance2);
    for (std::size_t i = 0; i < size_; i += V::size()) {
      const SimdVec3<V> r = x_.load(i) - here;
      nearest = (min)(nearest, dot(r, r));
    }
    return reduce_min(nearest) < distance2;
  }

 private:
  VectorList x_;
  std::size_t size_ = 0;
};

/// Area that touches [m^2]. A cell at the rim, next to a point that does not touch, counts by the part f of
/// it within the contact. Where the pressure falls as under a ball, p = 1.5 p_mean sqrt(2 s/a) at s inside
/// the rim of radius a, a cell of width h has the mean pressure sqrt(2 h f/a) p_mean f; on points it is 0.8
/// of that, for points beyond the rim carry a part (balls on 20 to 150 points of a half-space: area -3 to
/// +2 % in the mean of positions). Overwrites y of the lists.
[[nodiscard]] inline float contact_area(const PointSystem& system, PressureLists& lists,
                                        const Unloaded& unloaded) noexcept {
  using V = Unloaded::V;
  constexpr float rim_pressure = 0.8f;
  constexpr float neighbours2 = 2.25f;  // of a cell's area: between first and second neighbours
  const V zero(0.f), one(1.f), most((std::numeric_limits<float>::max)()),
      tiny((std::numeric_limits<float>::min)());
  const float* const q = lists.q.data();
  float* const rim = lists.y.data();  // of a cell at the rim: its pressure^(2/3); of another: more than any
  for (std::size_t i = 0; i < system.size(); ++i)
    rim[i] = q[i] > 0 && unloaded.is_near(system.position(i), neighbours2 * system.area(i)) ? 1.f : 0.f;
  V wholes{}, loads{}, counts{};
  for (std::size_t i = 0; i < system.stride(); i += V::size()) {
    const V qi(q + i), area = select(qi > zero, V(system.areas() + i), zero);
    const V pressure = (max)(qi / V(system.areas() + i), tiny);
    select(V(rim + i) > zero, exp2(V(2.f / 3) * log2(pressure)), most).copy_to(rim + i);
    wholes += area, loads += qi, counts += select(qi > zero, one, zero);
  }
  const float whole = reduce(wholes), load = reduce(loads), count = reduce(counts);
  float sum = whole;
  for (int round = 0; round < 3 && count > 0; ++round) {  // a and p_mean are of the area that is sought
    const float width = std::sqrt(std::numbers::pi_v<float> * whole / (count * sum)),  // h / a
        full = rim_pressure * std::sqrt(2 * width) * load / sum, per_full = 1 / std::cbrt(full * full);
    V sums{};
    for (std::size_t i = 0; i < system.stride(); i += V::size())
      sums += select(V(q + i) > zero, V(system.areas() + i) * (min)(V(per_full) * V(rim + i), one), zero);
    sum = reduce(sums);
  }
  return sum;
}

}  // namespace palpate::detail
