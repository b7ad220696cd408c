// SPDX-License-Identifier: MIT
#pragma once

/// @file The tool's points that are beneath the surface in a tick, and what all keep of the last one.

#include <palpate/core/pose.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/bounded_list.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/points_beside_edge.hpp>
#include <palpate/resolved/detail/tool_surface.hpp>
#include <palpate/resolved/detail/touching_point.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate::detail {

/// At most `capacity` points, in the order of the tool's; positions are relative to origin(), which is that
/// of the last tick that found one.
template <Real S>
class TouchingPoints {
 public:
  TouchingPoints(std::size_t tool_points, std::size_t capacity)
      : memory_(tool_points), points_(capacity), beside_edge_(capacity) {}

  [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
  [[nodiscard]] bool empty() const noexcept { return points_.empty(); }
  [[nodiscard]] const TouchingPoint* begin() const noexcept { return points_.begin(); }
  [[nodiscard]] const TouchingPoint* end() const noexcept { return points_.end(); }
  [[nodiscard]] const TouchingPoint& operator[](std::size_t c) const noexcept { return points_[c]; }
  /// What the c-th keeps.
  [[nodiscard]] PointMemory& memory(std::size_t c) noexcept { return memory_[points_[c].point]; }
  [[nodiscard]] const PointMemory& memory(std::size_t c) const noexcept { return memory_[points_[c].point]; }
  /// Object coordinates [m].
  [[nodiscard]] const Vec3<S>& origin() const noexcept { return origin_; }
  [[nodiscard]] std::uint32_t tick() const noexcept { return tick_; }
  /// False where points were left out.
  [[nodiscard]] bool has_room() const noexcept { return has_room_; }
  /// [m]; never 0, though squares of depths may be no floats.
  [[nodiscard]] float norm_of_depths() const noexcept {
    float sum = (std::numeric_limits<float>::min)();
    for (const TouchingPoint& c : points_) sum += c.depth * c.depth;
    return std::sqrt(sum);
  }

  /// (sum of depths)^2 over the sum of their squares: 3/4 of all under a ball, all under what is flat.
  [[nodiscard]] float effective_number() const noexcept {
    float sum = 0;
    for (const TouchingPoint& c : points_) sum += c.depth;
    const float per_norm = sum / norm_of_depths();
    return per_norm * per_norm;
  }
  /// Of points that have been found: what they keep of the last tick, at the same tool's points elsewhere,
  /// `nearest[i]` for its point i.
  void take_over(const TouchingPoints& other, const ToolPoints<S>& its, const ToolPoints<S>& tool,
                 const std::vector<std::vector<std::uint32_t>>& nearest) noexcept {
    for (std::size_t c = 0; c < other.size(); ++c) {
      const std::uint32_t from = other[c].point;
      for (const std::uint32_t to : nearest[from]) {
        PointMemory& p = memory_[to] = other.memory(c);
        p.tick = tick_;
        p.load *= static_cast<float>(tool.area(to) / its.area(from));
        p.load_step.setZero(), p.u_step.setZero();
      }
    }
  }
  /// No point has touched in the last tick.
  void forget() noexcept { tick_ += 2; }
  void begin_tick() noexcept { ++tick_, points_.clear(), beside_edge_.clear(), has_room_ = true; }
  /// Ready to look for points again in the same tick; false where there are some already.
  [[nodiscard]] bool begin_again() noexcept {
    if (!empty()) return false;
    beside_edge_.clear();
    return true;
  }
  /// A leaf, tool points from `begin` on, over x, as deep as `in` says; `rotation`: of the tool; `shifted`:
  /// TouchingPoint's. Returns how deep [m].
  S add(const ToolSurface<S>& surface, std::uint32_t begin, const Mat3<float>& rotation,
        const PointBatch<S>& x, const PenetrationBatch<S>& in, float shifted, PointSystem& system) noexcept {
    if (empty() && beside_edge_.empty()) origin_ = Vec3<S>(x.x[0], x.y[0], x.z[0]);
    const TouchingLeaf leaf = surface.find(begin, rotation, x, in, origin_);
    beside_edge_.add(leaf, begin, shifted);
    if (!(leaf.volume > 0)) return S(0);
    if (!points_.full()) system.touch(leaf.deepest, leaf.volume, leaf.volume_x, leaf.volume_m);
    S deepest = S(0);
    for (std::uint32_t k = 0; k < batch_size; ++k) {
      if (!(leaf.depth[k] > 0)) continue;
      deepest = (std::max)(deepest, in.depth[k]);
      has_room_ = !points_.full();
      if (!has_room_) continue;
      points_.push_back(leaf.point(k, begin + k, system.groups() - 1, shifted));
      memory_[begin + k].touch(tick_);
    }
    return deepest;
  }
  /// Where loaded points hold the surface goes with the tool from one pose to the other, and besides by a
  /// share of what `cones` say of its turn.
  void carry(const ToolPoints<S>& tool, const Pose<S>& from, const Pose<S>& to, float share,
             const auto& cones) noexcept {
    const Mat3<float> turn = (to.rotation * from.rotation.transpose()).template cast<float>();
    const Vec3<float> besides = share * cones.moved(turn);
    const Mat3<S> turned = to.rotation - from.rotation;
    const Vec3<S> moved = to.translation - from.translation + besides.template cast<S>();
    for (const TouchingPoint& c : points_)
      if (PointMemory& p = memory_[c.point]; p.loaded)
        p.anchor += Vec3<S>(turned * tool.point(c.point) + moved).template cast<float>();
  }
  /// After the last add(), where one has returned more than 0.
  void press_beside_edges(const ContactSurface auto& object, const ToolPoints<S>& tool,
                          PointSystem& system) noexcept {
    has_room_ &= beside_edge_.press(object, tool, origin_, tick_, system, points_, memory_);
  }

 private:
  std::vector<PointMemory> memory_;  // of all the tool's points
  BoundedList<TouchingPoint> points_;
  PointsBesideEdge<S> beside_edge_;
  Vec3<S> origin_ = Vec3<S>::Zero();
  std::uint32_t tick_ = 1;
  bool has_room_ = true;
};

}  // namespace palpate::detail
