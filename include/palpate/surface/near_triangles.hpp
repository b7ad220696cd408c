// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triangles around several query points, found by one walk of the tree.

#include <palpate/surface/bvh.hpp>

namespace palpate::detail {

/// Up to 64 triangles of a tree with their boxes.
template <Real S>
class NearTriangles {
 public:
  using Nearest = typename TriangleBvh<S>::Nearest;

  /// Those that may be within `radius` [m] of x. `complete()` is false where there are more.
  NearTriangles(const TriangleBvh<S>& tree, const Vec3<S>& x, S radius) noexcept : tree_(tree) {
    const auto nodes = tree.nodes();
    const auto cull = tree.cull(x);
    float limit = cull.limit(radius * radius);
    tree.walk(
        cull, limit,
        [&](std::uint32_t n, std::size_t child, float) {
          if (nodes[n].leaf == 0) return true;
          if (count_ < capacity)
            copy(nodes[n], child, count_);
          else
            limit = -1.0f;  // ends the walk
          ++count_;
          return false;
        },
        [](std::uint32_t) {});
  }

  [[nodiscard]] bool complete() const noexcept { return count_ <= capacity; }

  /// As TriangleBvh::closest_and_near, of these triangles. Precondition: complete().
  template <class Grow, class Visit>
  Nearest closest_and_near(const Vec3<S>& x, std::uint32_t start, const Grow& grow,
                           const Visit& visit) const noexcept {
    return tree_.closest_among(
        x, start, grow, visit,
        [this](const typename TriangleBvh<S>::Cull& cull, const float& limit, const auto& meet) {
          for (std::size_t first = 0; first < count_; first += width) {
            const BvhNode& node = nodes_[first / width];
            std::array<float, width> d2;
            node.distances(cull.x, d2);
            for (std::size_t i = 0; i < width && first + i < count_; ++i)
              if (d2[i] <= limit) meet(node.child[i]);
          }
        });
  }

 private:
  static constexpr std::size_t width = BvhNode::width, capacity = 8 * width;

  void copy(const BvhNode& from, std::size_t child, std::size_t to) noexcept {
    BvhNode& node = nodes_[to / width];
    const std::size_t i = to % width;
    for (std::size_t k = 0; k < 3; ++k) {
      node.low[k][i] = from.low[k][child];
      node.high[k][i] = from.high[k][child];
    }
    node.child[i] = from.child[child];
  }

  const TriangleBvh<S>& tree_;
  std::array<BvhNode, capacity / width> nodes_;  // only the first count_ boxes are set
  std::size_t count_ = 0;
};

}  // namespace palpate::detail
