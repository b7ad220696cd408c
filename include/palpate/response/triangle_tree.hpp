// SPDX-License-Identifier: MIT
#pragma once

/// @file  Closest point of a triangle mesh: a bounding-box tree. Built at set-up; a query uses no heap.

#include <palpate/core/error.hpp>
#include <palpate/surface/concept.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate {

/// A place on a triangle mesh: position = sum of weight[i] times corner i of `triangle`.
template <Real S>
struct MeshPoint {
  std::uint32_t triangle = 0;
  Vec3<S> weight = Vec3<S>::Zero();    ///< barycentric, >= 0, sum 1 [-]
  Vec3<S> position = Vec3<S>::Zero();  ///< on the flat triangle [m]
};

/// Barycentric weights of the point of triangle (a, b, c) closest to p. Source: [ericson2004].
template <Real S>
[[nodiscard]] inline Vec3<S> closest_weights(const Vec3<S>& p, const Vec3<S>& a, const Vec3<S>& b,
                                             const Vec3<S>& c) noexcept {
  const Vec3<S> ab = b - a, ac = c - a, ap = p - a;
  const S d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= S(0) && d2 <= S(0)) return {S(1), S(0), S(0)};
  const Vec3<S> bp = p - b;
  const S d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= S(0) && d4 <= d3) return {S(0), S(1), S(0)};
  const S vc = d1 * d4 - d3 * d2;
  if (vc <= S(0) && d1 >= S(0) && d3 <= S(0)) {
    const S v = d1 / (d1 - d3);
    return {S(1) - v, v, S(0)};
  }
  const Vec3<S> cp = p - c;
  const S d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= S(0) && d5 <= d6) return {S(0), S(0), S(1)};
  const S vb = d5 * d2 - d1 * d6;
  if (vb <= S(0) && d2 >= S(0) && d6 <= S(0)) {
    const S w = d2 / (d2 - d6);
    return {S(1) - w, S(0), w};
  }
  const S va = d3 * d6 - d5 * d4;
  if (va <= S(0) && d4 - d3 >= S(0) && d5 - d6 >= S(0)) {
    const S w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {S(0), S(1) - w, w};
  }
  const S sum = va + vb + vc;
  if (!(sum > S(0))) return {S(1), S(0), S(0)};
  return {S(1) - (vb + vc) / sum, vb / sum, vc / sum};
}

/// Bounding-box tree over a mesh's triangles; keeps a copy of their corners.
template <Real S>
class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(const MeshData<S>& mesh) {
    const std::size_t n = mesh.triangles.size();
    if (n == 0) fail("TriangleTree", "mesh must have triangles");
    items_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto& t = mesh.triangles[i];
      items_[i] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]], static_cast<std::uint32_t>(i)};
    }
    nodes_.reserve(n);
    build(0, static_cast<std::uint32_t>(n));
  }

  /// The point of the mesh closest to x; for non-finite x, some point of the mesh.
  [[nodiscard]] MeshPoint<S> closest(const Vec3<S>& x) const noexcept {
    std::array<std::uint32_t, 64> stack;  // depth is at most log2 of the triangle count
    std::size_t top = 0;
    stack[top++] = 0;
    S best = (std::numeric_limits<S>::max)();
    const Item* found = &items_[0];
    Vec3<S> weight(S(1), S(0), S(0)), position = found->a;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!(node.distance2(x) < best)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          const Item& item = items_[i];
          const Vec3<S> w = closest_weights(x, item.a, item.b, item.c);
          const Vec3<S> p = w[0] * item.a + w[1] * item.b + w[2] * item.c;
          const S d2 = (p - x).squaredNorm();
          if (d2 < best) {
            best = d2;
            found = &item;
            weight = w;
            position = p;
          }
        }
        continue;
      }
      const std::uint32_t left = node.first, right = node.second;
      const bool left_nearer = nodes_[left].distance2(x) < nodes_[right].distance2(x);
      if (top + 2 > stack.size()) break;
      stack[top++] = left_nearer ? right : left;
      stack[top++] = left_nearer ? left : right;
    }
    return {found->index, weight, position};
  }

 private:
  struct Item {
    Vec3<S> a, b, c;
    std::uint32_t index;
  };
  struct Node {
    Vec3<S> low, high;
    std::uint32_t first = 0, second = 0, count = 0;  // leaf: count > 0
    [[nodiscard]] S distance2(const Vec3<S>& x) const noexcept {
      return (low - x).cwiseMax(x - high).cwiseMax(S(0)).squaredNorm();
    }
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    node.low = node.high = items_[begin].a;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (const Vec3<S>* p : {&items_[i].a, &items_[i].b, &items_[i].c}) {
        node.low = node.low.cwiseMin(*p);
        node.high = node.high.cwiseMax(*p);
      }
    }
    if (end - begin <= 4) {
      node.first = begin;
      node.count = end - begin;
    } else {
      int axis = 0;
      (node.high - node.low).maxCoeff(&axis);
      const std::uint32_t middle = begin + (end - begin) / 2;
      std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end,
                       [axis](const Item& l, const Item& r) {
                         const S x = l.a[axis] + l.b[axis] + l.c[axis], y = r.a[axis] + r.b[axis] + r.c[axis];
                         return x < y || (x == y && l.index < r.index);
                       });
      node.first = build(begin, middle);
      node.second = build(middle, end);
    }
    nodes_[index] = node;
    return index;
  }

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace palpate
