// SPDX-License-Identifier: MIT
#pragma once

/// @file How the depth along the direction of pressing changes over a curved body's surface.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <cstddef>
#include <limits>

namespace palpate::detail {

/// The depth along m, d = delta/(n.m), has the gradient n/(n.m) over the tool's position. Its part across m,
///
///     n_t = n/(n.m) - m,
///
/// is the slope by which the undeformed surface is turned from m. Taken is its regression over the loads,
/// mean + S (x - mean x): its loads q n_t have the same sum and the same moment. Where a point passes a sharp
/// edge of the body n changes at once, the regression by that point's share of the load. And since friction
/// carries the surface after the loads, a fifth of it is this tick's, the rest the last one's at this one's
/// mean x: on a smooth body both are the same. At its own mean x, which the cones move with the loads, the
/// force would swing every other tick. By each point's own n_t a ball that slides over a box's edge is swung
/// from tick to tick by a quarter of its force.
class DepthSlope {
 public:
  using V = VectorList::V;

  void forget() noexcept { mean_.setZero(), by_x_.setZero(); }
  /// By the normal loads of `fit`, on a body that is not flat; positions are relative to `origin` [m].
  template <Real S>
  void measure(const PointSystem& system, const LoadFit& fit, const Vec3<S>& origin) noexcept {
    if (!fit.has_load()) return forget();
    const LoadFit::Linear n_t = fit.linear([&](std::size_t i) PALPATE_INLINE_LAMBDA {
      const SimdVec3<V> m = system.directions().load(i), n = system.normals().load(i);
      return V(1.f) / (max)(dot(n, m), V((std::numeric_limits<float>::min)())) * n - m;
    });
    const Vec3<double> at = origin.template cast<double>() + fit.mean().cast<double>();
    const Vec3<float> last_there = mean_ + by_x_ * (at - at_).template cast<float>();
    const float share = is_zero() ? 0.5f : of_a_tick;
    mean_ = last_there + share * (n_t.mean - last_there), by_x_ += share * (n_t.by_x - by_x_);
    at_ = at;
  }
  [[nodiscard]] bool is_zero() const noexcept { return mean_.isZero(0) && by_x_.isZero(0); }
  /// n_t at x, relative to `origin`, less g.
  template <Real S>
  [[nodiscard]] auto over(const Vec3<S>& origin, const Vec3<float>& g) const noexcept {
    const Vec3<float> at_origin =
        mean_ - g - by_x_ * (at_ - origin.template cast<double>()).template cast<float>();
    return [s = each<V>(at_origin), x = each<V>(by_x_.col(0)), y = each<V>(by_x_.col(1)),
            z = each<V>(by_x_.col(2))](const SimdVec3<V>& at)
               PALPATE_INLINE_LAMBDA { return s + at.x * x + at.y * y + at.z * z; };
  }

 private:
  static constexpr float of_a_tick = 0.2f;  // 0.5: the force over a box's edge changes twice as fast

  Vec3<float> mean_ = Vec3<float>::Zero();
  Mat3<float> by_x_ = Mat3<float>::Zero();  // S [1/m]
  Vec3<double> at_ = Vec3<double>::Zero();  // mean x [m]
};

}  // namespace palpate::detail
