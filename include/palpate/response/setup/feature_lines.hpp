// SPDX-License-Identifier: MIT
#pragma once

/// @file Lines of edges that stay when a mesh is made anew: creases and the fixed region's rim. Set-up only.

#include <palpate/response/setup/smooth_surface.hpp>

#include <cmath>
#include <limits>

namespace palpate {

namespace detail {

/// Feature lines of a mesh whose vertices p and triangles t the caller keeps.
class FeatureLines {
 public:
  /// Of a surface, at edges of length h of the mesh to be made.
  FeatureLines(const SmoothSurface& surface, const std::vector<std::uint8_t>& fixed_triangle, double h) {
    const auto& edges = surface.edges();
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const bool rim = fixed_triangle[edges[e].triangle[0]] != fixed_triangle[edges[e].triangle[1]];
      if (rim || surface.is_crease(e)) keys_.push_back(edges[e].key);
    }
    const auto& p = surface.mesh().vertices;
    drop_faint(p, surface.mesh().triangles, fixed_triangle, h);
    for (std::uint64_t key : keys_) segments_.push_back({p[first(key)], p[second(key)]});
  }

  [[nodiscard]] bool contains(std::uint64_t edge) const noexcept {
    return std::binary_search(keys_.begin(), keys_.end(), edge);
  }

  /// Drops creases that are none at the size of the edges: those that turn by little on the present mesh, and
  /// chains that are short beside h.
  void drop_faint(const std::vector<Vec3d>& p, const std::vector<Triangle>& t,
                  const std::vector<std::uint8_t>& fixed_triangle, double h) {
    std::vector<MeshEdge> creases;
    std::vector<std::uint64_t> kept;
    DisjointSets chains(p.size());
    for (const MeshEdge& e : mesh_edges(t, "Remesher")) {
      if (!contains(e.key)) continue;
      if (fixed_triangle[e.triangle[0]] != fixed_triangle[e.triangle[1]]) {
        kept.push_back(e.key);
      } else if (turns(e, p, t)) {
        creases.push_back(e);
        chains.join(e.a(), e.b());
      }
    }
    std::vector<double> length(p.size(), 0);
    for (const MeshEdge& e : creases) length[chains.root(e.a())] += (p[e.a()] - p[e.b()]).norm();
    for (const MeshEdge& e : creases)
      if (length[chains.root(e.a())] >= setup::min_crease_length * h) kept.push_back(e.key);
    std::sort(kept.begin(), kept.end());
    keys_ = std::move(kept);
  }
  /// An edge was cut in two at vertex m.
  void cut(const MeshEdge& edge, std::uint32_t m) {
    keys_.erase(std::lower_bound(keys_.begin(), keys_.end(), edge.key));
    for (std::uint32_t end : {edge.a(), edge.b()}) {
      const std::uint64_t key = edge_key(m, end);
      keys_.insert(std::lower_bound(keys_.begin(), keys_.end(), key), key);
    }
  }
  /// Vertex v is number[v] now. Edges without length go, and the second of two that fell together.
  void renumber(const std::vector<std::uint32_t>& number) {
    for (auto& key : keys_) key = edge_key(number[first(key)], number[second(key)]);
    std::erase_if(keys_, [](std::uint64_t key) { return first(key) == second(key); });
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }

  /// Of a vertex.
  struct Rank {
    std::uint8_t rank;  ///< 0: inside a smooth part, 1: on a line, 2: end, corner or crossing of lines
    bool rough;         ///< on lines that turn and cross at many of their vertices: noise of the given mesh
  };
  [[nodiscard]] std::vector<Rank> ranks(const std::vector<Vec3d>& p) const {
    std::vector<Rank> of(p.size(), Rank{0, false});
    std::vector<std::array<std::uint32_t, 2>> ends(p.size());
    DisjointSets chains(p.size());
    const auto add = [&](std::uint32_t v, std::uint32_t w) {
      if (of[v].rank < 2) ends[v][of[v].rank] = w;
      if (of[v].rank < 3) ++of[v].rank;
    };
    for (std::uint64_t key : keys_) {
      add(first(key), second(key));
      add(second(key), first(key));
      chains.join(first(key), second(key));
    }
    std::vector<std::array<double, 2>> count(p.size(), {0, 0});  // per chain: vertices, those of rank 2
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      if (of[v].rank == 0) continue;
      // A line that turns as much as a crease has a corner there.
      const bool smooth =
          of[v].rank == 2 &&
          (p[v] - p[ends[v][0]]).normalized().dot((p[ends[v][1]] - p[v]).normalized()) > setup::crease_cosine;
      of[v].rank = smooth ? 1 : 2;
      ++count[chains.root(v)][0];
      count[chains.root(v)][1] += smooth ? 0 : 1;
    }
    for (std::uint32_t v = 0; v < p.size(); ++v) {
      const auto& [all, corners] = count[chains.root(v)];
      of[v].rough = corners > setup::rough_chain * all;
    }
    return of;
  }

  /// The nearest position on the lines of the surface.
  [[nodiscard]] Vec3d project(const Vec3d& x) const noexcept {
    Vec3d best = x;
    double distance = (std::numeric_limits<double>::max)();
    for (const Segment& s : segments_) {
      const Vec3d d = s.b - s.a;
      const double l2 = d.squaredNorm();
      const double u = l2 > 0 ? std::clamp(d.dot(x - s.a) / l2, 0.0, 1.0) : 0.0;
      const Vec3d q = s.a + u * d;
      if ((q - x).squaredNorm() < distance) {
        distance = (q - x).squaredNorm();
        best = q;
      }
    }
    return best;
  }

 private:
  struct Segment {
    Vec3d a, b;
  };

  [[nodiscard]] static std::uint32_t first(std::uint64_t key) noexcept {
    return static_cast<std::uint32_t>(key >> 32);
  }
  [[nodiscard]] static std::uint32_t second(std::uint64_t key) noexcept {
    return static_cast<std::uint32_t>(key);
  }
  [[nodiscard]] static bool turns(const MeshEdge& e, const std::vector<Vec3d>& p,
                                  const std::vector<Triangle>& t) noexcept {
    const Triangle &l = t[e.triangle[0]], &r = t[e.triangle[1]];
    const Vec3d nl = area_vector(p[l[0]], p[l[1]], p[l[2]]), nr = area_vector(p[r[0]], p[r[1]], p[r[2]]);
    return nl.dot(nr) < setup::kept_crease_cosine * nl.norm() * nr.norm();
  }

  std::vector<std::uint64_t> keys_;  // sorted
  std::vector<Segment> segments_;    // of the surface
};

}  // namespace detail
}  // namespace palpate
