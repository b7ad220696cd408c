// SPDX-License-Identifier: MIT
#pragma once

/// @file  The force of a region as a sum over its points (section IV.C).

#include <palpate/core/vector.hpp>

#include <cstdint>

namespace palpate {

/// Sum over the points i of a region of F_i = (m_i/m) law(delta_i), along each point's own exit direction.
/// No equation number; IV.C. A sum that points enter and leave at zero does not depend on the clustering, and is the
/// gradient of a potential, so a tool without friction neither gains nor loses energy.
template <Real S>
struct RegionSum {
  Vec3<S> force = Vec3<S>::Zero();    ///< on the tool [N]
  Vec3<S> torque = Vec3<S>::Zero();   ///< about the tool's centre of mass [N m]
  Vec3<S> moment = Vec3<S>::Zero();   ///< sum of |F_i| x_i [N m]
  Vec3<S> exit = Vec3<S>::Zero();     ///< exit direction of the deepest point
  Vec3<S> place = Vec3<S>::Zero();    ///< the deepest point [m]
  S magnitude = S(0);                 ///< sum of |F_i| [N]
  S deepest = S(0);                   ///< largest delta_i [m]
  S spread = S(0);                    ///< sum of |F_i|^2/A_i [N^2/m^2]
  std::uint32_t points = 0;

  /// Adds the point at x [m] whose force is `f` [N] times the exit direction `gradient`; `arm` = x - centre of mass.
  void add(const Vec3<S>& x, const Vec3<S>& arm, const Vec3<S>& gradient, S depth, S f, S point_area) noexcept {
    const Vec3<S> F = f * gradient;
    force += F;
    torque += arm.cross(F);
    moment += f * x;
    magnitude += f;
    if (point_area > S(0)) spread += f * (f / point_area);
    ++points;
    if (depth > deepest) {
      deepest = depth;
      exit = gradient;
      place = x;
    }
  }

  /// Multiplies every force by `factor` [-].
  void scale(S factor) noexcept {
    force *= factor;
    torque *= factor;
    moment *= factor;
    magnitude *= factor;
    spread *= factor * factor;
  }

  /// The area that carries the force, (sum |F_i|)^2 / sum (|F_i|^2/A_i) [m^2]: the touching area where pressure is even,
  /// less where it is not, 0 for a point without area. Unlike sum A_i it does not jump when a point joins at zero force.
  [[nodiscard]] S area() const noexcept { return spread > S(0) ? magnitude * (magnitude / spread) : S(0); }
  /// The pressure centre [m]; the deepest point where the law gives no force. Continuous while points join and leave
  /// at zero force.
  [[nodiscard]] Vec3<S> centre() const noexcept {
    if (magnitude > S(0)) return moment / magnitude;
    return place;
  }
  /// Unit outward normal of the region: the direction of its force.
  [[nodiscard]] Vec3<S> normal() const noexcept {
    const Vec3<S> n = unit_or<S>(force, Vec3<S>::Zero());
    return n.squaredNorm() > S(0) ? n : unit_or<S>(exit, Vec3<S>::UnitY());
  }
};

}  // namespace palpate
