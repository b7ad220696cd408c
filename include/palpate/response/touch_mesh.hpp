// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where a response field can be touched: the solve mesh's surface, cut into triangles between places of loads.

#include <palpate/response/solve_mesh.hpp>

#include <optional>
#include <span>

namespace palpate {

/// A place among the nodes: weights >= 0 that sum to 1. Continuous in the point it was found from, near the
/// surface.
struct TouchPlace {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 3> node{};
  Vec3<double> weight = Vec3<double>::UnitX();
  double distance2 = 0;  ///< squared, from the point to the place [m^2]
};

/// The whole surface of the solve mesh, fixed region included: closed, so that the place of a point of the surface never
/// jumps, at a rim or across a thin part. Its nodes, in this order:
///
/// | nodes  | where                                                | field of a load                               |
/// |--------|------------------------------------------------------|-----------------------------------------------|
/// | solved | nodes of the solve mesh with a free triangle         | boundary equation                             |
/// | held   | the others                                           | none: w = -u_near                             |
/// | edge   | vertices of the solve mesh where smooth parts meet   | mean of the loads of the nodes that meet there |
///
/// Only solved nodes have columns; the others' loads are shared among them (`shares`), and what is left falls on what is
/// held and moves nothing. At most three parts of an edge node count.
///
/// The loads of a crease's nodes lie inside their own parts; a contact that crosses a crease goes over gradually from one
/// part's nodes to the edge's and on to the other part's.
class TouchMesh {
 public:
  /// A weighted node.
  struct Weight {
    std::uint32_t node;
    Vec3<double> g;
  };
  /// Part of a node's load.
  struct Share {
    std::uint32_t node;  ///< solved
    float weight;
  };
  static constexpr std::size_t most_parts = 3;

  TouchMesh() = default;

  explicit TouchMesh(const SolveMesh& m) {
    std::vector<std::uint8_t> free(m.nodes.size(), 0);
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      if (!m.fixed_triangle[t])
        for (auto k : m.nodes_of[t]) free[k] = 1;
    std::vector<std::uint32_t> number(m.nodes.size(), 0);
    for (const bool solved : {true, false})
      for (std::uint32_t k = 0; k < number.size(); ++k) {
        if ((free[k] != 0) != solved) continue;
        number[k] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back(m.nodes[k]);
        if (solved) solved_ = nodes_.size();
      }
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
      const auto& k = m.nodes_of[t];
      add(number[k[0]], number[k[1]], number[k[2]]);
    }
    fit_gradients(m, number);
    add_edges(m, number);
    index();
  }
  /// From saved parts; what only set-up needs is not there.
  TouchMesh(std::vector<SolveMesh::Node> nodes, std::vector<std::array<std::uint32_t, 3>> triangles,
            std::vector<std::uint32_t> share_begin, std::vector<Share> shares)
      : nodes_(std::move(nodes)),
        triangles_(std::move(triangles)),
        solved_(nodes_.size() + 1 - share_begin.size()),
        share_begin_(std::move(share_begin)),
        shares_(std::move(shares)) {
    index();
  }

  /// Number of solved nodes.
  [[nodiscard]] std::size_t solved() const noexcept { return solved_; }
  /// Solved nodes that share the load of a node that is not solved.
  [[nodiscard]] std::span<const Share> shares(std::size_t k) const noexcept {
    const std::uint32_t first = share_begin_[k - solved_];
    return {shares_.data() + first, share_begin_[k - solved_ + 1] - first};
  }
  /// By node that is not solved, the first of its shares, and one more; the shares.
  [[nodiscard]] const std::vector<std::uint32_t>& share_begin() const noexcept { return share_begin_; }
  [[nodiscard]] const std::vector<Share>& all_shares() const noexcept { return shares_; }
  /// Number of solved and held nodes. Set-up only.
  [[nodiscard]] std::size_t solved_or_held() const noexcept { return nodes_.size() - parts_.size(); }
  /// Nodes that an edge's node is the mean of; none for the others. Set-up only.
  [[nodiscard]] std::span<const std::uint32_t> parts(std::size_t k) const noexcept {
    const std::size_t first = solved_or_held();
    return k < first ? std::span<const std::uint32_t>() : std::span<const std::uint32_t>(parts_[k - first]);
  }
  [[nodiscard]] const std::vector<SolveMesh::Node>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const noexcept {
    return triangles_;
  }

  /// The place x = sum weight (source + d normal) with d the distance along the interpolated normal; the nearest place where
  /// there is none close by. The nearest place of a point over a reflex edge jumps, this one does not. Where the search
  /// starts depends on x alone, so the answer has no memory.
  [[nodiscard]] TouchPlace locate(const Vec3<double>& x) const noexcept {
    const auto at = bvh_->closest(x, start_[cell(x)]);
    TouchPlace place{at.triangle, triangles_[at.triangle], at.weight, at.distance2};
    if (at.distance2 > 0) follow_normals(x, at.position, place);
    return place;
  }
  /// Weights g such that sum g h(node) is the gradient of h along the surface at node k, for any h. Not for edge nodes.
  /// Set-up only.
  [[nodiscard]] const std::vector<Weight>& gradient(std::size_t k) const noexcept { return gradient_[k]; }

 private:
  static constexpr int cells = 16;  // along each axis

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
  }

  // A node where parts meet, and strips between it and the parts' loads along each side of every crease.
  void add_edges(const SolveMesh& m, const std::vector<std::uint32_t>& number) {
    std::vector<std::vector<std::uint32_t>> parts(m.vertices.size());
    for (std::uint32_t k = 0; k < m.nodes.size(); ++k) parts[m.nodes[k].vertex].push_back(number[k]);
    std::vector<std::uint32_t> edge(m.vertices.size());
    for (std::uint32_t v = 0; v < parts.size(); ++v) {
      if (parts[v].size() == 1) {
        edge[v] = parts[v][0];
        continue;
      }
      if (parts[v].empty()) continue;
      SolveMesh::Node node{v, Vec3<double>::Zero(), m.vertices[v], 0, 0, true};
      for (auto k : parts[v]) {
        node.normal += nodes_[k].normal;
        node.size += nodes_[k].size / double(parts[v].size());
      }
      node.normal = unit_or(node.normal, nodes_[parts[v][0]].normal);
      edge[v] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(node);
      parts[v].resize((std::min)(parts[v].size(), most_parts));
      parts_.push_back(parts[v]);
    }
    share_begin_.assign(solved_or_held() - solved_ + 1, 0);
    for (const auto& p : parts_) {
      for (auto k : p)
        if (k < solved_) shares_.push_back({k, 1.f / static_cast<float>(p.size())});
      share_begin_.push_back(static_cast<std::uint32_t>(shares_.size()));
    }
    for (const detail::MeshEdge& e : detail::mesh_edges(m.triangles, "TouchMesh"))
      for (std::size_t side = 0; side < 2; ++side) {
        const std::uint32_t t = e.triangle[side], c = e.corner[side], d = (c + 1) % 3;
        const std::uint32_t a = number[m.nodes_of[t][c]], b = number[m.nodes_of[t][d]];
        const std::uint32_t other_c = (e.corner[1 - side] + 1u) % 3, other_d = e.corner[1 - side];
        const auto& other = m.nodes_of[e.triangle[1 - side]];
        if (number[other[other_c]] == a && number[other[other_d]] == b) continue;  // no crease
        const std::uint32_t at = edge[m.triangles[t][c]], bt = edge[m.triangles[t][d]];
        add(at, bt, b);
        add(at, b, a);
      }
  }

  // From the nearest place over the triangles' prisms, which share their sides. Leaves `place` alone if none holds x.
  void follow_normals(const Vec3<double>& x, const Vec3<double>& nearest, TouchPlace& place) const noexcept {
    std::uint32_t t = place.triangle;
    Vec3<double> n = Vec3<double>::Zero();
    for (std::size_t c = 0; c < 3; ++c) n += place.weight[Eigen::Index(c)] * nodes_[place.node[c]].normal;
    double d = (x - nearest).dot(n);
    for (int step = 0; step < 12; ++step) {
      const SolveMesh::Node &p = nodes_[triangles_[t][0]], &q = nodes_[triangles_[t][1]],
                            &r = nodes_[triangles_[t][2]];
      const Vec3<double> dq = q.normal - p.normal, dr = r.normal - p.normal;
      Vec3<double> eq, er, to, area;
      const auto raise = [&] {
        eq = q.source - p.source + d * dq;
        er = r.source - p.source + d * dr;
        to = x - p.source - d * p.normal;
        area = eq.cross(er);
      };
      raise();
      for (int newton = 0; newton < 4; ++newton) {  // x in the plane of the raised triangle
        const double slope = (dq.cross(er) + eq.cross(dr)).dot(to) - area.dot(p.normal),
                     height = area.dot(to);
        if (!(slope < 0)) return;
        d -= height / slope;
        raise();
        if (height * height < 1e-10 * slope * slope * eq.squaredNorm()) break;  // what is left: its square
      }
      const double a2 = area.squaredNorm();
      if (!(a2 > 0)) return;
      Vec3<double> l(0, to.cross(er).dot(area) / a2, eq.cross(to).dot(area) / a2);
      l[0] = 1 - l[1] - l[2];
      Eigen::Index least = 0;
      if (l.minCoeff(&least) > -1e-9) {
        l = l.cwiseMax(0.0);
        place = {t, triangles_[t], l / l.sum(), place.distance2};
        return;
      }
      t = across_[t][static_cast<std::size_t>(least)];
    }
  }

  void index() {
    MeshData<double> mesh;
    mesh.triangles = triangles_;
    for (const auto& n : nodes_) mesh.vertices.push_back(n.source);
    bvh_.emplace(mesh);
    find_neighbours();
    Vec3<double> high = low_ = mesh.vertices[0];
    for (const auto& v : mesh.vertices) {
      low_ = low_.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    const Vec3<double> size = ((high - low_) / cells).cwiseMax(1e-3 * (high - low_).maxCoeff() + 1e-30);
    per_size_ = size.cwiseInverse();
    start_.resize(cells * cells * cells);
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j)
        for (int k = 0; k < cells; ++k) {
          const Vec3<double> centre = low_ + Vec3<double>(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(size);
          start_[cell(centre)] = bvh_->closest(centre).triangle;
        }
  }
  // The triangle beyond the edge opposite to each corner; itself where there is none.
  void find_neighbours() {
    struct Side {
      std::uint64_t key;
      std::uint32_t triangle, corner;
    };
    std::vector<Side> sides;
    across_.resize(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      across_[t] = {t, t, t};
      for (std::uint32_t c = 0; c < 3; ++c)
        sides.push_back({detail::edge_key(triangles_[t][(c + 1) % 3], triangles_[t][(c + 2) % 3]), t, c});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& l, const Side& r) {
      return l.key < r.key || (l.key == r.key && l.triangle < r.triangle);
    });
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
      const Side &l = sides[i], &r = sides[i + 1];
      if (l.key != r.key) continue;
      across_[l.triangle][l.corner] = r.triangle;
      across_[r.triangle][r.corner] = l.triangle;
    }
  }
  [[nodiscard]] std::size_t cell(const Vec3<double>& x) const noexcept {
    std::size_t at = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double s = (x[axis] - low_[axis]) * per_size_[axis];
      at = at * cells + (s > 0 ? static_cast<std::size_t>((std::min)(s, cells - 0.5)) : 0);
    }
    return at;
  }

  // Least squares over the neighbours: g = argmin sum |g.d_j - (h_j - h_k)|^2 / |d_j|^2 in the tangent plane. A solved node
  // looks at solved ones only: h bends at the rim. As a load comes near a crease its w grows beyond what the mesh resolves: nodes
  // of creases do not count where there are others, and up to two edges from a crease a second ring of others does.
  void fit_gradients(const SolveMesh& m, const std::vector<std::uint32_t>& number) {
    using List = std::vector<std::uint32_t>;
    std::vector<List> ring(nodes_.size());
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t o = 1; o < 3; ++o) {
          const std::uint32_t k = number[m.nodes_of[t][c]], j = number[m.nodes_of[t][(c + o) % 3]];
          if (!m.fixed_triangle[t] || k >= solved_) detail::add_once(ring[k], j);
        }
    std::vector<std::uint8_t> beside_crease(nodes_.size());
    for (std::size_t k = 0; k < nodes_.size(); ++k) beside_crease[k] = nodes_[k].crease;
    for (int edges = 0; edges < 2; ++edges) {
      const std::vector<std::uint8_t> before = beside_crease;
      for (std::size_t k = 0; k < nodes_.size(); ++k)
        for (auto j : ring[k])
          if (before[j]) beside_crease[k] = 1;
    }
    gradient_.resize(nodes_.size());
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
      const SolveMesh::Node& node = nodes_[k];
      const Vec3<double> t1 = perpendicular(node.normal), t2 = node.normal.cross(t1);
      struct Towards {
        double p, q, distance;  // part of the unit vector along t1, t2; distance [m]
      };
      const auto towards = [&](std::uint32_t j) -> Towards {
        const Vec3<double> d = nodes_[j].source - node.source;
        const double distance = d.norm();
        return {d.dot(t1) / distance, d.dot(t2) / distance, distance};
      };
      double pp = 0, pq = 0, qq = 0;
      const auto determinant = [&] { return pp * qq - pq * pq; };
      const auto find_moments = [&](const List& list) {
        pp = pq = qq = 0;
        for (auto j : list) {
          const Towards to = towards(j);
          pp += to.p * to.p, pq += to.p * to.q, qq += to.q * to.q;
        }
      };
      List near;
      const auto gather = [&](const List& from) {
        for (auto j : from)
          if (j != k && !nodes_[j].crease && nodes_[j].normal.dot(node.normal) > 0.3)
            detail::add_once(near, j);
      };
      gather(ring[k]);
      if (beside_crease[k])
        for (auto l : ring[k]) gather(ring[l]);
      find_moments(near);
      if (near.size() < 3 || determinant() < 0.1 * (pp + qq) * (pp + qq)) {  // at most 0.25
        near = ring[k];
        find_moments(near);
      }
      const double least = 1e-6 * (pp + qq);
      pp += least, qq += least;
      const double det = determinant();
      Vec3<double> sum = Vec3<double>::Zero();
      for (auto j : near) {
        const Towards to = towards(j);
        const double unit = det * to.distance;
        gradient_[k].push_back(
            {j, (qq * to.p - pq * to.q) / unit * t1 + (pp * to.q - pq * to.p) / unit * t2});
        sum += gradient_[k].back().g;
      }
      gradient_[k].push_back({k, -sum});
    }
  }

  std::vector<SolveMesh::Node> nodes_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::vector<Weight>> gradient_;
  std::size_t solved_ = 0;
  std::vector<std::vector<std::uint32_t>> parts_;  // of the last nodes
  std::vector<std::uint32_t> share_begin_{0};
  std::vector<Share> shares_;
  std::optional<TriangleBvh<double>> bvh_;
  std::vector<std::array<std::uint32_t, 3>> across_;
  std::vector<std::uint32_t> start_;  // per cell, a triangle near it
  Vec3<double> low_ = Vec3<double>::Zero(), per_size_ = Vec3<double>::Ones();
};

}  // namespace palpate
