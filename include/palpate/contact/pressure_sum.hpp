// SPDX-License-Identifier: MIT
#pragma once

/// @file  The force of a region as the pressure on the tool's surface, a leaf of points at a time (IV.C).

#include <palpate/contact/region_sum.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/simd_vec3.hpp>

#include <array>
#include <limits>

namespace palpate {

/// The tool's constants of a leaf of points. Tool coordinates.
template <Real S>
struct alignas(64) PressureShare {
  std::array<S, batch_size> x, y, z;     ///< a_i, outward [m^2]
  std::array<S, batch_size> mx, my, mz;  ///< (x_i - centre of mass) x a_i [m^3]
  std::array<S, batch_size> per_area;    ///< 1 / |a_i| [1/m^2]; 0 where a_i is 0
};

/// A RegionSum in the making from the pressure p_i on the tool's vector areas a_i. No equation number:
/// reading of IV.C, derived and compared in docs/contact.md.
///
///     F = sum_i [ - p_i a_i + p_i |a_i| psi(t_i) g_i ]
///     T = sum_i [ x_i x F_i - U_i psi'(t_i) a_i x g_i ]          x_i from the centre of mass
///     t = max(0, a.g / |a|),   psi(t) = t^2 (2 - t)
///
/// | symbol | what                                                                      | unit |
/// |--------|---------------------------------------------------------------------------|------|
/// | p_i    | pressure law(delta_i) / A_0; 0 where the point is outside                 | Pa   |
/// | U_i    | its integral over depth, energy(delta_i) / A_0                            | J/m^2 |
/// | g_i    | exit direction                                                            | -    |
/// | t_i    | how far the tool's face there looks along the exit; 0 for all that pushes | -    |
///
/// - The first term is the gradient of W = the integral of p over the part of the tool that is inside. Walls
///   cancel, and nothing depends on which way the exit is.
/// - The second gives back what a face that looks out of the body would take off, so that a tool pressed
///   deeper than it is tall is not felt by its buoyancy alone: the body above it has been pushed away too. It
///   is the gradient of sum U_i psi |a_i| where the body is flat; its psi has no slope at a wall, so that the
///   torque does not jump when a wall tilts. Left out is the turning of g_i from place to place: on a body of
///   radius R, U_i psi' / R beside p_i, so that a deep tool with its back inside a curved body is passive to
///   some percent only (docs/contact.md).
///
/// Weights of the pressure centre are f_i = p_i max(0, -a_i.g_i), the force of a point along the exit: none
/// is negative, so the centre lies among the points. Sums are in tool coordinates; total() turns them once.
template <Real S>
class PressureSum : public detail::BatchSums<S> {
  using Base = detail::BatchSums<S>;

 public:
  using List = typename Base::List;

  /// At this pose of the tool, which outlives the sum, about its centre of mass [m], tool coordinates.
  PressureSum(const Pose<S>& pose, const Vec3<S>& centre_of_mass) noexcept
      : pose_(pose), centre_(centre_of_mass) {}

  /// Adds points at x (tool coordinates) under pressures p [Pa], 0 for those that do not belong (depth <= 0).
  /// True when some of them face along their exit: then add_backs() is due.
  [[nodiscard]] bool add(const PointBatch<S>& x, const PenetrationBatch<S>& in, const PressureShare<S>& share,
                         const List& p) noexcept {
    this->begin_leaf();
    bool backs = false;
    for (std::size_t i = 0; i < batch_size; i += V::size()) backs |= add_part(i, x, in, share, p);
    this->count(x, in);
    return backs;
  }

  /// The term with psi, for the points just added. `energy`: U_i [J/m^2], 0 where p_i is. Gives psi |a_i|
  /// [m^2].
  List add_backs(const PointBatch<S>& x, const PenetrationBatch<S>& in, const PressureShare<S>& share,
                 const List& p, const List& energy) noexcept {
    List given_back;
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const Vector a = area(share, i), g = exit(in, i);
      const V w = dot(a, g), t = (detail::max)(w * V(&share.per_area[i]), V{});
      const V back = w * t * (S(2) - t);
      back.copy_to(&given_back[i]);
      const Vector q = (V(&p[i]) * back) * g;
      const Vector arm{V(&x.x[i]) - centre_.x(), V(&x.y[i]) - centre_.y(), V(&x.z[i]) - centre_.z()};
      force_.add(i, V(S(-1)) * q);
      torque_.add(i, (V(&energy[i]) * t * (S(4) - S(3) * t)) * cross(a, g) - cross(arm, q));
    }
    return given_back;
  }

  /// Adds a force [N] at x [m] that belongs to no point, both in object coordinates.
  void add(const Vec3<S>& x, const Vec3<S>& f) noexcept { sum_.add(Vec3<S>(x - pose_ * centre_), f); }

  [[nodiscard]] const Pose<S>& pose() const noexcept { return pose_; }
  /// In object coordinates. Precondition: not empty().
  [[nodiscard]] RegionSum<S> total() const noexcept {
    RegionSum<S> sum = sum_;
    sum.position = pose_ * sum_.position;
    sum.magnitude += Base::total(magnitude_);
    sum.spread += Base::total(spread_);
    sum.force -= pose_.rotation * Base::total(force_);
    sum.torque -= pose_.rotation * Base::total(torque_);
    sum.moment += pose_.rotation * Base::total(moment_) + sum.magnitude * pose_.translation;
    return sum;
  }

 private:
  using V = typename Base::V;
  using Vector = typename Base::Vector;
  // Force and torque: of the pressure, so less those on the tool. sum_.position: tool coordinates.
  using Base::force_, Base::torque_, Base::moment_, Base::magnitude_, Base::spread_, Base::sum_;

  [[nodiscard]] static PALPATE_INLINE Vector area(const PressureShare<S>& share, std::size_t i) noexcept {
    return {V(&share.x[i]), V(&share.y[i]), V(&share.z[i])};
  }
  /// Exit directions of the points from i on, tool coordinates.
  [[nodiscard]] PALPATE_INLINE Vector exit(const PenetrationBatch<S>& in, std::size_t i) const noexcept {
    const auto& R = pose_.rotation;
    const V x(&in.gradient_x[i]), y(&in.gradient_y[i]), z(&in.gradient_z[i]);
    return {R(0, 0) * x + R(1, 0) * y + R(2, 0) * z, R(0, 1) * x + R(1, 1) * y + R(2, 1) * z,
            R(0, 2) * x + R(1, 2) * y + R(2, 2) * z};
  }

  PALPATE_INLINE bool add_part(std::size_t i, const PointBatch<S>& x, const PenetrationBatch<S>& in,
                               const PressureShare<S>& share, const List& pressures) noexcept {
    // Below, a face is across the exit to rounding, and psi and its slope are nothing.
    constexpr S wall = S(8) * std::numeric_limits<S>::epsilon();
    const Vector a = area(share, i);
    const V p(&pressures[i]), w = dot(a, exit(in, i)), f = p * (detail::max)(-w, V{});
    force_.add(i, p * a);
    torque_.add(i, p * Vector{V(&share.mx[i]), V(&share.my[i]), V(&share.mz[i])});
    moment_.add(i, f * Vector{V(&x.x[i]), V(&x.y[i]), V(&x.z[i])});
    Base::add(magnitude_, i, f);
    Base::add(spread_, i, f * p);
    return detail::any_of(p * (w * V(&share.per_area[i]) - wall) > V{});
  }

  const Pose<S>& pose_;
  Vec3<S> centre_;
};

}  // namespace palpate
