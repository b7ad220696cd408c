// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth of a resolved contact: by how much finite strain softens the near field, and
/// stiffens it across.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>
#include <palpate/response/second_order.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace palpate::detail {

/// A pressed ball's near field is softer than linear elasticity's by k d_H/R, k fitted on finite elements
/// (response/second_order.hpp):
///
///     K P (1 + k e) + W P = d,   e = d_H/R = (pi/2 p_0/E')^2,   p_0 = 4/3 p,   p: mean of pressures by load
///
/// so e is known of contacts of any shape; of flat ones it is a measure of the same size. Deeper than k was
/// fitted it is bounded: e/sqrt(1 + e^2). The depths are divided by 1 + k e (K P)/d, with e and the mean of
/// (K P)/d of the last tick. k is that of a ball on a flat body; on a convex one the tool's part of the
/// curvature is less: left out.
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
      : k_(static_cast<float>(SecondOrder{}.at(nu).sphere_softening)),
        across_(static_cast<float>(SecondOrder{}.at(nu).drag * (2 - nu) / 8)),
        compliance_across_(static_cast<float>(std::numbers::pi * (2 - nu) / 2)),
        root_of_strain_(
            static_cast<float>(std::numbers::pi / 2 * (4. / 3) * 2 * std::numbers::pi * (1 - nu))) {}

  void forget() noexcept {
    softening_ = 0, factor_ = 1;
    common_.setZero(), stiffened_.setZero(), shift_.setZero();
  }
  /// After a solve for the loads P, q along the directions of pressing: r, displacements along these less the
  /// depths; w, the regular part, and `given`, by others' loads, both of which are not K P [m].
  void measure(const PointSystem& system, const VectorList& P, const float* q, const float* r,
               const VectorList& w, const auto& given) noexcept {
    V loads{}, pressures{}, sunks{}, rests{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i), beside = dot(system.directions().load(i), given.beyond(i));
      loads += qi, pressures += qi * qi / V(system.areas() + i);
      sunks += qi * (V(r + i) + V(&system.depth[i]) + beside);
      rests += qi * (dot(system.directions().load(i), w.load(i)) + beside);
    }
    const float load = reduce(loads), pressed = reduce(pressures), sunk = reduce(sunks),
                by_rest = reduce(rests);
    if (!(load > 0) || !(sunk > 0)) return;
    const float root = root_of_strain_ * pressed / load, e = root * root;
    softening_ = k_ * e / std::sqrt(1 + e * e);
    factor_ = 1 / (1 + softening_ * clamp(1 - by_rest / sunk, 0.f, 1.f));
    if (!system.has_friction()) return;
    SimdVec3<V> directions{}, all{}, moved{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i);
      directions += qi * system.directions().load(i), all += P.load(i);
      moved += qi * (w.load(i) + given.load(i));
    }
    const float beta = root * (2.f / 3), kappa = across_ * beta / (1 + beta * beta),
                a = std::sqrt(9 * load * load / (8 * std::numbers::pi_v<float> * pressed));
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
  /// Of the depths.
  [[nodiscard]] float factor() const noexcept { return factor_; }
  /// What the near field of a load is drawn with beside it, q along m: k e more, and of all loads across m
  /// kappa/(1 + kappa) less, shared as q is [m^2].
  [[nodiscard]] Vec3<float> beside(const Vec3<float>& m, float q) const noexcept {
    return q * (softening_ * m - stiffened_);
  }

 private:
  float k_, across_, compliance_across_;  // the last two: kappa (1 + beta^2)/beta; c a
  float root_of_strain_;                  // p/E' = 2 pi (1 - nu) q/A
  float softening_ = 0, factor_ = 1;
  Mat3<float> common_ = Mat3<float>::Zero();     // G
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
  [[nodiscard]] static constexpr float factor() noexcept { return 1; }
};

}  // namespace palpate::detail
