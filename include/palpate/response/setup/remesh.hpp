// SPDX-License-Identifier: MIT
#pragma once

/// @file Makes a triangle mesh of a wanted number of vertices from a finer or coarser one: split long edges,
/// collapse short ones, flip to Delaunay, relax, project. Sharp edges and the fixed region's rim stay. Set-up
/// only. Wanted lengths: edge_length.hpp. Source: [botsch2004].

#include <palpate/response/setup/edge_length.hpp>

#include <unordered_map>

namespace palpate {

namespace detail {

class Remesher {
 public:
  Remesher(const SmoothSurface& surface, const std::vector<std::uint8_t>& fixed_triangle,
           const RemeshParams& params)
      : p_(surface.mesh().vertices),
        t_(surface.mesh().triangles),
        fixed_(fixed_triangle),
        features_(surface, fixed_triangle, uniform_length(params.vertices)),
        surface_(surface),
        params_(params),
        wanted_(surface, params) {}

  void run() {
    wanted_.uniform(uniform_length(setup::fine_vertices * params_.vertices));
    if (double(p_.size()) > setup::too_fine_vertices * params_.vertices) {
      wanted_.measure_sections(p_, t_);
      decimate(true);
    }
    drop_faint_lines();
    double aim = params_.vertices;
    for (int pass = 0; pass < 3; ++pass) {
      measure();
      const double further = wanted_.fit(p_, t_, aim);
      if (pass == 0) decimate(false);
      drop_faint_lines();
      for (int i = 0; i < (pass == 0 ? 6 : 3); ++i) {
        split();
        collapse(false);
        flip();
        flip();
        relax();
      }
      aim = std::clamp((aim + further) * setup::usual_excess * params_.vertices / double(p_.size()),
                       setup::min_aim * params_.vertices, params_.vertices);
    }
    compact();
  }

  std::vector<Vec3d> p_;
  std::vector<Triangle> t_;
  std::vector<std::uint8_t> fixed_;  // per triangle
  FeatureLines features_;
  [[nodiscard]] double length() const noexcept { return wanted_.length(); }

 private:
  // Vertex to triangles, rebuilt by each pass.
  struct Rings {
    std::vector<std::uint32_t> begin, item;
    Rings(std::size_t vertices, const std::vector<Triangle>& t) : begin(vertices + 1, 0), item(3 * t.size()) {
      for (const auto& c : t)
        for (auto v : c) ++begin[v + 1];
      for (std::size_t i = 0; i < vertices; ++i) begin[i + 1] += begin[i];
      std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
      for (std::uint32_t i = 0; i < t.size(); ++i)
        for (auto v : t[i]) item[next[v]++] = i;
    }
  };

  [[nodiscard]] double area(std::uint32_t t) const noexcept {
    return area_vector(p_[t_[t][0]], p_[t_[t][1]], p_[t_[t][2]]).norm();
  }
  [[nodiscard]] double uniform_length(double vertices) const {
    double sum = 0;
    for (std::uint32_t t = 0; t < t_.size(); ++t) sum += area(t);
    return std::sqrt(2 / std::sqrt(3.0) * sum / vertices);
  }

  void measure() { wanted_.measure(p_, t_, fixed_, features_); }

  void drop_faint_lines() { features_.drop_faint(p_, t_, fixed_, wanted_.length()); }

  void decimate(bool uniform) {
    for (int i = 0; i < 60; ++i) {
      const std::size_t before = t_.size();
      collapse(uniform);
      if (double(before - t_.size()) < setup::min_progress * double(before)) break;
    }
  }

  void split() {
    measure();
    std::vector<MeshEdge> edges = mesh_edges(t_, "Remesher");
    const auto ratio = [&](const MeshEdge& e) {
      return (p_[e.a()] - p_[e.b()]).norm() / wanted_(e.a(), e.b());
    };
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      if (const double r = ratio(edges[e]); r > setup::split_ratio) order.push_back({-r, e});
    std::sort(order.begin(), order.end());
    std::vector<std::uint8_t> locked(t_.size(), 0);
    for (const auto& [minus_ratio, e] : order) {
      const MeshEdge& edge = edges[e];
      if (locked[edge.triangle[0]] || locked[edge.triangle[1]]) continue;
      const auto m = static_cast<std::uint32_t>(p_.size());
      const bool feature = features_.contains(edge.key);
      const Vec3d middle = 0.5 * (p_[edge.a()] + p_[edge.b()]);
      const Vec3d on = feature ? features_.project(middle) : surface_.project(middle);
      // Farther off lies another part of the surface, or an end of the edge.
      const bool is_close = (on - middle).norm() < setup::max_shift * (p_[edge.a()] - p_[edge.b()]).norm();
      p_.push_back(is_close ? on : middle);
      for (int s = 0; s < 2; ++s) {
        const std::uint32_t t = edge.triangle[s];
        const std::uint32_t c = edge.corner[s];
        locked[t] = 1;
        Triangle other = t_[t];
        t_[t][(c + 1) % 3] = m;
        other[c] = m;
        t_.push_back(other);
        fixed_.push_back(fixed_[t]);
      }
      if (feature) features_.cut(edge, m);
    }
  }

  void collapse(bool uniform) {
    if (!uniform) measure();
    const std::vector<MeshEdge> edges = mesh_edges(t_, "Remesher");
    const Rings rings(p_.size(), t_);
    const std::vector<FeatureLines::Rank> at = features_.ranks(p_);
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t e = 0; e < edges.size(); ++e)
      if (const double r = (p_[edges[e].a()] - p_[edges[e].b()]).norm() / wanted_(edges[e].a(), edges[e].b());
          r < setup::collapse_ratio)
        order.push_back({r, e});
    std::sort(order.begin(), order.end());
    std::vector<std::uint8_t> locked(p_.size(), 0), dead(t_.size(), 0);
    std::vector<std::uint32_t> moved(p_.size());
    for (std::uint32_t v = 0; v < moved.size(); ++v) moved[v] = v;
    for (const auto& [ratio, e] : order) {
      const std::uint32_t a = edges[e].a(), b = edges[e].b();
      if (locked[a] || locked[b]) continue;
      const bool feature = features_.contains(edges[e].key);
      const bool done = at[a].rank <= at[b].rank
                            ? try_collapse(a, b, feature, at, rings, locked, dead, moved)
                            : try_collapse(b, a, feature, at, rings, locked, dead, moved);
      if (!done && at[a].rank == at[b].rank) try_collapse(b, a, feature, at, rings, locked, dead, moved);
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < t_.size(); ++t) {
      if (dead[t]) continue;
      t_[kept] = t_[t];
      fixed_[kept++] = fixed_[t];
    }
    t_.resize(kept);
    fixed_.resize(kept);
    features_.renumber(moved);
    compact();
  }

  // A short edge between rough feature lines, as noise and slivers of the given mesh make them, that is no
  // plate's end.
  [[nodiscard]] bool is_detail(std::uint32_t v, std::uint32_t u) const noexcept {
    return (p_[v] - p_[u]).norm() <
           (std::min)({setup::detail_ratio * wanted_(v, u), setup::detail_thickness * wanted_.thickness(v),
                       setup::detail_thickness * wanted_.thickness(u)});
  }

  // Moves v into u and removes the two triangles between them, if the surface stays a good one.
  bool try_collapse(std::uint32_t v, std::uint32_t u, bool feature, const std::vector<FeatureLines::Rank>& at,
                    const Rings& rings, std::vector<std::uint8_t>& locked, std::vector<std::uint8_t>& dead,
                    std::vector<std::uint32_t>& moved) {
    const bool detail = at[v].rough && at[u].rough && is_detail(v, u);
    if (!detail && (at[v].rank == 2 || (at[v].rank == 1 && !feature))) return false;
    std::uint32_t common = 0, shared = 0, far_end = ~0u;
    for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1]; ++i) {
      const Triangle& t = t_[rings.item[i]];
      bool has_u = false;
      for (auto w : t) {
        if (locked[w]) return false;
        has_u = has_u || w == u;
        if (w != v && w != u && features_.contains(edge_key(v, w))) far_end = w;
      }
      if (has_u) {
        ++shared;
        continue;
      }
      // The triangle after the move: same side, not longer than wanted, no sliver.
      Vec3d q[3];
      for (int c = 0; c < 3; ++c)
        q[c] = p_[t[static_cast<std::size_t>(c)] == v ? u : t[static_cast<std::size_t>(c)]];
      const Vec3d before = area_vector(p_[t[0]], p_[t[1]], p_[t[2]]), after = area_vector(q[0], q[1], q[2]);
      const Vec3d &p0 = p_[t[0]], &p1 = p_[t[1]], &p2 = p_[t[2]];
      if (is_sliver(q[0], q[1], q[2]) && after.norm() < before.norm()) return false;
      if (!(detail && is_sliver(p0, p1, p2)) &&
          before.dot(after) < setup::max_turn_cosine * before.norm() * after.norm())
        return false;
      const double longest = longest_edge(q[0], q[1], q[2]), was = longest_edge(p0, p1, p2);
      if (longest > setup::split_ratio * wanted_(u) && longest > was) return false;
    }
    if (shared != 2) return false;
    for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1]; ++i) {
      for (auto w : t_[rings.item[i]]) {
        if (w == v || w == u) continue;
        for (std::uint32_t j = rings.begin[u]; j < rings.begin[u + 1]; ++j) {
          const Triangle& t = t_[rings.item[j]];
          if (t[0] == w || t[1] == w || t[2] == w) {
            if (w == far_end && at[v].rank == 1 && !detail) return false;
            ++common;
          }
        }
      }
    }
    // Each of the two common neighbours is met twice around v (its two triangles) and twice around u.
    if (common != 8) return false;
    for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1]; ++i) {
      Triangle& t = t_[rings.item[i]];
      bool has_u = false;
      for (auto& w : t) {
        has_u = has_u || w == u;
        locked[w] = 1;
      }
      if (has_u) {
        dead[rings.item[i]] = 1;
      } else {
        for (auto& w : t)
          if (w == v) w = u;
      }
    }
    locked[u] = 1;
    moved[v] = u;
    return true;
  }

  void flip() {
    const std::vector<MeshEdge> edges = mesh_edges(t_, "Remesher");
    std::vector<std::uint64_t> keys;
    for (const auto& e : edges) keys.push_back(e.key);
    std::vector<std::uint8_t> locked(t_.size(), 0);
    for (const auto& e : edges) {
      if (locked[e.triangle[0]] || locked[e.triangle[1]] || features_.contains(e.key)) continue;
      Triangle &l = t_[e.triangle[0]], &r = t_[e.triangle[1]];
      const std::uint32_t a = l[e.corner[0]], b = l[(e.corner[0] + 1u) % 3], c = l[(e.corner[0] + 2u) % 3],
                          d = r[(e.corner[1] + 2u) % 3];
      const auto angle = [&](std::uint32_t at) {
        const Vec3d u = p_[a] - p_[at], v = p_[b] - p_[at];
        return std::atan2(u.cross(v).norm(), u.dot(v));
      };
      if (angle(c) + angle(d) < setup::flip_angle) continue;
      if (std::binary_search(keys.begin(), keys.end(), edge_key(c, d))) continue;
      const Vec3d n0 = area_vector(p_[a], p_[b], p_[c]) + area_vector(p_[b], p_[a], p_[d]);
      const Vec3d n1 = area_vector(p_[a], p_[d], p_[c]), n2 = area_vector(p_[d], p_[b], p_[c]);
      if (n1.dot(n0) < setup::flip_cosine * n1.norm() * n0.norm() ||
          n2.dot(n0) < setup::flip_cosine * n2.norm() * n0.norm())
        continue;
      l = {a, d, c};
      r = {d, b, c};
      locked[e.triangle[0]] = locked[e.triangle[1]] = 1;
      const std::uint64_t key = edge_key(c, d);
      keys.insert(std::lower_bound(keys.begin(), keys.end(), key), key);
    }
  }

  void relax() {
    measure();
    const Rings rings(p_.size(), t_);
    const std::vector<FeatureLines::Rank> at = features_.ranks(p_);
    for (std::uint32_t v = 0; v < p_.size(); ++v) {
      if (at[v].rank == 2) continue;
      Vec3d sum = Vec3d::Zero();
      double weight = 0;
      for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1]; ++i) {
        for (auto w : t_[rings.item[i]]) {
          if (w == v || (at[v].rank == 1 && !features_.contains(edge_key(v, w)))) continue;
          const double l = wanted_(v, w);
          sum += (p_[w] - p_[v]) / l;  // shorter edges where they are wanted
          weight += 1 / l;
        }
      }
      if (!(weight > 0)) continue;
      const Vec3d target = p_[v] + setup::relaxation * sum / weight;
      const Vec3d old = p_[v], moved = at[v].rank == 1 ? features_.project(target) : surface_.project(target);
      bool good = true;
      for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1] && good; ++i) {
        const Triangle& t = t_[rings.item[i]];
        const Vec3d before = area_vector(p_[t[0]], p_[t[1]], p_[t[2]]);
        p_[v] = moved;
        const Vec3d after = area_vector(p_[t[0]], p_[t[1]], p_[t[2]]);
        p_[v] = old;
        good = before.dot(after) > setup::max_turn_cosine * before.norm() * after.norm() &&
               after.norm() > setup::min_area_ratio * before.norm();
      }
      if (good) p_[v] = moved;
    }
  }

  // Drops vertices without a triangle.
  void compact() {
    std::vector<std::uint32_t> number(p_.size(), ~0u);
    for (const auto& t : t_)
      for (auto v : t) number[v] = 0;
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < p_.size(); ++v) {
      if (number[v] == ~0u) continue;
      number[v] = count;
      p_[count] = p_[v];
      ++count;
    }
    p_.resize(count);
    wanted_.renumber(number, count);
    for (auto& t : t_)
      for (auto& v : t) v = number[v];
    features_.renumber(number);
  }

  const SmoothSurface& surface_;
  RemeshParams params_;
  EdgeLength wanted_;
};

}  // namespace detail
}  // namespace palpate
