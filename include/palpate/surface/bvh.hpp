// SPDX-License-Identifier: MIT
#pragma once

/// @file  Tree of boxes over a triangle mesh: closest point, ray and ball; follows vertices that move.

#include <palpate/core/error.hpp>
#include <palpate/surface/bvh_build.hpp>
#include <palpate/surface/concept.hpp>
#include <palpate/surface/triangle_query.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace palpate {

/// Tree over the triangles of a mesh; keeps a copy of the vertices. No equation.
///
/// Set-up is n log n (bvh_build.hpp). Nodes lie in one array, siblings together, children after their parent;
/// leaves hold at most 4 triangles; depth is at most 62. The constructor reports a list without triangles, a
/// bad index, or a vertex that is not finite or beyond 1e6 m.
///
/// Queries and moves take no heap; each ends after at most one visit to every node. Non-finite queries:
/// closest() gives the start triangle, raycast() and overlap() nothing. A vertex moved to a place that is not
/// finite stays.
template <Real S>
class TriangleBvh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  static constexpr std::uint32_t none = (std::numeric_limits<std::uint32_t>::max)();
  static constexpr std::uint32_t leaf_size = detail::bvh_leaf_size;

  using Node = detail::BvhNode<S>;

  /// A point of the mesh: sum of weight[k] times corner k of the triangle.
  struct Nearest {
    std::uint32_t triangle = none;
    Vec3<S> weight = Vec3<S>::Zero();
    Vec3<S> position = Vec3<S>::Zero();
    S distance2 = (std::numeric_limits<S>::max)();
  };
  struct Hit {
    std::uint32_t triangle = none;  ///< `none`: no hit
    Vec3<S> weight = Vec3<S>::Zero();
    S t = (std::numeric_limits<S>::max)();
  };

  explicit TriangleBvh(const MeshData<S>& mesh) : vertices_(mesh.vertices), triangles_(mesh.triangles) {
    const std::size_t n = triangles_.size();
    if (n == 0) fail("TriangleBvh", "needs at least one triangle");
    if (n > 1000000000u) fail("TriangleBvh", "takes at most 1e9 triangles", static_cast<double>(n));
    for (std::size_t t = 0; t < n; ++t)
      for (const std::uint32_t v : triangles_[t])
        if (v >= vertices_.size())
          fail_at("TriangleBvh", "vertex does not exist", "triangle", t, static_cast<double>(v));
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      if (!usable(vertices_[v])) fail_at("TriangleBvh", "place must be finite and below 1e6 m", "vertex", v);
    std::vector<Box> boxes(n);
    for (std::size_t t = 0; t < n; ++t)
      for (const std::uint32_t v : triangles_[t]) boxes[t].add(vertices_[v], vertices_[v]);
    detail::BvhBuild<S> made(boxes);
    nodes_ = std::move(made.nodes);
    order_ = std::move(made.order);
    link();
  }

  /// The point of the mesh closest to x; the first found of equal ones. A good `start` triangle saves much of
  /// the work.
  [[nodiscard]] Nearest closest(const Vec3<S>& x, std::uint32_t start = 0) const noexcept {
    return closest_and_near(
        x, start, [](S d2) { return d2; }, [](const Nearest&) {});
  }

  /// A point of the mesh at most 1 + `slack` times as far from x as the closest; much faster far from the
  /// mesh.
  [[nodiscard]] Nearest near(const Vec3<S>& x, std::uint32_t start, S slack) const noexcept {
    const S factor = S(1) / ((S(1) + slack) * (S(1) + slack));
    return closest_and_near(
        x, start, [factor](S d2) { return factor * d2; }, [](const Nearest&) {});
  }

  /// The closest point, and visit(nearest) once for every triangle whose squared distance is at most
  /// grow(d^2), d the distance; some that are farther are visited too. grow() must not decrease.
  template <class Grow, class Visit>
  Nearest closest_and_near(const Vec3<S>& x, std::uint32_t start, const Grow& grow,
                           const Visit& visit) const noexcept {
    Nearest best = on_triangle(x, start);
    if (!is_finite(best.distance2)) return best;
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    S bound = grow(best.distance2);
    stack[top++] = {0, nodes_[0].distance2(x)};
    while (top > 0) {
      const Entry entry = stack[--top];
      if (entry.distance2 > bound) continue;
      const Node* node = &nodes_[entry.node];
      while (node->count == 0) {
        const std::uint32_t left = node->first;
        const S l = nodes_[left].distance2(x), r = nodes_[left + 1].distance2(x);
        const bool left_first = l <= r;
        const S farther = left_first ? r : l;
        if (farther <= bound) stack[top++] = {left_first ? left + 1 : left, farther};
        if ((left_first ? l : r) > bound) break;
        node = &nodes_[left_first ? left : left + 1];
      }
      for (std::uint32_t i = node->first; i < node->first + node->count; ++i) {
        const Nearest here = on_triangle(x, order_[i]);
        if (here.distance2 > bound) continue;
        visit(here);
        if (!(here.distance2 < best.distance2)) continue;
        best = here;
        bound = grow(best.distance2);
      }
    }
    return best;
  }

  /// The point of one triangle closest to x.
  [[nodiscard]] Nearest on_triangle(const Vec3<S>& x, std::uint32_t triangle) const noexcept {
    const Triangle& t = triangles_[triangle];
    const Vec3<S>&a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
    const Vec3<S> weight = detail::closest_on_triangle<S>(x, a, b, c);
    const Vec3<S> position = weight[0] * a + weight[1] * b + weight[2] * c;
    return {triangle, weight, position, (x - position).squaredNorm()};
  }

  /// First triangle on the ray origin + t direction, t >= 0, either side; no ray passes between neighbours.
  /// Direction of any length; zero or not finite: no hit.
  [[nodiscard]] Hit raycast(const Vec3<S>& origin, const Vec3<S>& direction) const noexcept {
    Hit best;
    if (!is_finite(origin) || !is_finite(direction)) return best;
    const S scale = direction.cwiseAbs().maxCoeff();
    if (!(scale >= (std::numeric_limits<S>::min)()) || !(origin.cwiseAbs().maxCoeff() <= far)) return best;
    const Vec3<S> d = direction / scale;
    const detail::ShearedRay<S> ray(origin, d);
    Vec3<S> inverse;
    for (int i = 0; i < 3; ++i) inverse[i] = S(1) / (std::abs(d[i]) > S(1e-20L) ? d[i] : S(1e-20L));
    // More than the rounding of a place on the ray: a grazed box must not be missed.
    const S guard = S(8) * std::numeric_limits<S>::epsilon() *
                    (std::max)({origin.cwiseAbs().maxCoeff(), nodes_[0].low.cwiseAbs().maxCoeff(),
                                nodes_[0].high.cwiseAbs().maxCoeff()});
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    stack[top++] = {0, S(0)};
    while (top > 0) {
      const Entry entry = stack[--top];
      if (!(entry.distance2 < best.t)) continue;
      const Node& node = nodes_[entry.node];
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Triangle& t = triangles_[order_[i]];
        S along;
        Vec3<S> weight;
        if (ray.hit(t, vertices_[t[0]], vertices_[t[1]], vertices_[t[2]], along, weight) && along < best.t)
          best = {order_[i], weight, along};
      }
      if (node.count > 0) continue;
      const S l = enters(nodes_[node.first], origin, inverse, guard),
              r = enters(nodes_[node.first + 1], origin, inverse, guard);
      const bool left_first = l <= r;
      const Entry near{left_first ? node.first : node.first + 1, left_first ? l : r},
          other{left_first ? node.first + 1 : node.first, left_first ? r : l};
      if (other.distance2 < best.t) stack[top++] = other;
      if (near.distance2 < best.t) stack[top++] = near;
    }
    if (best.triangle != none) best.t /= scale;
    if (!is_finite(best.t)) best.triangle = none;
    return best;
  }

  /// Calls visit(nearest) for every triangle strictly nearer to x than `radius` [m], in the tree's order.
  template <class Visit>
  void overlap(const Vec3<S>& x, S radius, const Visit& visit) const noexcept {
    const S limit = radius * radius;
    if (!is_finite(x) || !is_finite(limit)) return;
    std::array<std::uint32_t, stack_size> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!(node.distance2(x) < limit)) continue;
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Nearest here = on_triangle(x, order_[i]);
        if (here.distance2 < limit) visit(here);
      }
      if (node.count > 0) continue;
      stack[top++] = node.first + 1;
      stack[top++] = node.first;
    }
  }

  /// Puts vertex which[i] at place[i] [m] and refits the boxes above its triangles. Cost: those boxes.
  void move(std::span<const std::uint32_t> which, std::span<const Vec3<S>> place) noexcept {
    if (++epoch_ == 0) {
      std::fill(stamp_.begin(), stamp_.end(), 0u);
      epoch_ = 1;
    }
    for (std::size_t i = 0; i < which.size(); ++i) {
      const std::uint32_t v = which[i];
      if (!usable(place[i])) continue;
      vertices_[v] = place[i];
      for (std::uint32_t k = leaf_start_[v]; k < leaf_start_[v + 1]; ++k) {
        for (std::uint32_t n = leaf_[k]; n != none && stamp_[n] != epoch_; n = parent_[n]) stamp_[n] = epoch_;
      }
    }
    refit_stamped(0);
  }

  /// Puts every vertex at its place [m]; linear.
  void move_all(std::span<const Vec3<S>> place) noexcept {
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      if (usable(place[v])) vertices_[v] = place[v];
    for (std::size_t n = nodes_.size(); n-- > 0;) refit(nodes_[n]);
  }

  [[nodiscard]] std::span<const Vec3<S>> vertices() const noexcept { return vertices_; }
  [[nodiscard]] std::span<const Triangle> triangles() const noexcept { return triangles_; }
  /// The root first.
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  /// The triangle at each place of the leaves.
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }

  static constexpr std::size_t stack_size =
      64;  ///< > depth: a walk keeps at most one node of each level, and one

 private:
  static constexpr S far = S(1e6L) * S(1e6L);

  struct Entry {
    std::uint32_t node;
    S distance2;  // to a box; for rays t
  };
  using Box = detail::BvhBox<S>;

  [[nodiscard]] static bool usable(const Vec3<S>& p) noexcept {
    return is_finite(p) && p.cwiseAbs().maxCoeff() <= S(1e6L);
  }

  /// Where the ray enters a box that is widened by `guard` [m]; beyond every t when it misses.
  [[nodiscard]] static S enters(const Node& node, const Vec3<S>& origin, const Vec3<S>& inverse,
                                S guard) noexcept {
    const Vec3<S> a = (node.low - origin - Vec3<S>::Constant(guard)).cwiseProduct(inverse);
    const Vec3<S> b = (node.high - origin + Vec3<S>::Constant(guard)).cwiseProduct(inverse);
    const S in = a.cwiseMin(b).maxCoeff(), out = a.cwiseMax(b).minCoeff();
    return out >= S(0) && in <= out ? (std::max)(in, S(0)) : (std::numeric_limits<S>::max)();
  }

  void refit(Node& node) noexcept {
    Box box;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      for (const std::uint32_t v : triangles_[order_[i]]) box.add(vertices_[v], vertices_[v]);
    if (node.count == 0)
      for (std::uint32_t k = 0; k < 2; ++k) box.add(nodes_[node.first + k].low, nodes_[node.first + k].high);
    node.low = box.low;
    node.high = box.high;
  }
  void refit_stamped(std::uint32_t n) noexcept {  // recursion to the tree's depth, at most 62
    if (stamp_[n] != epoch_) return;
    if (nodes_[n].count == 0) {
      refit_stamped(nodes_[n].first);
      refit_stamped(nodes_[n].first + 1);
    }
    refit(nodes_[n]);
  }

  // Parents, and the leaves of every vertex, for move().
  void link() {
    parent_.assign(nodes_.size(), none);
    stamp_.assign(nodes_.size(), 0);
    leaf_start_.assign(vertices_.size() + 1, 0);
    for (int pass = 0; pass < 2; ++pass) {  // count, then fill
      for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
        const Node& node = nodes_[n];
        if (node.count == 0) parent_[node.first] = parent_[node.first + 1] = n;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          for (const std::uint32_t v : triangles_[order_[i]]) {
            if (pass == 0)
              ++leaf_start_[v + 1];
            else
              leaf_[--leaf_start_[v + 1]] = n;
          }
        }
      }
      if (pass == 0) {
        std::partial_sum(leaf_start_.begin(), leaf_start_.end(), leaf_start_.begin());
        leaf_.resize(leaf_start_.back());
      }
    }
    // The second pass moved each end down to its beginning.
    std::rotate(leaf_start_.begin(), leaf_start_.begin() + 1, leaf_start_.end());
    leaf_start_.back() = static_cast<std::uint32_t>(leaf_.size());
  }

  std::vector<Vec3<S>> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_, parent_, leaf_start_, leaf_, stamp_;
  std::uint32_t epoch_ = 0;
};

}  // namespace palpate
