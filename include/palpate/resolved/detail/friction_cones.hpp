// SPDX-License-Identifier: MIT
#pragma once

/// @file The cones of friction at a contact's points: their axes, and how wide they are.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/depth_slope.hpp>
#include <palpate/resolved/detail/friction_problem.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/traction_depth.hpp>
#include <palpate/resolved/detail/twist_stiffening.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>

namespace palpate::detail {

/// The load of a point is P = q c + t, q = m.P, |t| <= mu s q. The axis c is what it bears without friction:
///
///     c = m + n_t - g + lean (h - mean of h by load)
///
/// m: the direction of pressing. Across it: n_t, by which the undeformed surface is turned and the depth
/// changes as the tool moves (depth_slope.hpp); g, slope of the regular part, by which it has turned since
/// (regular_gradient.hpp); h, slope of the tool's own normal.
///
/// What of the tool is slanted presses along its own normal. Of the part of that across m, q h, the stress
/// along the surface holds some, for the surface has turned with the tool: all where it is as large as the
/// pressure, as at nu = 1/2. So lean = min(2 (1 - 2 nu), 1), chosen on finite elements: these want 0.7 to 1
/// at nu = 0.3, and 0 at 1/2. Without the mean a tool that slides would be pushed aside, though the pressures
/// on its sides balance.
///
/// Where a tool slides, friction takes mu p per area of its surface and length of the body's surface that
/// passes it. Of a slope h both are larger than seen along m, by sqrt(1 + h^2) and sqrt(1 + h^2/2), the mean
/// over directions. Friction lifts the surface before the tool and presses it down behind: with h_x along the
/// path the pressures there become q/(1 -+ mu h_x), and lean by +- h_x, mu^2 h_x^2 of friction more, half of
/// h^2 on the mean. And p has pressed together what passes, by (1 - 2 nu) p/(4 mu) on a half-space, and two
/// thirds of that where friction drags it in (chosen on finite elements; mu is the shear modulus in these).
/// Nothing passes where a tool turns in place, so these two count by w, how far all tractions t point the
/// same way:
///
///     s = sqrt(1 + h^2) sqrt(1 + h^2/2) (1 + w mu^2 h^2/2) (1 - w (1 - 2 nu) 2 pi/3 q/A)
///     w = |sum t|^2/(sum |t|)^2
///
/// h <= 3/4, mu <= 1 here, the last factor >= 1/2; w of the last ticks (reaction.hpp), mu of the last solve.
///
/// What is steeper is a tool's rim, round which nothing slides; 3/4 is chosen on finite elements.
class FrictionCones {
 public:
  using V = VectorList::V;
  FrictionCones(double nu, std::size_t points)
      : lean_(static_cast<float>((std::min)(2 * (1 - 2 * nu), 1.))),
        strain_across_(static_cast<float>(-2 * (1 - 2 * nu) * std::numbers::pi / 3)),
        traction_depth_(nu) {
    axes_.resize(AlignedList<float>::padded(points));
    outward.resize(AlignedList<float>::padded(points));
  }

  VectorList outward;  ///< the tool's unit normals at the points
  DepthSlope slope;
  TwistStiffening twist;

  /// Axes, and s to `lists.per_mu`, for normal loads q, at positions relative to `origin`; `passes`: w.
  template <Real S>
  void place(const PointSystem& system, const float* loads, const Vec3<S>& origin, const Vec3<float>& g,
             float passes, FrictionLists& lists) noexcept {
    const LoadFit fit(system, loads);
    if (system.is_flat())
      slope.forget();
    else
      slope.measure(system, fit, origin);
    SimdVec3<V> slopes{};
    V all{};
    const float mu = (std::min)(lists.mu, 1.f);
    const V lift_per_h2(passes * mu * mu / 2);
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i), o = outward.load(i);
      const V q(loads + i), cosine = dot(o, m);
      const SimdVec3<V> steep = V(1.f) / (max)(cosine, V(rim)) * across(m, o);
      const V most = V(rim_slope) * inverse_sqrt((max)(dot(steep, steep), V(tiny)));
      const SimdVec3<V> h = (min)(most, V(1.f)) * steep;
      axes_.store(i, h);
      slopes += q * h, all += q;
      limit_per_mu(cosine, V(passes) * q / V(system.areas() + i), lift_per_h2).copy_to(&lists.per_mu[i]);
    }
    twist.measure(system, loads, fit, axes_, lists.anchor);
    traction_depth_.measure(fit);
    const Vec3<float> mean = sum_of(slopes) / (std::max)(reduce(all), tiny);
    const auto turned = slope.over(origin, lean_ * mean + g);
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i);
      axes_.store(i, m + across(m, turned(system.feet().load(i)) + V(lean_) * axes_.load(i)));
    }
  }
  /// c
  [[nodiscard]] const VectorList& axes(const PointSystem& /*system*/) const noexcept { return axes_; }
  /// TractionDepth's: where the tool turns, and of tractions, their sum t.
  [[nodiscard]] Vec3<float> moved(const Mat3<float>& turn) const noexcept {
    return traction_depth_.moved(turn);
  }
  [[nodiscard]] Vec3<float> couple(const Vec3<float>& t) const noexcept { return traction_depth_.couple(t); }
  void forget() noexcept { slope.forget(), traction_depth_.forget(); }

 private:
  static constexpr float rim_slope = 0.75f, rim = 0.8f;  // and its cosine
  static constexpr float tiny = (std::numeric_limits<float>::min)();

  // s of points whose tool has a normal at that cosine to m; of w q/A and w mu^2/2.
  [[nodiscard]] PALPATE_INLINE V limit_per_mu(const V& cosine, const V& q_per_area,
                                              const V& lift_per_h2) const noexcept {
    const V area = V(1.f) / clamp(cosine, rim, 1.f), area2 = area * area,
            stretch = sqrt(V(0.5f) * (V(1.f) + area2)), lift = V(1.f) + lift_per_h2 * (area2 - V(1.f)),
            strain = (max)(V(strain_across_) * q_per_area, V(-0.5f));
    return area * stretch * lift * (V(1.f) + strain);
  }

  float lean_, strain_across_;  // p/(6 mu) = 2 pi/3 q/A
  VectorList axes_;
  TractionDepth traction_depth_;
};

/// Of a body whose response is linear: s = 1, c = m + n_t; m itself where the body is flat.
class LinearCones {
 public:
  using V = VectorList::V;
  LinearCones(double /*nu*/, std::size_t points) { axes_.resize(AlignedList<float>::padded(points)); }

  DepthSlope slope;

  template <Real S>
  void place(const PointSystem& system, const float* loads, const Vec3<S>& origin, const Vec3<float>& /*g*/,
             float /*passes*/, const FrictionLists& /*lists*/) noexcept {
    if (system.is_flat()) return slope.forget();
    slope.measure(system, LoadFit(system, loads), origin);
    const auto turned = slope.over(origin, Vec3<float>::Zero());
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i);
      axes_.store(i, m + across(m, turned(system.feet().load(i))));
    }
  }
  [[nodiscard]] const VectorList& axes(const PointSystem& system) const noexcept {
    return slope.is_zero() ? system.directions() : axes_;
  }
  [[nodiscard]] static Vec3<float> moved(const Mat3<float>&) noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] static Vec3<float> couple(const Vec3<float>&) noexcept { return Vec3<float>::Zero(); }
  void forget() noexcept { slope.forget(); }

 private:
  VectorList axes_;
};

template <bool finite_strain>
using ConesOf = std::conditional_t<finite_strain, FrictionCones, LinearCones>;

/// Without friction.
struct NoCones {
  NoCones(double /*nu*/, std::size_t /*points*/) {}
};

}  // namespace palpate::detail
