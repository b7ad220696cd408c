// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth of a resolved contact: by how much finite strain softens the near field and
/// widens the contact, and stiffens it across.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>
#include <palpate/response/second_order.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace palpate::detail {

/// A pressed ball's near field is softer than linear elasticity's, and stiffer by X, as the response field's
/// sphere is (response/second_order.hpp, k):
///
///     K P (1 + n k e)/(1 + X) + W P = d,   e = d_H/R = (pi/2 p_0/E')^2,   p_0 = 4/3 p
///     X = 3/(8 pi) (3 - 2 nu) (1 - 2 nu)/(1 - nu) sqrt(e)
///     n = (1 + f)/(1 - f),   f = 1 - mean by load of K P / d_0
///
/// p: mean of pressures by load, so e is known of contacts of any shape. d_0: how deep the deepest point is.
/// n: the force goes with d^n, and k is of the depth; 3/2 under a ball, f = 1/5, 2 under a cone, 1 under a
/// flat face. Deeper than k was fitted e is bounded: e/sqrt(1 + e^2). On a convex body the tool's part of the
/// curvature is less: left out.
///
/// X: where nu < 1/2 a pressed surface is drawn in, under Hertz's pressure by [johnson1985, 3.41b]
///
///     u_r = 2/(3 pi) (1 - 2 nu)/(1 - nu) a^2/r (1 - (1 - r^2/a^2)^(3/2)) a/R
///
/// and there the tool, of slope r/R, is deeper by u_r r/R: 3/(4 pi) (1 - 2 nu)/(1 - nu) a/R of force more.
/// Its pressures lean by the same slope, and by reciprocity that counts as much, less what the stress along
/// the surface holds, 1/2 + nu of the pressure on the mean. Flat faces take the same X. With friction, which
/// holds the surface, and where cones lean (friction_cones.hpp), 0.7 X: chosen on balls, mu = 0.1 and 1, nu
/// from 0 to 0.4, which have 0.66 to 0.78; flat cylinders have 0.55.
///
/// A surface that W P stretches, by e_w, the sum of both ways (regular_gradient.hpp), is stiffer: at nu =
/// 1/2 a half-space that is stretched alike has 1 + e_w/4 times the force [green1952]. As e_w grows with the
/// load, by reciprocity W P is changed as well; with both the force is larger by 2/5 e_w under a ball (3/8
/// under a flat face, 5/12 under a cone). So 1 + c below is divided by 1 + 2/5 e_w; for nu < 1/2, too, where
/// that is not derived.
///
/// A contact is wider than a linear one at nu = 1/2, for the surface rises beside what is pressed in most;
/// narrower where it is drawn in. What is less deep than d_0 is deeper by r than that:
///
///     K P (1 + c)/(1 + X) + W P = d + r,   r = s d_0 x (2 - x),   x = min(d/d_0, 1)
///     c = n k e + (1 + 3/2 f) s (1 - 0.6 s),   s = 0.18 (1 - 7 (1 - 2 nu)) e min(5 f, 1) >= -0.15
///
/// Narrower only as far as friction does not hold the surface, which is then not drawn in: s < 0 is less by
/// the share `held`.
///
/// A flat face, f = 0, has no rim to move. c leaves the force of a ball and of a flat face as it is: to r it
/// answers by a flat punch's pressure on the same area; 0.6 s by what e changes with it. s is chosen on a
/// ball on an ellipsoid, whose area is 6 % too small at nu = 0.49 and 8 % too large at 0.3 without r, below
/// 0.3 as there; -0.15: what the deepest of these has. x keeps r from what has only just come in. The depths
/// are divided by 1 + ((1 + c)/(1 + X) - 1) (K P)/d; e, f, the mean of (K P)/d and d_0 over the deepest of
/// all points are of the last tick.
///
/// Pressed, it is stiffer across, as a bonded patch (response/second_order.hpp, drag):
///
///     u = K P + W P - G sum_j P_j,   G = c kappa/(1 + kappa) (m.m - m m^T),   c = pi (2 - nu)/(2 a)
///     kappa = drag (2 - nu)/8 beta/(1 + beta^2),   beta = 2/3 sqrt(e)
///
/// c: a disc's compliance across, the least of any loads on it, so K - G stays positive; beta: how deep a
/// punch of the same mean pressure is, over its radius a; pi a^2 = 9/8 load/p, the area under a ball. The
/// body resists a turn as the linear one: only the sum of the loads counts. m, the mean direction by
/// load (0 where a tool presses from two sides), a, p: of the last tick.
///
/// Where friction holds the body the load moves with it, and all the while it grew was half way there on the
/// mean: to W it acts at x + v,
///
///     v = 1/2 (w_t - w_n F_t/F_n)/(1 + (w/2a)^4)
///
/// v F_n is the couple 1/2 w x F across the surface, whose range w = 2 a is (fitted on a bonded patch); w:
/// regular displacement, mean by load, others' loads included.
class FiniteStrain {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  explicit FiniteStrain(double nu)
      : softening_(static_cast<float>(SecondOrder{}.at(nu).sphere_softening)),
        drawn_in_(static_cast<float>(1.5 * SecondOrder{}.at(nu).sphere_drawn_in)),
        wider_by_(static_cast<float>(0.18 * (1 - 7 * (1 - 2 * (std::max)(nu, 0.3))))),
        across_(static_cast<float>(SecondOrder{}.at(nu).drag * (2 - nu) / 8)),
        compliance_across_(static_cast<float>(std::numbers::pi * (2 - nu) / 2)),
        root_of_strain_(root_of_strain_per_load(nu)) {}

  void forget() noexcept {
    drawn_ = raised_ = wider_ = deepest_share_ = rise_ = per_deepest_ = 0, factor_ = 1;
    common_.setZero(), stiffened_.setZero(), shift_.setZero();
  }
  /// After a solve for the loads P, q along the directions of pressing: r, displacements along these less the
  /// depths; w, the regular part, and `given`, by others' loads, both of which are not K P [m]; how firmly
  /// friction held the surface in the last tick (reaction.hpp), and e_w.
  void measure(const PointSystem& system, const VectorList& P, const float* q, const float* r,
               const VectorList& w, const auto& given, float held, float stretch) noexcept {
    const V zero(0.f);
    V loads{}, pressures{}, sunks{}, rests{}, nears{}, nearest{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> m = system.directions().load(i);
      const V qi(q + i), beside = dot(m, given.beyond(i)), rest = dot(m, w.load(i)) + beside,
                         sunk = V(r + i) + V(&system.depth[i]) + beside, near = sunk - (max)(rest, zero);
      loads += qi, pressures += qi * qi / V(system.areas() + i);
      sunks += qi * sunk, rests += qi * rest, nears += qi * near;
      nearest = (max)(nearest, select(qi > zero, near, zero));
    }
    const float load = reduce(loads), pressed = reduce(pressures), sunk = reduce(sunks),
                by_rest = reduce(rests), deepest = reduce_max(nearest);
    if (!(load > 0) || !(sunk > 0)) return;
    const float root = root_of_strain_ * pressed / load, e = root * root, bounded = e / std::sqrt(1 + e * e);
    const float fall = deepest > 0 ? clamp(1 - reduce(nears) / (load * deepest), 0.f, 1.f) : 0;
    const float wider = (std::max)(wider_by_ * bounded * (std::min)(5 * fall, 1.f), -0.15f);
    wider_ = wider < 0 ? (1 - held) * wider : wider;
    const float power = (1 + fall) / (1 - (std::min)(fall, 0.5f)),
                by_width = (1 + 1.5f * fall) * wider_ * (1 - 0.6f * wider_),
                softer = (1 + power * softening_ * bounded + by_width) / (1 + 0.4f * stretch) - 1;
    const float stiffer = (system.has_friction() ? 0.7f : 1.f) * drawn_in_ * (std::min)(root, max_root);
    deepest_share_ = system.deepest() > 0 ? (std::min)(deepest / system.deepest(), 2.f) : 0;
    take_depth(system.deepest());
    const float by_strain = (1 + softer) / (1 + stiffer);
    drawn_ = (1 + softer) / (1 + 7.f / 6 * wider_) - 1;
    raised_ = stiffer / (1 + stiffer) * (1 + drawn_), per_pressure_ = 1.5f * load / pressed;
    factor_ = 1 / (1 + (by_strain - 1) * clamp(1 - by_rest / sunk, 0.f, 1.f));
    if (!system.has_friction()) return;
    SimdVec3<V> directions{}, all{}, moved{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i);
      directions += qi * system.directions().load(i), all += P.load(i);
      moved += qi * (w.load(i) + given.load(i));
    }
    const float beta = root * (2.f / 3), kappa = across_ * beta / (1 + beta * beta),
                a = std::sqrt(carrying_area(load, pressed) / std::numbers::pi_v<float>);
    const Vec3<float> m = sum_of(directions) / load, F = sum_of(all) / load, w_mean = sum_of(moved) / load;
    const Mat3<float> across = m.squaredNorm() * Mat3<float>::Identity() - m * m.transpose(),
                      stiffened = kappa / (1 + kappa) * across;
    common_ = compliance_across_ / a * stiffened;
    stiffened_ = stiffened * F;
    const float s = w_mean.squaredNorm() / (4 * a * a);
    shift_ = across * (w_mean - m.dot(w_mean) * F) / (2 + 2 * s * s);
  }
  /// u -= G sum_j P_j.
  void add(const PointSystem& system, const VectorList& P, VectorList& u) const noexcept {
    SimdVec3<V> loads{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) loads += P.load(i);
    const SimdVec3<V> moved = each<V>(Vec3<float>(common_ * sum_of(loads)));
    for (std::size_t i = 0; i < system.stride(); i += V::size()) u.store(i, u.load(i) - moved);
  }
  /// G [1/m]
  [[nodiscard]] const Mat3<float>& common() const noexcept { return common_; }
  /// v [m]
  [[nodiscard]] const Vec3<float>& shift() const noexcept { return shift_; }
  /// The deepest of a tick, for depth(): as the last tick's d_0 would lag behind, its share of that is kept.
  void take_depth(float deepest) noexcept {
    const float d_0 = deepest_share_ * deepest;
    rise_ = wider_ * d_0, per_deepest_ = d_0 >= (std::numeric_limits<float>::min)() ? 1 / d_0 : 0;
  }
  /// What a depth d counts for in the linear equations [m].
  [[nodiscard]] float depth(float d) const noexcept {
    const float x = clamp(per_deepest_ * d, 0.f, 1.f);
    return factor_ * (d + rise_ * x * (2 - x));
  }
  /// What the near field of a load is drawn with beside it, q along m: so much more that the surface lies
  /// within s/6 of d_0 of where a ball's points hold it, k e under a flat face, but for raised(); and of all
  /// loads across m kappa/(1 + kappa) less, shared as q is [m^2].
  [[nodiscard]] Vec3<float> beside(const Vec3<float>& m, float q) const noexcept {
    return q * (drawn_ * m - stiffened_);
  }
  /// By how much the drawn near field is deeper than the tool lets the surface sink at point i [m]: X of what
  /// it sinks, where the pressure is p_0/2 and more, fading with it towards the rim. `pressure` has q
  /// and r as above, `regular` w.
  [[nodiscard]] float raised(std::size_t i, const PointSystem& system, const auto& pressure,
                             const auto& regular) const noexcept {
    const float by_rest = system.direction(i).dot(regular.response()[i]),
                near = pressure.r[i] + system.depth[i] - (std::max)(by_rest, 0.f);
    return raised_ * (std::max)(near, 0.f) * (std::min)(1.f, per_pressure_ * pressure.q[i] / system.area(i));
  }

 private:
  static constexpr float max_root = 1.5f;  // of X: a ball pressed in by twice its radius
  float softening_, drawn_in_, wider_by_;  // k; X/sqrt(e); s/e
  float across_, compliance_across_;       // kappa (1 + beta^2)/beta; c a
  float root_of_strain_;                   // sqrt(e) over q/A
  float drawn_ = 0, raised_ = 0, per_pressure_ = 0, factor_ = 1;      // per_pressure_: 2/p_0, of q/A
  float wider_ = 0, deepest_share_ = 0, rise_ = 0, per_deepest_ = 0;  // s; d_0 of the deepest; s d_0; 1/d_0
  Mat3<float> common_ = Mat3<float>::Zero();                          // G
  Vec3<float> stiffened_ = Vec3<float>::Zero();  // what the near field lacks, per normal load
  Vec3<float> shift_ = Vec3<float>::Zero();
};

/// Of a body whose response is linear.
struct LinearStrain {
  static constexpr bool active = false;
  explicit LinearStrain(double /*nu*/) {}
  [[nodiscard]] static Mat3<float> common() noexcept { return Mat3<float>::Zero(); }
  [[nodiscard]] static Vec3<float> beside(const Vec3<float>&, float) noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] static Vec3<float> shift() noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] static float raised(const auto&...) noexcept { return 0; }
  static void take_depth(float) noexcept {}
  [[nodiscard]] static float depth(float d) noexcept { return d; }
};

}  // namespace palpate::detail
