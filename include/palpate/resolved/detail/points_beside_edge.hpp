// SPDX-License-Identifier: MIT
#pragma once

/// @file What the tool's points beside a sharp edge of the body are beneath.

#include <palpate/core/scalar.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/tool_surface.hpp>
#include <palpate/resolved/detail/touching_point.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate::detail {

/// A point beneath the surface is as deep as it is far from the closest of it. Beside a sharp edge of the
/// body that may be a side which the tool, of outward normal o there, presses on less than on the face that
/// the point leaves the body by along -o,
///
///     y = closest(z),   z = x - 4 D o,   n_y = (y - z)/|y - z|,   delta = n_y.(x - y)
///
/// n: inward normal of the closest surface, n_y of that face; M: mean of all n by depth and area; D: the
/// deepest. A tool that comes in through a side has M along n: it is pressed out there. What is beneath y
/// comes to bear as s w, what is beneath the closest surface as 1 - s w:
///
///     w = r((o.n_y - o.n)/0.2) r((o.n + 0.8)/0.2) r((o.n_y - 0.5)/0.2) r((0.95 - n.n_y)/0.3)
///         r((o.M - 0.5)/0.4) r((0.95 - n.M)/0.3) r(b/(0.3 sqrt(A))) r(3 - delta/(D o.n_y))
///     s = min(1, 4 volume/volume of these),   r(a): a between 0 and 1;   volume: sum of depth by area
///
/// b: how far x is from the closest surface, A: its cell. w is 0 where n and o are opposite, as beyond the
/// middle of a thin wall, and where the surface turns by less than 18 degrees from n to n_y, or M. s: a tool
/// that comes in through a side has at first no points that are nearer to the top. Chosen so that a ball's
/// force is smooth round an edge and over it (tests/unit/resolved/half_space_test.cpp; with steeper ramps, or
/// z nearer by, it swings in a cycle of two ticks), with the cases at edges of docs/resolved.md in sight.
template <Real S>
class PointsBesideEdge {
 public:
  explicit PointsBesideEdge(std::size_t capacity) : points_(capacity) {}

  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  void clear() noexcept { points_.clear(); }
  /// Points of a leaf, the tool's from `begin` on, which do not press on the closest surface.
  void add(const TouchingLeaf& leaf, std::uint32_t begin, float shifted) noexcept {
    if (!leaf.has_aside) return;
    for (std::uint32_t k = 0; k < batch_size; ++k)
      if (leaf.aside[k] > 0) add(leaf.point(k, begin + k, 0, shifted), leaf.aside[k]);
  }

  /// After all points have touched: puts those that press on another face, which are in `touching` or were
  /// added, on that, in `touching` and in the groups of `system`. Positions are relative to `origin` [m].
  /// Those that were not in `touching` touch in tick `now`, too. Returns whether there was room for all.
  /// Precondition: `touching` has a point.
  bool press(const ContactSurface auto& object, const ToolPoints<S>& tool, const Vec3<S>& origin,
             std::uint32_t now, PointSystem& system, BoundedList<TouchingPoint>& touching,
             std::vector<PointMemory>& memory) noexcept {
    const Vec3<float> M = system.mean_normal();
    const std::size_t added = points_.size();
    for (const TouchingPoint& at : touching)
      if (may_press_aside(at, M)) add(at, at.depth / facing_share(at.outward.dot(at.m)));
    float volume = 0;
    for (Point& p : points_) {
      const float area = static_cast<float>(tool.area(p.at.point));
      if (may_press_aside(p.at, M)) look(object, origin, M, system.deepest(), area, p);
      volume += p.weight * p.delta * area;
    }
    if (!(volume > 0)) return true;
    const float share = (std::min)(1.f, 4 * system.volume() / volume);
    bool has_room = true;
    TouchingPoint* next = touching.begin();  // those of `touching` are in its order
    for (std::size_t i = added; i < points_.size(); ++i, ++next) {
      while (next->point != points_[i].at.point) ++next;
      (void)press_on(points_[i], share * points_[i].weight, *next);
    }
    for (std::size_t i = 0; i < added; ++i) {
      TouchingPoint at = points_[i].at;
      if (!(points_[i].weight > 0) || !press_on(points_[i], share * points_[i].weight, at)) continue;
      has_room = !touching.full();
      if (!has_room) break;
      touching.push_back(at), memory[at.point].touch(now);
    }
    group(tool, system, touching);
    return has_room;
  }

 private:
  struct Point {
    TouchingPoint at;
    float beneath;                        // [m]
    float weight = 0, delta = 0;          // w; [m]
    Vec3<float> n = Vec3<float>::Zero();  // n_y
  };
  static constexpr float facing = 0.5f, same = 0.95f;  // least o.M, o.n_y; n.n_y, n.M of the same face

  // A point that is `beneath` the closest surface [m].
  void add(const TouchingPoint& at, float beneath) noexcept {
    if (!points_.full()) points_.push_back({at, beneath});
  }
  [[nodiscard]] static float ramp(float a) noexcept { return clamp(a, 0.f, 1.f); }
  [[nodiscard]] static bool may_press_aside(const TouchingPoint& at, const Vec3<float>& M) noexcept {
    return at.outward.dot(M) > facing && at.m.dot(M) < same;
  }
  static void look(const ContactSurface auto& object, const Vec3<S>& origin, const Vec3<float>& M,
                   float deepest, float area, Point& p) noexcept {
    const Vec3<float>&o = p.at.outward, &n = p.at.m;
    const Vec3<S> x = origin + p.at.x.template cast<S>();
    const Vec3<S> outside = x - S(4) * static_cast<S>(deepest) * o.template cast<S>();
    const SurfacePoint<S> y = object.closest(outside);
    if (!(y.distance > 0)) return;
    const Vec3<S> n_y = (y.position - outside).normalized();
    p.n = n_y.template cast<float>();
    p.delta = static_cast<float>(n_y.dot(x - y.position));
    const float along = o.dot(n), along_y = o.dot(p.n);
    if (!(p.delta > 0) || !(along_y > facing)) return;
    p.weight = ramp((along_y - along) / 0.2f) * ramp((along + 0.8f) / 0.2f) *
               ramp((along_y - facing) / 0.2f) * ramp((same - n.dot(p.n)) / 0.3f) *
               ramp((o.dot(M) - facing) / 0.4f) * ramp((same - n.dot(M)) / 0.3f) *
               ramp(p.beneath / (0.3f * std::sqrt(area))) * ramp(3 - p.delta / (deepest * along_y));
  }
  // False, with `at` as it was, where squares of depths are no floats.
  [[nodiscard]] static bool press_on(const Point& p, float w, TouchingPoint& at) noexcept {
    const Vec3<float> sum = (1 - w) * at.depth * at.m + w * p.delta * p.n;
    if (!(sum.squaredNorm() >= (std::numeric_limits<float>::min)())) return false;
    at.m = sum.normalized();
    at.depth += w * (p.delta - at.depth);
    return true;
  }
  // Groups anew: points of a leaf that follow each other.
  static void group(const ToolPoints<S>& tool, PointSystem& system,
                    BoundedList<TouchingPoint>& touching) noexcept {
    system.begin_tick();
    for (TouchingPoint* begin = touching.begin(); begin != touching.end();) {
      const std::uint32_t leaf = begin->point / static_cast<std::uint32_t>(batch_size);
      float deepest = 0, volume = 0;
      Vec3<float> volume_x = Vec3<float>::Zero(), volume_m = volume_x;
      for (; begin != touching.end() && begin->point / batch_size == leaf; ++begin) {
        const float weight = begin->depth * static_cast<float>(tool.area(begin->point));
        begin->group = system.groups();
        deepest = (std::max)(deepest, begin->depth), volume += weight;
        volume_x += weight * begin->x, volume_m += weight * begin->m;
      }
      system.touch(deepest, volume, volume_x, volume_m);
    }
  }

  BoundedList<Point> points_;
};

}  // namespace palpate::detail
