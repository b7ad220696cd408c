// SPDX-License-Identifier: MIT
#pragma once

/// @file How a contact's energy changes along a body that is no half-space: what the tool feels of it.

#include <palpate/detection/tool_points.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/touching_point.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace palpate::detail {

/// Gradients of the energy of the loads q_i m_i in the regular displacements w, their own and what other
/// tools' loads do.
///
/// *Along the surface*: of n.(w - v), n the surface's own normal, by regression over the loads; points are
/// put over the surface by v already (body_shift.hpp). One gradient for all is continuous in the pose; the
/// load mesh's own jumps from triangle to triangle. With friction of w along m alone, by which cones turn
/// (friction_cones.hpp): across it the surface has been carried along, and points are put over it there
/// (carried_surface.hpp). It then acts on the loads it comes from, and is the mean of the last tick's and
/// this one's: taken whole, a rod that is drawn aside takes 54 iterations in a tick instead of 8.
///
/// *Of the directions m_i*, without friction: they turn as the points k beneath the surface come deeper.
/// The energy's gradient by m_i is -q_i w_i, so that the tool is pressed less at k, by g_k:
///
///     N_i = sum_k c_ik depth_k A_k n_k,   m_i = N_i/|N_i|                          (PointSystem)
///     g_k = A_k n_k.sum_i c_ik q_i (1 - m_i m_i^T) (w_i - v) / |N_i|
///
/// The points that carry load take that over, with its sum and its moment: q_i (b + D.r_i) (LoadFit). It is
/// what turns a tool that presses on a curved body where v has not come to w. Without it an ellipsoid on a
/// lying cylinder has 4 % of error in its torque, with it 1 % (finite elements). On a flat face it is 0.
///
/// *Stretch*: e_w, the strain of the surface by w, the sum of both ways across m, by regression as well. It
/// is felt in the next tick (finite_strain.hpp).
template <bool has_friction>
class RegularGradient {
 public:
  using V = VectorList::V;
  explicit RegularGradient(std::size_t capacity) {
    if (!has_friction) sideways_.resize(capacity);
  }

  /// After a solve with normal loads q and displacements w by them, of which points are put over v already;
  /// `given`: by others' loads and by sway.
  template <Real S>
  void measure(const PointSystem& system, const float* q, const VectorList& w, const Vec3<float>& v,
               const auto& given, const auto& touching, const ToolPoints<S>& tool) noexcept {
    const Vec3<float> last = slope_;
    forget();
    const LoadFit fit(system, q);
    if (!fit.has_load()) return;
    const SimdVec3<V> known = each<V>(v);
    const auto displaced = [&](std::size_t i)
                               PALPATE_INLINE_LAMBDA { return SimdVec3<V>(w.load(i) + given.load(i)); };
    stretch_ = clamp(fit.linear(displaced).by_x.trace(), -most_stretch, most_stretch);
    slope_ = fit.slope([&](std::size_t i) PALPATE_INLINE_LAMBDA {
      const SimdVec3<V> n = system.normals().load(i), all = displaced(i);
      if constexpr (!has_friction) return dot(n, all - known);
      const SimdVec3<V> m = system.directions().load(i);
      return dot(n, m) * dot(m, all);
    });
    if constexpr (has_friction)
      slope_ = (last + slope_) / 2;
    else if (!system.is_flat())
      measure_turn(system, q, w, known, given, touching, tool, fit);
  }
  void forget() noexcept { slope_.setZero(), stretch_ = 0, tilt_ = mean_ = {}, less_ = 0; }
  /// The slope along the surface, by which the body turns.
  [[nodiscard]] const Vec3<float>& slope() const noexcept { return slope_; }
  /// The same as far as it makes an arc of the body's path (body_shift.hpp): none with friction.
  [[nodiscard]] Vec3<float> arc() const noexcept {
    return has_friction ? Vec3<float>(Vec3<float>::Zero()) : slope_;
  }
  /// e_w, between -0.2 and 0.2.
  [[nodiscard]] float stretch() const noexcept { return stretch_; }
  /// What points i .. on feel less than q, over q, along n; and along the surface. Without friction.
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> less(const PointSystem& system, std::size_t i,
                                                const SimdVec3<V>& n) const noexcept {
    return each<V>(slope_) + (less_ + dot(tilt_, system.feet().load(i) - mean_)) * n;
  }

 private:
  void measure_turn(const PointSystem& system, const float* q, const VectorList& w, const SimdVec3<V>& known,
                    const auto& given, const auto& touching, const auto& tool, const LoadFit& fit) noexcept {
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> all = w.load(i) + given.load(i) - known;
      sideways_.store(i, (V(q + i) * system.turns(i)) * across(system.directions().load(i), all));
    }
    float sum = 0;
    Vec3<float> moment = Vec3<float>::Zero(), H = Vec3<float>::Zero();
    auto group = (std::numeric_limits<std::uint32_t>::max)();
    for (const TouchingPoint& c : touching) {
      if (c.group != group) H = system.turned_by(group = c.group, sideways_);
      const float g = static_cast<float>(tool.area(c.point)) * H.dot(c.m);
      sum += g, moment += g * (c.x - fit.mean());
    }
    less_ = V(sum / fit.load());
    tilt_ = each(fit.tilt(moment)), mean_ = each(fit.mean());
  }

  static constexpr float most_stretch = 0.2f;  // twice that of the finite element cases

  Vec3<float> slope_ = Vec3<float>::Zero();
  float stretch_ = 0;
  SimdVec3<V> tilt_{}, mean_{};
  V less_{};
  VectorList sideways_;  // q_i (1 - m_i m_i^T) (w_i - v) / |N_i|
};

/// Of a half-space, which is the same everywhere.
struct NoRegularGradient {
  explicit NoRegularGradient(std::size_t /*capacity*/) {}
  static void forget() noexcept {}
  [[nodiscard]] static Vec3<float> slope() noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] PALPATE_INLINE static SimdVec3<VectorList::V> less(const auto&...) noexcept { return {}; }
};

template <class RegularPart, bool has_friction>
using GradientOf = std::conditional_t<RegularPart::active, RegularGradient<has_friction>, NoRegularGradient>;

}  // namespace palpate::detail
