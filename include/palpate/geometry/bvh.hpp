// SPDX-License-Identifier: MIT
#pragma once

/// @file  Tree of boxes over a triangle mesh: closest point, ray and ball; follows vertices that move.

#include <palpate/geometry/concept.hpp>
#include <palpate/geometry/detail/bvh_build.hpp>
#include <palpate/geometry/detail/triangle_query.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace palpate {

/// Tree over the triangles of a mesh; keeps a copy of the vertices. No equation.
///
/// Set-up is n log n (bvh_build.hpp). Nodes lie in one array, siblings together, children after their parent;
/// a node has up to eight children, boxes or triangles, whose boxes are tested at once. Boxes are in float
/// and only decide what is looked at: every answer is computed from the triangles in S. The constructor
/// reports a list without triangles, a bad index, or a vertex that is not finite or beyond 1e6 m.
///
/// Queries and moves take no heap; each ends after at most one visit to every node. Non-finite queries:
/// closest() gives the start triangle, raycast() and overlap() nothing. A vertex moved to a position that is
/// not finite stays.
template <Real S>
class TriangleBvh {
 public:
  using Triangle = std::array<std::uint32_t, 3>;
  using Node = detail::BvhNode;
  static constexpr std::uint32_t none = (std::numeric_limits<std::uint32_t>::max)();

  /// A point of the mesh: sum of weight[k] times corner k of the triangle.
  struct Nearest {
    std::uint32_t triangle;
    Vec3<S> weight, position;
    S distance2;
  };
  struct Hit {
    std::uint32_t triangle = none;  ///< `none`: no hit
    Vec3<S> weight = Vec3<S>::Zero();
    S t = (std::numeric_limits<S>::max)();
  };

  explicit TriangleBvh(const MeshData<S>& mesh);

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
    const Cull cull = this->cull(x);
    S bound = grow(best.distance2);
    float limit = cull.limit(bound);
    walk(
        cull, limit, [](std::uint32_t, std::size_t, float) { return true; },
        [&](std::uint32_t triangle) {
          const Nearest here = on_triangle(x, triangle);
          if (here.distance2 > bound) return;
          visit(here);
          if (!(here.distance2 < best.distance2)) return;
          best = here;
          bound = grow(best.distance2);
          limit = cull.limit(bound);
        });
    return best;
  }

  /// A query point as the boxes see it.
  struct Cull {
    std::array<float, 3> x;
    S slack;  // [m], more than the rounding of a distance to a box; < 0: too far for float, visit all
    static constexpr S widened = S(1.000002L);  // more than the roundings of a square in float
    /// What a squared distance to a box must not exceed for the box to contain something at d2 or nearer.
    [[nodiscard]] float limit(S d2) const noexcept {
      if (slack < S(0)) return (std::numeric_limits<float>::max)();
      const S d = std::sqrt(d2) + slack;  // 1e38: the largest power of ten in float
      return static_cast<float>((std::min)(d * d * widened, S(1e38L)));
    }
  };
  /// With a slack that is enough for points within `spread` [m] of x.
  [[nodiscard]] Cull cull(const Vec3<S>& x, S spread = S(0)) const noexcept {
    const Vec3<S> e = x - origin_;
    const S size = e.cwiseAbs().maxCoeff() + spread;
    if (!(size < S(1e15L)))  // chosen: squares of less are finite in float
      return {{0, 0, 0}, S(-1)};
    return {{static_cast<float>(e.x()), static_cast<float>(e.y()), static_cast<float>(e.z())},
            S(4) * S(std::numeric_limits<float>::epsilon()) * (size + reach_)};
  }

  /// Calls visit(triangle) for every triangle whose box is within `limit` (squared, from Cull), unless
  /// enter(node, child, squared distance) is false for a box around it. Of siblings the nearest comes first;
  /// `limit` may fall meanwhile.
  template <class Enter, class Visit>
  void walk(const Cull& cull, const float& limit, const Enter& enter, const Visit& visit) const noexcept {
    std::array<Entry, stack_size> stack;
    std::size_t top = 0;
    Entry here{0, 0.0f};
    for (;;) {
      const Node& node = nodes_[here.node];
      std::array<float, Node::width> d2;
      node.distances(cull.x, d2);
      Entry next{none, 0.0f};
      for (std::uint32_t i = 0; i < node.count; ++i) {
        if (!(d2[i] <= limit) || !enter(here.node, i, d2[i])) continue;
        if (node.leaf != 0) {
          visit(node.child[i]);
        } else if (next.node == none) {
          next = {node.child[i], d2[i]};
        } else if (d2[i] < next.distance2) {
          stack[top++] = next;
          next = {node.child[i], d2[i]};
        } else {
          stack[top++] = {node.child[i], d2[i]};
        }
      }
      while (next.node == none) {
        if (top == 0) return;
        --top;
        if (stack[top].distance2 <= limit) next = stack[top];
      }
      here = next;
    }
  }

  /// The point of one triangle closest to x.
  [[nodiscard]] Nearest on_triangle(const Vec3<S>& x, std::uint32_t triangle) const noexcept {
    const Triangle& t = triangles_[triangle];
    const Vec3<S>&a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
    Nearest here;
    here.triangle = triangle;
    here.weight = detail::closest_on_triangle<S>(x, a, b, c);
    // Coordinate by coordinate: Eigen's expressions are not inlined here by gcc 12 at -O2.
    const S u = here.weight[0], v = here.weight[1], w = here.weight[2];
    here.position = Vec3<S>(u * a[0] + v * b[0] + w * c[0], u * a[1] + v * b[1] + w * c[1],
                            u * a[2] + v * b[2] + w * c[2]);
    const S ex = x[0] - here.position[0], ey = x[1] - here.position[1], ez = x[2] - here.position[2];
    here.distance2 = ex * ex + ey * ey + ez * ez;
    return here;
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
    Vec3<S> inverse;  // of a component that is 0 a large number instead, finite in float (chosen)
    for (int i = 0; i < 3; ++i) inverse[i] = S(1) / (std::abs(d[i]) > S(1e-20L) ? d[i] : S(1e-20L));
    // More than the rounding of a position on the ray: a grazed box must not be missed.
    const Vec3<S> from = origin - origin_;
    const S guard = S(4) * S(std::numeric_limits<float>::epsilon()) * reach_ +
                    S(8) * std::numeric_limits<S>::epsilon() *
                        (origin.cwiseAbs().maxCoeff() + origin_.cwiseAbs().maxCoeff());
    std::array<std::uint32_t, stack_size> stack;
    std::array<S, stack_size> enters;
    std::size_t top = 0;
    stack[0] = 0;
    enters[top++] = S(0);
    while (top > 0) {
      --top;
      if (!(enters[top] < best.t)) continue;
      const Node& node = nodes_[stack[top]];
      const std::size_t bottom = top;
      for (std::size_t i = 0; i < node.count; ++i) {
        const S in = enter(node, i, from, inverse, guard);
        if (!(in < best.t)) continue;
        if (node.leaf != 0) {
          const Triangle& t = triangles_[node.child[i]];
          S along;
          Vec3<S> weight;
          if (ray.hit(t, vertices_[t[0]], vertices_[t[1]], vertices_[t[2]], along, weight) && along < best.t)
            best = {node.child[i], weight, along};
          continue;
        }
        // Nearest on top.
        std::size_t position = top++;
        for (; position > bottom && enters[position - 1] < in; --position) {
          enters[position] = enters[position - 1];
          stack[position] = stack[position - 1];
        }
        enters[position] = in;
        stack[position] = node.child[i];
      }
    }
    if (best.triangle != none) best.t /= scale;
    if (!is_finite(best.t)) best.triangle = none;
    return best;
  }

  /// Calls visit(nearest) for every triangle strictly nearer to x than `radius` [m].
  template <class Visit>
  void overlap(const Vec3<S>& x, S radius, const Visit& visit) const noexcept {
    const S limit = radius * radius;
    if (!is_finite(x) || !is_finite(limit)) return;
    const Cull cull = this->cull(x);
    walk(
        cull, cull.limit(limit), [](std::uint32_t, std::size_t, float) { return true; },
        [&](std::uint32_t triangle) {
          const Nearest here = on_triangle(x, triangle);
          if (here.distance2 < limit) visit(here);
        });
  }

  /// Puts vertex which[i] at position[i] [m] and refits the boxes above its triangles. Cost: those boxes.
  void move(std::span<const std::uint32_t> which, std::span<const Vec3<S>> position) noexcept {
    if (++epoch_ == 0) {
      std::fill(stamp_.begin(), stamp_.end(), 0u);
      epoch_ = 1;
    }
    for (std::size_t i = 0; i < which.size(); ++i) {
      const std::uint32_t v = which[i];
      if (!usable(position[i])) continue;
      vertices_[v] = position[i];
      for (std::uint32_t k = leaf_start_[v]; k < leaf_start_[v + 1]; ++k) {
        for (std::uint32_t n = leaf_[k]; n != none && stamp_[n] != epoch_; n = parent_[n]) stamp_[n] = epoch_;
      }
    }
    if (stamp_[0] == epoch_) refit_stamped(0);
    measure();
  }

  /// Puts every vertex at its position [m]; linear.
  void move_all(std::span<const Vec3<S>> position) noexcept {
    for (std::size_t v = 0; v < vertices_.size(); ++v)
      if (usable(position[v])) vertices_[v] = position[v];
    refit_all();
  }

  [[nodiscard]] std::span<const Vec3<S>> vertices() const noexcept { return vertices_; }
  [[nodiscard]] std::span<const Triangle> triangles() const noexcept { return triangles_; }
  /// The root first; boxes are relative to origin().
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  [[nodiscard]] const Vec3<S>& origin() const noexcept { return origin_; }

 private:
  // Of a ray's origin: a million times the largest coordinate (chosen).
  static constexpr S far = S(1e6L) * S(1e6L);
  // A walk keeps at most seven nodes of each of 62 levels, and eight.
  static constexpr std::size_t stack_size = 448;

  struct Entry {
    std::uint32_t node;
    float distance2;
  };
  using Box = detail::BvhBox<S>;

  [[nodiscard]] static bool usable(const Vec3<S>& p) noexcept {
    return is_finite(p) && p.cwiseAbs().maxCoeff() <= S(1e6L);
  }

  /// Where the ray enters child i's box, widened by `guard` [m]; beyond every t when it misses.
  [[nodiscard]] static S enter(const Node& node, std::size_t i, const Vec3<S>& from, const Vec3<S>& inverse,
                               S guard) noexcept {
    S in = S(0), out = (std::numeric_limits<S>::max)();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      const S a = (static_cast<S>(node.low[k][i]) - from[axis] - guard) * inverse[axis],
              b = (static_cast<S>(node.high[k][i]) - from[axis] + guard) * inverse[axis];
      in = (std::max)(in, (std::min)(a, b));
      out = (std::min)(out, (std::max)(a, b));
    }
    return in <= out ? in : (std::numeric_limits<S>::max)();
  }

  void refit(Node& node) noexcept {
    for (std::size_t i = 0; i < node.count; ++i) {
      if (node.leaf != 0) {
        const Triangle& t = triangles_[node.child[i]];
        const Vec3<S>&a = vertices_[t[0]], &b = vertices_[t[1]], &c = vertices_[t[2]];
        const Vec3<S> low = a.cwiseMin(b).cwiseMin(c) - origin_, high = a.cwiseMax(b).cwiseMax(c) - origin_;
        for (std::size_t k = 0; k < 3; ++k) {
          node.low[k][i] = static_cast<float>(low[static_cast<int>(k)]);
          node.high[k][i] = static_cast<float>(high[static_cast<int>(k)]);
        }
      } else {
        const Node& child = nodes_[node.child[i]];
        for (std::size_t k = 0; k < 3; ++k) {
          node.low[k][i] = *std::min_element(child.low[k].begin(), child.low[k].begin() + child.count);
          node.high[k][i] = *std::max_element(child.high[k].begin(), child.high[k].begin() + child.count);
        }
      }
    }
  }
  void refit_all() noexcept {
    for (std::size_t n = nodes_.size(); n-- > 0;) refit(nodes_[n]);
    measure();
  }
  void refit_stamped(std::uint32_t n) noexcept {  // recursion to the tree's depth, at most 62
    Node& node = nodes_[n];
    for (std::size_t i = 0; i < node.count && node.leaf == 0; ++i)
      if (stamp_[node.child[i]] == epoch_) refit_stamped(node.child[i]);
    refit(node);
  }
  // Greatest coordinate relative to the origin.
  void measure() noexcept {
    reach_ = S(0);
    for (std::size_t i = 0; i < nodes_[0].count; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        reach_ =
            (std::max)({reach_, static_cast<S>(-nodes_[0].low[k][i]), static_cast<S>(nodes_[0].high[k][i])});
    }
  }

  // Parents, and the leaves of every vertex, for move().
  void link() {
    parent_.assign(nodes_.size(), none);
    stamp_.assign(nodes_.size(), 0);
    leaf_start_.assign(vertices_.size() + 1, 0);
    for (int pass = 0; pass < 2; ++pass) {  // count, then fill
      for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
        const Node& node = nodes_[n];
        for (std::size_t i = 0; i < node.count; ++i) {
          if (node.leaf == 0) {
            parent_[node.child[i]] = n;
            continue;
          }
          for (const std::uint32_t v : triangles_[node.child[i]]) {
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
  std::vector<std::uint32_t> parent_, leaf_start_, leaf_, stamp_;
  Vec3<S> origin_;  // middle of the box at set-up
  S reach_{};
  std::uint32_t epoch_ = 0;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/geometry/setup/bvh_impl.hpp>
#endif
