// SPDX-License-Identifier: MIT
#pragma once

/// @file The area of a resolved contact.

#include <palpate/core/simd_math.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/convex_problem.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/touching_point.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace palpate::detail {

/// Points beneath the surface that do not touch.
class Unloaded {
 public:
  using V = VectorList::V;
  explicit Unloaded(std::size_t capacity) { x_.resize(capacity); }
  /// Of those beneath it, TouchingPoints, at most the capacity.
  void take(const auto& beneath) noexcept {
    size_ = 0;
    for (std::size_t c = 0; c < beneath.size(); ++c)
      if (!beneath.memory(c).loaded) x_.set(size_++, beneath[c].x);
    for (std::size_t i = size_; i < padded<V>(size_); ++i) x_.set(i, PointSystem::apart());
  }
  /// Whether one is nearer to x than the root of `distance2`.
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

/// Pressure of a cell that lies within the rim of contact on a rounded edge, over 4 pi mu. Within its width
/// h = sqrt(A) the cell's surface turns by h/rho, about one axis, which makes its vector area a shorter:
///
///     p = 2/3 kappa sqrt(h),   kappa = 2/pi E* sqrt(phi/rho),   h/rho = sqrt(24 (1 - |a|/A))
///
/// Beside a half-plane that ends in a parabola of radius rho the pressure is kappa sqrt(s) at s inside the
/// end of contact; phi: the slope there, as far beyond the flat as rho phi. The end is taken a quarter of a
/// cell beyond the middle, as if three quarters of the cell touched (chosen: 0 makes areas some 3 % larger).
/// On a ball kappa is larger (contact_area()). 0 for cells that turn by less than `rounded`.
template <Real S>
[[nodiscard]] inline float rounded_rim_pressure(const ToolPoints<S>& tool, const TouchingPoint& at,
                                                float b) noexcept {
  constexpr float rounded = 0.3f;  // [rad]: chosen; cells of a ball with 10 across the contact turn less
  constexpr float pi = std::numbers::pi_v<float>;
  if (tool.vector_areas().empty()) return 0;
  const auto flat = static_cast<float>(tool.vector_areas()[at.point].norm() / tool.area(at.point));
  const float turn = std::sqrt(24 * (std::max)(1 - flat, 0.f)), phi = (at.outward - at.m).norm() + turn / 4;
  return turn < rounded ? 0 : 4 / (3 * pi * pi * (1 + b)) * std::sqrt(phi * turn);  // E* = 1/(pi (1 + b))
}

/// Area that touches [m^2]. A cell at the rim, next to a point that does not touch, counts by the part f of
/// it within the contact. Where the pressure falls as under a ball, p = 1.5 p_mean sqrt(2 s/a) at s inside
/// the rim of radius a, a cell of width h has the mean pressure sqrt(2 h f/a) p_mean f; on points it is 0.8
/// of that, for points beyond the rim carry a part (balls on 20 to 150 points of a half-space: area -3 to
/// +2 % in the mean of positions). `rounded(i)`: rounded_rim_pressure() of point i.
///
/// Where few points touch, most of them at a rim that is not rounded, the area follows from how even the
/// pressure is instead:
///
///     A = 1.07 (sum q)^2 / sum q^2/A_i
///
/// Hertz's pressure has 9/8 under a ball, 1.08 along a line; on few points sum q^2/A_i is some 5 % too small.
/// It counts by how few points touch and by the share of the area at such a rim: balls on 4, 7, 10, 14, 20
/// points have 25, 10, 6, 4, 3 % of error, rms over positions; by the rim alone 32, 17, 10, 6, 4 %. Narrow
/// contacts have few points across: ellipsoids 40:1 on 38, 56, 72 points 2.4, 2.6, 2.9 % (6.7, 3.7, 2.9 %
/// where all that carry alike count).
/// Overwrites p and y of the lists.
template <class Rounded>
[[nodiscard]] inline float contact_area(const PointSystem& system, PressureLists& lists,
                                        const Unloaded& unloaded, const Rounded& rounded) noexcept {
  using V = Unloaded::V;
  constexpr float rim_pressure = 0.8f;
  constexpr float neighbours2 = 2.25f;  // of a cell's area: between first and second neighbours
  constexpr float few = 13;             // as many points that carry alike; all by the rim from twice that on
  constexpr float slender = 2.2f;       // narrow contacts have more points alike than balls as wide
  const V zero(0.f), one(1.f), most((std::numeric_limits<float>::max)()),
      tiny((std::numeric_limits<float>::min)());
  const float* const q = lists.q.data();
  float* const rim = lists.y.data();    // of a cell at the rim: its pressure^(2/3); of another: more than any
  float* const bound = lists.p.data();  // of 1/full^(2/3)
  for (std::size_t i = 0; i < system.size(); ++i) {
    rim[i] = q[i] > 0 && unloaded.is_near(system.position(i), neighbours2 * system.area(i)) ? 1.f : 0.f;
    const float local = rim[i] > 0 ? rim_pressure * rounded(i) : 0.f;
    bound[i] = local > 0 ? 1 / std::cbrt(local * local) : (std::numeric_limits<float>::max)();
  }
  V wholes{}, rims{}, loads{}, counts{};
  for (std::size_t i = 0; i < system.stride(); i += V::size()) {
    const V qi(q + i), area = select(qi > zero, V(system.areas() + i), zero);
    const V pressure = (max)(qi / V(system.areas() + i), tiny);
    rims += select(V(rim + i) > zero && V(bound + i) == most, area, zero);
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
      sums += select(V(q + i) > zero,
                     V(system.areas() + i) * (min)((min)(V(per_full), V(bound + i)) * V(rim + i), one), zero);
    sum = reduce(sums);
  }
  const float smooth_rim = reduce(rims);
  if (!(smooth_rim > 0)) return sum;
  V per_areas{};
  for (std::size_t i = 0; i < system.stride(); i += V::size()) {
    const V share = V(q + i) / V(load);
    per_areas += share * share / V(system.areas() + i);
  }
  const float even = (std::min)(1.07f / reduce(per_areas), whole);
  const LoadFit fit(system, q);
  const float alike = (std::min)(fit.alike(), slender * fit.alike_across());
  return std::lerp(sum, even, smooth_rim / whole * std::clamp(2 - alike / few, 0.f, 1.f));
}

}  // namespace palpate::detail
