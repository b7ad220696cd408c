// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth of a resolved contact: by how much finite strain softens the near field, and
/// what it makes of the limit of friction.

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
/// Where a tool slides, friction takes mu p per area of its surface and length of the body's surface that
/// passes it. Of a slope g between the tool's normal and m both are larger than seen along m, by
/// sqrt(1 + g^2) and sqrt(1 + g^2/2), the mean over directions. And p has pressed together what passes, by
/// (1 - 2 nu) p/(4 mu) on a half-space. So the limit of a point's tractions is mu s q,
///
///     s = sqrt(1 + g^2) sqrt(1 + g^2/2) (1 - (1 - 2 nu) pi q/A),   g <= 3/4, the last factor >= 1/2
///
/// What is steeper is a tool's rim, round which nothing slides; 3/4 is chosen on finite elements.
class FiniteStrain {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  explicit FiniteStrain(double nu)
      : k_(static_cast<float>(SecondOrder{}.at(nu).sphere_softening)),
        root_of_strain_(
            static_cast<float>(std::numbers::pi / 2 * (4. / 3) * 2 * std::numbers::pi * (1 - nu))),
        strain_across_(static_cast<float>(-(1 - 2 * nu) * std::numbers::pi)) {}

  void forget() noexcept { softening_ = 0, factor_ = 1; }
  /// After a solve with the normal loads q: r, displacements along the directions of pressing less the
  /// depths; w, the regular part, and `given`, by others' loads, both of which are not K P [m].
  void measure(const PointSystem& system, const float* q, const float* r, const VectorList& w,
               const auto& given) noexcept {
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
  }
  /// Of the depths.
  [[nodiscard]] float factor() const noexcept { return factor_; }
  /// s of points i .. of the tool's unit outward normals, with the normal loads q.
  [[nodiscard]] PALPATE_INLINE V limit_per_mu(const PointSystem& system, std::size_t i,
                                              const SimdVec3<V>& outward, const V& q) const noexcept {
    const V area = V(1.f) / clamp(dot(outward, system.directions().load(i)), rim, 1.f),
            stretch = sqrt(V(0.5f) * (V(1.f) + area * area)),
            strain = (max)(V(strain_across_) * q / V(system.areas() + i), V(-0.5f));
    return area * stretch * (V(1.f) + strain);
  }
  /// k e
  [[nodiscard]] float softening() const noexcept { return softening_; }

 private:
  static constexpr float rim = 0.8f;  // cosine of the slope 3/4

  float k_, root_of_strain_, strain_across_;  // p/E' = 2 pi (1 - nu) q/A, p/(4 mu) = pi q/A
  float softening_ = 0, factor_ = 1;
};

/// Of a body whose response is linear.
struct LinearStrain {
  static constexpr bool active = false;
  explicit LinearStrain(double /*nu*/) {}
  [[nodiscard]] static constexpr float softening() noexcept { return 0; }
  [[nodiscard]] static constexpr float factor() noexcept { return 1; }
  [[nodiscard]] static VectorList::V limit_per_mu(const auto&...) noexcept { return VectorList::V(1.f); }
};

}  // namespace palpate::detail
