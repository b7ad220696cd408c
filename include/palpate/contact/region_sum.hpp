// SPDX-License-Identifier: MIT
#pragma once

/// @file  The force of a region as a sum over its points (section IV.C).

#include <palpate/core/vector.hpp>
#include <palpate/geometry/concept.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpate {

/// Sum over the points i of a region of F_i = (m_i/m) law(delta_i), along each point's own exit direction. No
/// equation number; IV.C. A sum that points enter and leave at zero does not depend on the clustering, and is
/// the gradient of a potential, so a tool without friction neither gains nor loses energy.
template <Real S>
struct RegionSum {
  Vec3<S> force = Vec3<S>::Zero();   ///< on the tool [N]
  Vec3<S> torque = Vec3<S>::Zero();  ///< about the tool's centre of mass [N m]
  Vec3<S> moment = Vec3<S>::Zero();  ///< sum of |F_i| x_i [N m]
  Vec3<S> exit = Vec3<S>::Zero();    ///< exit direction of the deepest point
  Vec3<S> place = Vec3<S>::Zero();   ///< the deepest point [m]
  S magnitude = S(0);                ///< sum of |F_i| [N]
  S deepest = S(0);                  ///< largest delta_i [m]
  S spread = S(0);                   ///< sum of |F_i|^2/A_i [N^2/m^2]
  std::uint32_t points = 0;

  /// Adds the point at x [m] whose force is `f` [N] times the exit direction `gradient`; `arm` = x - centre
  /// of mass.
  void add(const Vec3<S>& x, const Vec3<S>& arm, const Vec3<S>& gradient, S depth, S f,
           S point_area) noexcept {
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

  /// Adds a force [N] that belongs to no point; `arm` [m]: from the centre of mass to where it acts.
  void add(const Vec3<S>& arm, const Vec3<S>& f) noexcept {
    force += f;
    torque += arm.cross(f);
  }

  /// Multiplies every force by `factor` [-].
  void scale(S factor) noexcept {
    force *= factor;
    torque *= factor;
    moment *= factor;
    magnitude *= factor;
    spread *= factor * factor;
  }

  /// The area that carries the force, (sum |F_i|)^2 / sum (|F_i|^2/A_i) [m^2]: the touching area where
  /// pressure is even, less where it is not, 0 for a point without area. Unlike sum A_i it does not jump when
  /// a point joins at zero force.
  [[nodiscard]] S area() const noexcept { return spread > S(0) ? magnitude * (magnitude / spread) : S(0); }
  /// The pressure centre [m]; the deepest point where the law gives no force. Continuous while points join
  /// and leave at zero force.
  [[nodiscard]] Vec3<S> centre() const noexcept {
    if (magnitude > S(0)) return moment / magnitude;
    return place;
  }
  /// |force| [N].
  [[nodiscard]] S normal_force() const noexcept { return force.norm(); }
  /// Unit outward normal of the region: the direction of its force.
  [[nodiscard]] Vec3<S> normal() const noexcept {
    const Vec3<S> n = unit_or<S>(force, Vec3<S>::Zero());
    return n.squaredNorm() > S(0) ? n : unit_or<S>(exit, Vec3<S>::UnitY());
  }
};

/// The RegionSum of a tool that is one point, set by one add(): the same to rounding, without roots and
/// divisions.
template <Real S>
class PointForce {
 public:
  Vec3<S> force = Vec3<S>::Zero();   ///< on the tool [N]
  Vec3<S> torque = Vec3<S>::Zero();  ///< about the tool's centre of mass [N m]
  S deepest = S(0);                  ///< delta [m]
  std::uint32_t points = 0;

  /// As RegionSum's; the area is not used.
  void add(const Vec3<S>& x, const Vec3<S>& arm, const Vec3<S>& gradient, S depth, S f,
           S /*point_area*/) noexcept {
    force = f * gradient;
    torque = arm.cross(force);
    deepest = depth;
    points = 1;
    place_ = x;
    normal_ = gradient;
    normal_force_ = f;
    const S square = gradient.squaredNorm();  // of a unit vector off 1 by its roundings
    if (std::abs(square - S(1)) <= S(8) * std::numeric_limits<S>::epsilon()) return;
    normal_ = unit_or<S>(gradient, Vec3<S>::UnitY());  // over an edge: geometry/concept.hpp
    normal_force_ = f * std::sqrt(square);
  }
  void scale(S factor) noexcept {
    force *= factor;
    torque *= factor;
    normal_force_ *= factor;
  }
  [[nodiscard]] S area() const noexcept { return S(0); }
  [[nodiscard]] Vec3<S> centre() const noexcept { return place_; }
  [[nodiscard]] S normal_force() const noexcept { return normal_force_; }
  [[nodiscard]] Vec3<S> normal() const noexcept { return normal_; }

 private:
  Vec3<S> place_ = Vec3<S>::Zero(), normal_ = Vec3<S>::UnitY();
  S normal_force_ = S(0);
};

/// A RegionSum in the making, `lane_count` points at a time: lane i adds up the points i of all leaves,
/// total() adds the lanes. By the cache line, whatever the vector flags.
template <Real S>
class alignas(64) LaneSum {
 public:
  /// About this centre of mass [m].
  explicit LaneSum(const Vec3<S>& centre_of_mass) noexcept : centre_(centre_of_mass) {}

  /// Adds points at x with forces f [N] along their exit directions; f is 0 and the depth <= 0 for those that
  /// do not belong. `per_area`: 1/A_i [1/m^2].
  PALPATE_FLATTEN void add(const PointLanes<S>& x, const PenetrationLanes<S>& in,
                           const detail::LaneArray<S>& f,
                           const std::array<S, lane_count>& per_area) noexcept {
    using detail::lane_array;
    const Lanes px = lane_array(x.x), py = lane_array(x.y), pz = lane_array(x.z),
                Fx = f * lane_array(in.gradient_x), Fy = f * lane_array(in.gradient_y),
                Fz = f * lane_array(in.gradient_z);
    const Lanes ax = px - centre_.x(), ay = py - centre_.y(), az = pz - centre_.z();
    force_[0] += Fx, force_[1] += Fy, force_[2] += Fz;
    torque_[0] += ay * Fz - az * Fy, torque_[1] += az * Fx - ax * Fz, torque_[2] += ax * Fy - ay * Fx;
    moment_[0] += f * px, moment_[1] += f * py, moment_[2] += f * pz;
    magnitude_ += f;
    spread_ += f * (f * lane_array(per_area));
    for (const S depth : in.depth) sum_.points += depth > S(0) ? 1u : 0u;
    if (!(lane_array(in.depth).maxCoeff() > sum_.deepest)) return;
    for (std::size_t i = 0; i < in.depth.size(); ++i) {
      if (!(in.depth[i] > sum_.deepest)) continue;
      sum_.deepest = in.depth[i];
      sum_.exit = Vec3<S>(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
      sum_.place = Vec3<S>(x.x[i], x.y[i], x.z[i]);
    }
  }

  /// Adds a force [N] at x [m] that belongs to no point.
  void add(const Vec3<S>& x, const Vec3<S>& f) noexcept { sum_.add(Vec3<S>(x - centre_), f); }

  [[nodiscard]] RegionSum<S> total() const noexcept {
    RegionSum<S> sum = sum_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<int>(axis);
      sum.force[k] += force_[axis].sum();
      sum.torque[k] += torque_[axis].sum();
      sum.moment[k] += moment_[axis].sum();
    }
    sum.magnitude += magnitude_.sum();
    sum.spread += spread_.sum();
    return sum;
  }

 private:
  using Lanes = detail::LaneArray<S>;
  using Lanes3 = std::array<Lanes, 3>;

  [[nodiscard]] static Lanes3 zero() noexcept { return {Lanes::Zero(), Lanes::Zero(), Lanes::Zero()}; }

  Lanes3 force_ = zero(), torque_ = zero(), moment_ = zero();
  Lanes magnitude_ = Lanes::Zero(), spread_ = Lanes::Zero();
  Vec3<S> centre_;
  RegionSum<S> sum_{};  // what is not a plain sum: the deepest point and the count
};

}  // namespace palpate
