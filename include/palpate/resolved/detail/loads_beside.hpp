// SPDX-License-Identifier: MIT
#pragma once

/// @file Loads that other tools put on the same body: how they move the surface beneath this one.

#include <palpate/contact/surface_load.hpp>
#include <palpate/core/aligned_list.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/core/status.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/half_space_kernel.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

/// Up to `capacity` loads, in the coordinates and units of a tick.
///
/// They may move the body farther than the tool is deep in it, as one finger pushes a block to the other. So
/// points are looked for at X - (v + e), where the surface beneath the tool has gone by v, and a point's
/// depth is less by m.(u_i - v):
///
///     v = mean of u_i - 2 s m        in contact: as where the surface is sunk least; s: deviation of m_i.u_i
///     v = mean of u_i - g m          at first touch; g: by what a point would be more than twice as deep as
///                                    any is found: a part to which the surface comes farther is found late
///     v = u where the tool is nearest to the surface                  without
///     e: keeps mean + e where one goes over into the other; |de| = -0.3 (|dX| + |dv|)
///
/// u_i: displacement of point i by others' loads. Means are by depth and area. v only chooses which points
/// are found: one beside the contact costs time, and hardly changes the direction of pressing. With e no
/// force jumps, and none changes at rest.
template <Real S>
class LoadsBeside {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  LoadsBeside(std::size_t capacity, std::size_t points, float compressibility)
      : b_(compressibility), triangle_(capacity, ~0u) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    for (auto* list : {&x_, &m_, &P_}) list->resize(padded);
    area_.resize(padded);
    given_.resize(AlignedList<float>::padded(points));
  }

  /// Loads of the caller's, which stay where they are until they are others'.
  void set(std::span<const SurfaceLoad<S>> loads) noexcept { loads_ = loads; }
  /// After a tick.
  void drop() noexcept { loads_ = {}; }
  /// Of the tick's loads: those that are left out.
  [[nodiscard]] Status status() const noexcept { return left_out_; }

  void forget() noexcept { v_ = mean_ = next_ = rest_ = Vec3<float>::Zero(), touched_ = false; }
  /// Goes on from the last tick of `other`, of the same body.
  void take_over(const LoadsBeside& other) noexcept {
    v_ = other.v_, mean_ = other.mean_, next_ = other.next_, rest_ = other.rest_, touched_ = other.touched_;
  }
  /// With the tool at X; it was at `before` in the last tick, and then touched the body or did not.
  template <ContactSurface Object, class Body, class RegularPart>
  void begin_tick(const Object& object, const Body& body, const ToolPoints<S>& tool, const Pose<S>& before,
                  const Pose<S>& X, bool touches, S per_load, RegularPart& regular) noexcept {
    const auto& all = tool.nodes()[0];
    const Vec3<S> centre = X * all.centre;
    const float travel = static_cast<float>((centre - before * all.centre).norm()) + (next_ - v_).norm(),
                left = rest_.norm();
    rest_ *= left > fading * travel ? 1 - fading * travel / left : 0.f;
    v_ = next_;
    if (loads_.empty()) forget();
    if (!touches) approach(object, body, tool, X, per_load, regular);
    touched_ = touches;
  }
  /// Where the tool at X is over the undeformed surface.
  [[nodiscard]] Pose<S> over(const Pose<S>& X) const noexcept {
    return {X.rotation, X.translation - (v_ + rest_).template cast<S>()};
  }

  /// Takes them into a tick's system: positions relative to `origin`, P = f / per_load.
  template <class Body, class RegularPart>
  void place(const Body& body, const Vec3<S>& origin, S per_load, RegularPart& regular) noexcept {
    size_ = 0, left_out_ = Status::ok;
    for (const SurfaceLoad<S>& load : loads_) {
      const bool usable = is_usable(load, static_cast<S>(body.E())), room = size_ < triangle_.size();
      if (!usable) left_out_ |= Status::invalid_load;
      if (usable && !room) left_out_ |= Status::point_overflow;
      if (!usable || !room) continue;
      x_.set(size_, (load.position - origin).template cast<float>());
      m_.set(size_, load.direction.template cast<float>());
      P_.set(size_, (load.force / per_load).template cast<float>());
      area_[size_] = static_cast<float>(load.area);
      if constexpr (RegularPart::active)
        regular.add_beside(body, (load.position + load.shift).template cast<double>(), triangle_[size_],
                           P_[size_]);
      ++size_;
    }
    for (std::size_t i = size_; i < padded<V>(size_); ++i) {  // what fills up the last register
      x_.set(i, PointSystem::apart());
      for (auto* list : {&m_, &P_}) list->set(i, Vec3<float>::Zero());
    }
  }
  /// They move the points, whose depths this makes less.
  template <class RegularPart>
  void move_points(PointSystem& system, RegularPart& regular) noexcept {
    if (loads_.empty()) return;
    if constexpr (RegularPart::active) regular.gather_beside();
    float total = 0, sum = 0, sum2 = 0;
    Vec3<float> sum_u = Vec3<float>::Zero(), sum_m = Vec3<float>::Zero();
    for (std::size_t i = 0; i < system.size(); ++i) {
      const Vec3<float> m = system.direction(i);
      Vec3<float> u = displacement_at(system.foot(i), m);
      if constexpr (RegularPart::active) u += regular.beside(i);
      given_.set(i, u);
      const float along = m.dot(u - v_), depth = touched_ ? system.depth[i] - along : system.depth[i],
                  weight = (std::max)(depth, 0.f) * system.area(i);
      total += weight, sum += weight * along, sum2 += weight * along * along;
      sum_u += weight * u, sum_m += weight * m;
    }
    if (total > 0) {
      const float variance = sum2 / total - sum / total * (sum / total);
      const Vec3<float> mean = sum_u / total;
      if (!touched_) {
        const Vec3<float> v = at_first_touch(system, mean);
        rest_ += v_ - v, v_ = v;
      }
      mean_ = mean;
      next_ = mean - reach * std::sqrt((std::max)(variance, 0.f)) * sum_m.stableNormalized();
    }
    for (std::size_t i = 0; i < system.size(); ++i)
      system.depth[i] -= system.direction(i).dot(given_[i] - v_);
  }
  /// Displacements of points i .. on of the tick by them [m].
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
    return loads_.empty() ? SimdVec3<V>{} : given_.load(i);
  }
  /// Of these, what the depths are less by: u_i - v.
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> beyond(std::size_t i) const noexcept {
    return loads_.empty() ? SimdVec3<V>{} : given_.load(i) - each<V>(v_);
  }

  /// The half-space's displacement at x by all of them; m: the direction of pressing there [m].
  [[nodiscard]] Vec3<float> displacement_at(const Vec3<float>& x, const Vec3<float>& m) const noexcept {
    SimdVec3<V> sum{};
    for (std::size_t i = 0; i < size_; i += V::size())
      sum = pushed(b_, point_pair(each<V>(x) - x_.load(i), each<V>(m), m_.load(i), V(&area_[i])), P_.load(i),
                   sum);
    return sum_of(sum);
  }
  [[nodiscard]] const Vec3<float>& v() const noexcept { return v_; }
  /// Of a displacement a across m, what the next tick's v does not contain.
  [[nodiscard]] Vec3<float> own(const Vec3<float>& a, const Vec3<float>& m) const noexcept {
    return a - next_ + m.dot(next_) * m;
  }

 private:
  // On the surface: down the tool's tree, of two balls always into the one whose middle is nearer.
  template <ContactSurface Object>
  [[nodiscard]] static SurfacePoint<S> nearest_position(const Object& object, const ToolPoints<S>& tool,
                                                        const Pose<S>& X) noexcept {
    const auto nodes = tool.nodes();
    SurfacePoint<S> at = object.closest(X * nodes[0].centre);
    for (std::size_t n = 0; nodes[n].skip > n + 1;) {
      const std::size_t left = n + 1, right = nodes[left].skip;
      const SurfacePoint<S> at_left = object.closest(X * nodes[left].centre),
                            at_right = object.closest(X * nodes[right].centre);
      const bool is_left = at_left.distance < at_right.distance;
      n = is_left ? left : right;
      at = is_left ? at_left : at_right;
    }
    return at;
  }
  // Without contact.
  template <ContactSurface Object, class Body, class RegularPart>
  void approach(const Object& object, const Body& body, const ToolPoints<S>& tool, const Pose<S>& X,
                S per_load, RegularPart& regular) noexcept {
    Vec3<float> u = Vec3<float>::Zero();
    const auto& all = tool.nodes()[0];
    if (!loads_.empty() && !object.separated(X * all.centre, 2 * all.radius)) {
      const SurfacePoint<S> nearest = nearest_position(object, tool, X);
      if constexpr (RegularPart::active) {
        regular.clear();
        regular.place_point(body, nearest.position.template cast<double>(), triangle_of_nearest_);
      }
      place(body, nearest.position, per_load, regular);
      u = displacement_at(Vec3<float>::Zero(), -nearest.normal.template cast<float>());
      if constexpr (RegularPart::active) {
        regular.build();
        regular.gather_beside();
        u += regular.beside(0);
      }
    }
    if (touched_) rest_ += mean_ - u;
    v_ = mean_ = next_ = u;
  }

  // v at first touch: see above.
  [[nodiscard]] Vec3<float> at_first_touch(const PointSystem& system,
                                           const Vec3<float>& mean) const noexcept {
    float found = 0, deepest = 0;
    Vec3<float> m = Vec3<float>::Zero();
    for (std::size_t i = 0; i < system.size(); ++i) {
      const Vec3<float> mi = system.direction(i);
      const float depth = system.depth[i] - mi.dot(given_[i] - mean);
      found = (std::max)(found, system.depth[i]);
      if (depth > deepest) deepest = depth, m = mi;
    }
    return mean - (std::max)(deepest - 2 * found, 0.f) * m;
  }

  static constexpr float fading = 0.3f;  // chosen: a force then changes by a third more along a path
  static constexpr float reach = 2;      // deviations: a ball's contact ends after 1.7 where u_i is linear

  float b_;  // 1 - 2 nu
  std::span<const SurfaceLoad<S>> loads_;
  VectorList x_, m_, P_;
  AlignedList<float> area_;
  std::vector<std::uint32_t> triangle_;  // of the load mesh, where a load was last
  VectorList given_;
  std::size_t size_ = 0;
  Status left_out_ = Status::ok;
  Vec3<float> v_ = Vec3<float>::Zero(), mean_ = v_, next_ = v_, rest_ = v_;  // rest_: e
  std::uint32_t triangle_of_nearest_ = ~0u;
  bool touched_ = false;  // in the last tick
};

/// A tool that is alone on its body.
struct NoLoadsBeside {
  static constexpr bool active = false;
  NoLoadsBeside(std::size_t, std::size_t, float) {}
  static void drop() noexcept {}
  static void forget() noexcept {}
  static void take_over(const NoLoadsBeside&) noexcept {}
  static void begin_tick(const auto&...) noexcept {}
  [[nodiscard]] static Status status() noexcept { return Status::ok; }
  [[nodiscard]] static const auto& over(const auto& X) noexcept { return X; }
  [[nodiscard]] static const auto& own(const auto& a, const auto& /*m*/) noexcept { return a; }
  [[nodiscard]] PALPATE_INLINE static SimdVec3<VectorList::V> load(std::size_t) noexcept { return {}; }
  [[nodiscard]] PALPATE_INLINE static SimdVec3<VectorList::V> beyond(std::size_t) noexcept { return {}; }
};

}  // namespace palpate::detail
