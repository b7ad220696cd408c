// SPDX-License-Identifier: MIT
#pragma once

/// @file Second order in depth of a resolved contact: by how much finite strain softens the near field.

#include <palpate/core/scalar.hpp>
#include <palpate/resolved/detail/point_system.hpp>
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
class FiniteStrain {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  explicit FiniteStrain(double nu)
      : k_(static_cast<float>(SecondOrder{}.at(nu).sphere_softening)),
        root_of_strain_(
            static_cast<float>(std::numbers::pi / 2 * (4. / 3) * 2 * std::numbers::pi * (1 - nu))) {}

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
  /// k e
  [[nodiscard]] float softening() const noexcept { return softening_; }

 private:
  float k_, root_of_strain_;  // p/E' = 2 pi (1 - nu) q/A
  float softening_ = 0, factor_ = 1;
};

/// Of a body whose response is linear.
struct LinearStrain {
  static constexpr bool active = false;
  explicit LinearStrain(double /*nu*/) {}
  [[nodiscard]] static constexpr float softening() noexcept { return 0; }
  [[nodiscard]] static constexpr float factor() noexcept { return 1; }
};

}  // namespace palpate::detail
