// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triangles around several query points, found by one walk of the tree.

#include <palpate/core/simd.hpp>
#include <palpate/geometry/bvh.hpp>

namespace palpate::detail {

/// Up to 256 triangles of a tree with their boxes.
template <Real S>
class NearTriangles {
 public:
  /// Those that may be within `radius` [m] of x. `complete()` is false where there are more.
  NearTriangles(const TriangleBvh<S>& tree, const Vec3<S>& x, S radius) noexcept {
    const auto nodes = tree.nodes();
    const auto cull = tree.cull(x);
    float limit = cull.limit(radius * radius), least = (std::numeric_limits<float>::max)();
    tree.walk(
        cull, limit,
        [&](std::uint32_t n, std::size_t child, float away) {
          const BvhNode& node = nodes[n];
          if (node.leaf == 0) return true;
          if (count_ < capacity) {
            if (away < least) least = away, nearest_ = count_;
            box_[count_] = {{node.low[0][child], node.low[1][child], node.low[2][child]},
                            {node.high[0][child], node.high[1][child], node.high[2][child]},
                            node.child[child]};
          } else {
            limit = -1.0f;  // ends the walk
          }
          ++count_;
          return false;
        },
        [](std::uint32_t) {});
  }

  [[nodiscard]] bool complete() const noexcept { return count_ <= capacity; }
  /// The one with the nearest box.
  [[nodiscard]] std::uint32_t nearest() const noexcept { return box_[nearest_].triangle; }

  /// Calls visit(triangle) for the others whose box is near one of many points: within its `limit` (squared,
  /// from Cull). Coordinates as in Cull. Precondition: complete().
  template <class Visit>
  void for_each_near(const std::array<std::array<float, batch_size>, 3>& x,
                     const std::array<float, batch_size>& limit, const Visit& visit) const noexcept {
    using V = simd_at_most<float, static_cast<int>(batch_size)>;
    for (std::size_t t = 0; t < count_; ++t) {
      if (t == nearest_) continue;
      const Box& box = box_[t];
      V least = (std::numeric_limits<float>::max)();
      for (std::size_t i = 0; i < batch_size; i += V::size()) {
        V d2 = -load<V>(&limit[i]);
        for (std::size_t k = 0; k < 3; ++k) {
          const V at = load<V>(&x[k][i]), away = (max)((max)(box.low[k] - at, at - box.high[k]), 0.0f);
          d2 += away * away;
        }
        least = (min)(d2, least);
      }
      if (reduce_min(least) <= 0.0f) visit(box.triangle);
    }
  }

 private:
  static constexpr std::size_t capacity = 256;
  struct Box {
    std::array<float, 3> low, high;
    std::uint32_t triangle;
  };

  std::array<Box, capacity> box_;  // only the first count_ are set
  std::size_t count_ = 0, nearest_ = 0;
};

}  // namespace palpate::detail
