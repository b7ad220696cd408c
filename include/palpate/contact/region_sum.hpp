// SPDX-License-Identifier: MIT
#pragma once

/// @file  The force of a region as a sum over its points (section IV.C).

#include <palpate/core/simd_vec3.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/geometry/concept.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpate {

namespace detail {
/// `simd_group`, but no longer than a batch: for a sum over the points of a leaf.
template <Real S>
using batch_group = Simd<S, (simd_group<S>::size() < batch_size ? static_cast<int>(simd_group<S>::size())
                                                                : static_cast<int>(batch_size))>;

/// The largest of a leaf's numbers.
template <Real S>
[[nodiscard]] PALPATE_INLINE S max_of(const std::array<S, batch_size>& list) noexcept {
  return reduce_max(Simd<S, static_cast<int>(batch_size)>(list.data()));
}
}  // namespace detail

/// Sum over the points i of a region of F_i = (m_i/m) law(delta_i), along each point's own exit direction. No
/// equation number; IV.C. A sum that points enter and leave at zero does not depend on the clustering, and is
/// the gradient of a potential, so a tool without friction neither gains nor loses energy.
template <Real S>
struct RegionSum {
  Vec3<S> force = Vec3<S>::Zero();     ///< on the tool [N]
  Vec3<S> torque = Vec3<S>::Zero();    ///< about the tool's centre of mass [N m]
  Vec3<S> moment = Vec3<S>::Zero();    ///< sum of |F_i| x_i [N m]
  Vec3<S> exit = Vec3<S>::Zero();      ///< exit direction of the deepest point
  Vec3<S> position = Vec3<S>::Zero();  ///< of the deepest point [m]
  S magnitude = S(0);                  ///< sum of |F_i| [N]
  S deepest = S(0);                    ///< largest delta_i [m]
  S spread = S(0);                     ///< sum of |F_i|^2/A_i [N^2/m^2]
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
      position = x;
    }
  }

  /// Adds a force [N] that belongs to no point; `arm` [m]: from the centre of mass to where it acts.
  void add(const Vec3<S>& arm, const Vec3<S>& f) noexcept {
    force += f;
    torque += arm.cross(f);
  }

  /// Another force [N] and torque [N m] in place of the sum's, of this exit direction.
  void hold(const Vec3<S>& held_force, const Vec3<S>& held_torque, const Vec3<S>& held_exit) noexcept {
    force = held_force;
    torque = held_torque;
    exit = held_exit;
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
    return position;
  }
  /// How deep the deepest point is: in the body, or below the plane through `origin` across `normal` where
  /// that is more [m].
  [[nodiscard]] S depth_below(const Vec3<S>& origin, const Vec3<S>& normal) const noexcept {
    const S below = normal.dot(origin - position);
    return below > deepest ? below : deepest;
  }
  /// |force| [N].
  [[nodiscard]] S normal_force() const noexcept { return force.norm(); }
  /// Unit outward normal of the region: the direction of its force.
  [[nodiscard]] Vec3<S> normal() const noexcept {
    const Vec3<S> n = unit_or<S>(force, Vec3<S>::Zero());
    return n.squaredNorm() > S(0) ? n : unit_or<S>(exit, Vec3<S>::UnitY());
  }
};

/// A RegionSum that also has what laws with memory ask for, w_i = m_i/m being the points' weights.
template <Real S, class Base = RegionSum<S>>
struct EnergySum : Base {
  S energy = S(0);  ///< sum of w_i W(delta_i) [J]
  S square = S(0);  ///< sum of w_i law(delta_i)^2 [N^2]

  /// Of the points that carry the force, (sum |F_i|)^2 / sum (|F_i|^2/w_i) [-]: all of them where pressure is
  /// even.
  [[nodiscard]] S weight() const noexcept {
    return square > S(0) ? this->magnitude * (this->magnitude / square) : S(0);
  }
  /// Multiplies every weight by `factor` [-].
  void scale(S factor) noexcept {
    RegionSum<S>::scale(factor);
    energy *= factor;
    square *= factor;
  }
};

/// The RegionSum of a tool that is one point, undefined until one add() sets it: the same to rounding,
/// without roots and divisions.
template <Real S>
class PointForce {
 public:
  Vec3<S> force;     ///< on the tool [N]
  Vec3<S> torque;    ///< about the tool's centre of mass [N m]
  Vec3<S> exit;      ///< exit direction, unit
  Vec3<S> position;  ///< [m]
  S deepest;         ///< delta [m]
  std::uint32_t points;

  /// As RegionSum's; the area is not used.
  void add(const Vec3<S>& x, const Vec3<S>& arm, const Vec3<S>& gradient, S depth, S f,
           S /*point_area*/) noexcept {
    force = f * gradient;
    torque = arm.cross(force);
    deepest = depth;
    points = 1;
    position = x;
    exit = gradient;
    normal_force_ = f;
    const S square = gradient.squaredNorm();  // of a unit vector off 1 by its roundings
    if (std::abs(square - S(1)) <= S(8) * std::numeric_limits<S>::epsilon()) return;
    exit = unit_or<S>(gradient, Vec3<S>::UnitY());  // over an edge: geometry/concept.hpp
    normal_force_ = f * std::sqrt(square);
  }
  void hold(const Vec3<S>& held_force, const Vec3<S>& held_torque, const Vec3<S>& held_exit) noexcept {
    force = held_force;
    torque = held_torque;
    exit = held_exit;
    normal_force_ = force.norm();
  }
  void scale(S factor) noexcept {
    force *= factor;
    torque *= factor;
    normal_force_ *= factor;
  }
  [[nodiscard]] S area() const noexcept { return S(0); }
  [[nodiscard]] S depth_below(const Vec3<S>&, const Vec3<S>&) const noexcept { return deepest; }
  [[nodiscard]] Vec3<S> centre() const noexcept { return position; }
  [[nodiscard]] S normal_force() const noexcept { return normal_force_; }
  [[nodiscard]] Vec3<S> normal() const noexcept { return exit; }

 private:
  S normal_force_;
};

namespace detail {
/// What sums of a region in the making have in common. Entry i of every list sums point i of all leaves.
template <Real S>
class alignas(64) BatchSums {
 public:
  using List = std::array<S, batch_size>;

  /// True before the first leaf.
  [[nodiscard]] bool empty() const noexcept { return empty_; }

 protected:
  using V = batch_group<S>;
  using Vector = SimdVec3<V>;
  struct List3 {
    List x, y, z;
    PALPATE_INLINE void add(std::size_t i, const Vector& a) noexcept {
      BatchSums::add(x, i, a.x), BatchSums::add(y, i, a.y), BatchSums::add(z, i, a.z);
    }
  };
  static PALPATE_INLINE void add(List& list, std::size_t i, const V& a) noexcept {
    (V(&list[i]) + a).copy_to(&list[i]);
  }
  [[nodiscard]] static S total(const List& list) noexcept {
    return reduce(Simd<S, static_cast<int>(batch_size)>(list.data()));
  }
  [[nodiscard]] static Vec3<S> total(const List3& list) noexcept {
    return {total(list.x), total(list.y), total(list.z)};
  }

  /// Before each leaf. Not in the constructor: a tool in free air needs none of it.
  PALPATE_INLINE void begin_leaf() noexcept {
    if (!empty_) return;
    for (List3* const list : {&force_, &torque_, &moment_})
      list->x.fill(S(0)), list->y.fill(S(0)), list->z.fill(S(0));
    magnitude_.fill(S(0));
    spread_.fill(S(0));
    empty_ = false;
  }
  /// Counts a leaf's points and keeps the deepest.
  PALPATE_INLINE void count(const PointBatch<S>& x, const PenetrationBatch<S>& in) noexcept {
    for (const S depth : in.depth) sum_.points += depth > S(0) ? 1u : 0u;
    if (!(max_of(in.depth) > sum_.deepest)) return;
    for (std::size_t i = 0; i < in.depth.size(); ++i) {
      if (!(in.depth[i] > sum_.deepest)) continue;
      sum_.deepest = in.depth[i];
      sum_.exit = Vec3<S>(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
      sum_.position = Vec3<S>(x.x[i], x.y[i], x.z[i]);
    }
  }

  List3 force_, torque_, moment_;
  List magnitude_, spread_;
  RegionSum<S> sum_{};  // what is not a plain sum: the deepest point and the count

 private:
  bool empty_ = true;
};
}  // namespace detail

/// A RegionSum in the making, a leaf of `batch_size` points at a time; total() adds the entries up.
template <Real S>
class LeafSum : public detail::BatchSums<S> {
  using Base = detail::BatchSums<S>;

 public:
  using List = typename Base::List;

  /// About this centre of mass [m].
  explicit LeafSum(const Vec3<S>& centre_of_mass) noexcept : centre_(centre_of_mass) {}

  /// Adds points at x with forces f [N] along their exit directions; f is 0 and the depth <= 0 for those that
  /// do not belong. `per_area`: 1/A_i [1/m^2].
  void add(const PointBatch<S>& x, const PenetrationBatch<S>& in, const List& f,
           const List& per_area) noexcept {
    this->begin_leaf();
    for (std::size_t i = 0; i < batch_size; i += V::size()) add_part(i, x, in, f, per_area);
    this->count(x, in);
  }

  /// Adds a force [N] at x [m] that belongs to no point.
  void add(const Vec3<S>& x, const Vec3<S>& f) noexcept { sum_.add(Vec3<S>(x - centre_), f); }

  /// Precondition: not empty().
  [[nodiscard]] RegionSum<S> total() const noexcept {
    RegionSum<S> sum = sum_;
    sum.force += Base::total(force_);
    sum.torque += Base::total(torque_);
    sum.moment += Base::total(moment_);
    sum.magnitude += Base::total(magnitude_);
    sum.spread += Base::total(spread_);
    return sum;
  }

 private:
  using V = typename Base::V;
  using Vector = typename Base::Vector;
  using Base::force_, Base::torque_, Base::moment_, Base::magnitude_, Base::spread_, Base::sum_;

  /// The points from i on, as many as V holds.
  PALPATE_INLINE void add_part(std::size_t i, const PointBatch<S>& x, const PenetrationBatch<S>& in,
                               const List& forces, const List& per_area) noexcept {
    const Vector p{V(&x.x[i]), V(&x.y[i]), V(&x.z[i])};
    const V f(&forces[i]);
    const Vector F = f * Vector{V(&in.gradient_x[i]), V(&in.gradient_y[i]), V(&in.gradient_z[i])};
    const Vector arm{p.x - centre_.x(), p.y - centre_.y(), p.z - centre_.z()};
    force_.add(i, F);
    torque_.add(i, cross(arm, F));
    moment_.add(i, f * p);
    Base::add(magnitude_, i, f);
    Base::add(spread_, i, f * (f * V(&per_area[i])));
  }

  Vec3<S> centre_;
};

}  // namespace palpate
