// SPDX-License-Identifier: MIT
#pragma once

/// @file How a contact that is pressed in is stiffer to a turn about the direction of pressing.

#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace palpate::detail {

/// On the half-space a disc that sticks turns by theta = 3 M/(16 mu a^3) about its axis [reissner1944]. A
/// face that lies deeper than its rim by z meets more of the body: where it is moved on by z, the energy
/// grows by tau^2/(2 mu) z per area, with the disc's tractions tau = 4/pi mu theta r/sqrt(a^2 - r^2). Under
/// a ball, z = (a^2 - r^2)/(2 R), that is kappa of the disc's own:
///
///     u = K P + W P - 3 pi/(4 a^3) kappa/(1 + kappa) m x (x - mean x) M,   kappa = 3/(4 pi) a/R
///
/// Where friction has drawn the surface together under the tool, by the strain e, and holds it there, the
/// contact is wider by that in the undeformed body, and a disc as much wider stiffer by 3 e. And rubber that
/// is pressed together, by (1 - 2 nu) p/mu at the surface, is stiffer to shear by 2/3 of that, of which it
/// counts half, for it falls off with depth as the turn does:
///
///     1 + kappa = (1 + 3/(4 pi) a/R) (1 + 3 e) (1 + (1 - 2 nu) p/(3 mu))
///
/// by at most 0.3, 0.3 and 0.2, and kappa <= 0.4 in all: more could be taken off than few points yield, whose
/// area has not the radius a below. e: regression over r of what points hold, by load; p: mean by load.
///
/// M: moment of the loads P about m. a: radius of the area that carries, at least 0.7 of the farthest
/// point's distance: contacts far apart are less stiff to a turn than a disc about them all, and lose no
/// more than a share of what that disc has. 1/R: slope of the tool's own normals over r, by regression over
/// the loads, where r^2 is less than 1.2 of its mean: a flat face's rounded rim does not count, nor does a
/// hollow.
class TwistStiffening {
 public:
  using V = VectorList::V;

  /// With normal loads q, which `fit` is of, the tool's slopes to the directions of pressing, and where
  /// points that stick hold the surface.
  void measure(const PointSystem& system, const float* q, const LoadFit& fit, const VectorList& slopes,
               const VectorList& anchors) noexcept {
    per_moment_ = 0;
    if (!fit.has_load()) return;
    mean_ = fit.mean(), m_ = fit.direction();
    const float load = fit.load();
    const SimdVec3<V> mean = each(mean_);
    V squares{}, farthest{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> r = system.feet().load(i) - mean;
      squares += V(q + i) * dot(r, r);
      farthest = (max)(farthest, is_point(system, i) * dot(r, r));
    }
    constexpr float inner = 1.2f, pi = std::numbers::pi_v<float>;
    const float spread_of_all = reduce(squares);
    const V near(inner * spread_of_all / load);
    V turns{}, spreads{}, drawn{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> r = system.feet().load(i) - mean;
      const V r2 = dot(r, r), w = V(q + i) * (max)(near - r2, V(0.f));
      turns += w * dot(slopes.load(i), r), spreads += w * r2;
      drawn += V(q + i) * dot(across(system.directions().load(i), anchors.load(i)), r);
    }
    const float turn = (std::max)(reduce(turns), 0.f), spread = reduce(spreads);
    if (!(spread > 0)) return;
    const float a2 = (std::max)(carrying_area(load, fit.pressed()) / pi, reduce_max(farthest) / 2),
                a = std::sqrt(a2), tool = (std::min)(3 / (4 * pi) * (a * turn / spread), 0.3f),
                strain = std::clamp(-reduce(drawn) / spread_of_all, 0.f, 0.1f),
                dense = (std::min)(4 * pi / 3 * system.b() * fit.pressed() / load, 0.2f),
                kappa = (std::min)((1 + tool) * (1 + 3 * strain) * (1 + dense) - 1, 0.4f);
    per_moment_ = 3 * pi / (4 * a * a2) * kappa / (1 + kappa);
  }
  /// u less what the turn is less.
  void add(const PointSystem& system, const VectorList& P, VectorList& u) const noexcept {
    if (!(per_moment_ > 0)) return;
    const SimdVec3<V> m = each(m_), mean = each(mean_);
    V moments{};
    for (std::size_t i = 0; i < system.stride(); i += V::size())
      moments += dot(m, cross(system.feet().load(i) - mean, P.load(i)));
    const SimdVec3<V> turn = each(Vec3<float>(per_moment_ * reduce(moments) * m_));
    for (std::size_t i = 0; i < system.stride(); i += V::size())
      u.store(i, u.load(i) - is_point(system, i) * cross(turn, system.feet().load(i) - mean));
  }

 private:
  // 0 for what fills up registers, far away, else 1.
  [[nodiscard]] PALPATE_INLINE static V is_point(const PointSystem& system, std::size_t i) noexcept {
    return dot(system.directions().load(i), system.directions().load(i));
  }

  Vec3<float> m_ = Vec3<float>::Zero(), mean_ = Vec3<float>::Zero();
  float per_moment_ = 0;  // [1/m^3]
};

}  // namespace palpate::detail
