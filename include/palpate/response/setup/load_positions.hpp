// SPDX-License-Identifier: MIT
#pragma once

/// @file Where loads are put on a boundary element mesh, and the triangles between them: the load mesh
/// (load_mesh.hpp) in the making. Set-up only.
///
/// Loads are put at every node, and at the middle of every free edge that is longer than half its distance D
/// to the next free crease: w changes with the load's position over D, and between positions it is
/// interpolated linearly. Without the middles a contact between two nodes next to a crease is three times as
/// wrong as one at a node (docs/response_field.md).
///
/// A load that is shared among the nodes around it by linear weights is spread too widely. In the mean over
/// the surface that is mended by what is added to the nodes' loads (`sharpening`): the field of a load at
/// node k, and as much of the others' as linear interpolation has too much there, by a quadratic in the
/// load's position.

#include <palpate/response/setup/constants.hpp>
#include <palpate/response/setup/make_element_mesh.hpp>
#include <palpate/response/setup/quadratic_fit.hpp>
#include <palpate/response/tick/patch_table.hpp>

#include <algorithm>
#include <limits>

namespace palpate::detail {

/// The load mesh of a boundary element mesh, which must outlive it, and what the fields of further loads at
/// set-up are made of.
class LoadPositions {
 public:
  /// A weighted node.
  struct Weight {
    std::uint32_t node;
    Vec3d g;
  };

  explicit LoadPositions(const ElementMesh& m) : mesh_(m), edges_(mesh_edges(m.triangles, "LoadPositions")) {
    std::vector<std::uint8_t> free(m.nodes.size(), 0);
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      if (!m.fixed_triangle[t])
        for (auto k : m.nodes_of[t]) free[k] = 1;
    around_.resize(m.vertices.size());
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t)
      for (auto v : m.triangles[t]) around_[v].push_back(t);
    number_.resize(m.nodes.size());
    const auto add_nodes = [&](bool solved) {
      for (std::uint32_t k = 0; k < number_.size(); ++k) {
        if ((free[k] != 0) != solved) continue;
        number_[k] = static_cast<std::uint32_t>(nodes_.size());
        const ElementMesh::Node& node = m.nodes[k];
        nodes_.push_back({node.normal, node.source, node.size, 0, 0, Vec3<float>::UnitX(), node.crease});
        const Vec3d at = find_position(nodes_.back(), around_[node.vertex]);
        if (node.crease) draw_onto_element(nodes_.back(), at);
      }
    };
    add_nodes(true);
    place_middles();
    solved_ = nodes_.size();
    add_nodes(false);
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t) cut(t);
    const std::vector<List> ring = rings();
    for (std::size_t k = 0; k < ring.size(); ++k)
      for (auto j : ring[k])
        nodes_[k].spacing += (nodes_[j].source - nodes_[k].source).norm() / double(ring[k].size());
    fit_gradients(ring);
    fit_sharpening(ring);
    add_edges();
  }

  [[nodiscard]] LoadMesh load_mesh() const { return {nodes_, triangles_, share_begin_, shares_}; }
  /// Number of solved and fixed nodes.
  [[nodiscard]] std::size_t solved_or_fixed() const noexcept { return nodes_.size() - parts_.size(); }
  /// Nodes that an edge's node is the mean of.
  [[nodiscard]] std::span<const std::uint32_t> parts(std::size_t k) const noexcept {
    return parts_[k - solved_or_fixed()];
  }
  /// Weights g such that sum g h(node) is the gradient of h along the surface at node k, for any h. Not for
  /// edge nodes.
  [[nodiscard]] const std::vector<Weight>& gradient(std::size_t k) const noexcept { return gradient_[k]; }
  /// What is missing at node k in the mean of the linear interpolant around it: sum weight h(node) for any h.
  /// The weights sum to 0. None at nodes that are not solved or next to a crease or to the fixed region.
  [[nodiscard]] const std::vector<NodeWeight>& sharpening(std::size_t k) const noexcept {
    return sharpening_[k];
  }

 private:
  using List = std::vector<std::uint32_t>;
  static constexpr std::uint32_t none = ~0u;

  // The part of the boundary element mesh that contains a node's source: its triangle, with the weights.
  Vec3d find_position(LoadNode& node, const List& triangles) const {
    Vec3d weights = Vec3d::UnitX();
    double best = (std::numeric_limits<double>::max)();
    for (auto t : triangles) {
      const auto& c = mesh_.triangles[t];
      const Vec3d &p = mesh_.vertices[c[0]], &q = mesh_.vertices[c[1]], &r = mesh_.vertices[c[2]];
      const Vec3d w = closest_on_triangle<double>(node.source, p, q, r);
      const double distance = (w[0] * p + w[1] * q + w[2] * r - node.source).squaredNorm();
      if (!(distance < best)) continue;
      best = distance;
      node.triangle = t;
      weights = w.cwiseMax(0.0);
    }
    node.part = weights.cast<float>();
    return weights;
  }
  // A load a little outside the body would not act on it, and one inside it would act twice.
  void draw_onto_element(LoadNode& node, const Vec3d& at) const {
    const Element element(mesh_, node.triangle);
    node.source = element.at(at);
    node.normal = unit_or(element.normal(at), node.normal);
  }
  // The nodes at both ends of an edge, seen from one of its sides.
  [[nodiscard]] std::array<std::uint32_t, 2> ends(const MeshEdge& e, std::size_t side) const noexcept {
    const auto& k = mesh_.nodes_of[e.triangle[side]];
    const std::uint32_t c = e.corner[side];
    return {k[c], k[(c + 1) % 3]};
  }
  [[nodiscard]] bool is_crease(const MeshEdge& e) const noexcept {
    const auto a = ends(e, 0), b = ends(e, 1);
    return a[0] != b[1] || a[1] != b[0];
  }
  [[nodiscard]] bool is_free(const MeshEdge& e) const noexcept {
    return !mesh_.fixed_triangle[e.triangle[0]] && !mesh_.fixed_triangle[e.triangle[1]];
  }

  void place_middles() {
    std::vector<const MeshEdge*> creases;
    for (const MeshEdge& e : edges_)
      if (is_free(e) && is_crease(e)) creases.push_back(&e);
    const auto distance = [&](const Vec3d& x) {
      double least = (std::numeric_limits<double>::max)();
      for (const MeshEdge* e : creases) {
        const Vec3d &a = mesh_.vertices[e->a()], along = mesh_.vertices[e->b()] - a;
        const double s = std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
        least = (std::min)(least, (a + s * along - x).norm());
      }
      return least;
    };
    middle_.assign(mesh_.triangles.size(), {none, none, none});
    for (const MeshEdge& e : edges_) {
      if (!is_free(e) || is_crease(e)) continue;
      const Vec3d &a = mesh_.vertices[e.a()], &b = mesh_.vertices[e.b()], half = 0.5 * (a + b);
      if (!((b - a).norm() > setup::middle_ratio * distance(half))) continue;
      const auto end = ends(e, 0);
      const ElementMesh::Node &p = mesh_.nodes[end[0]], &q = mesh_.nodes[end[1]];
      const double shorter = (q.source - p.source).squaredNorm() / (b - a).squaredNorm();
      const Vec3d bulge = mesh_.middle[e.triangle[0]][e.corner[0]] - half;
      LoadNode node{unit_or(Vec3d(p.normal + q.normal), p.normal),
                    0.5 * (p.source + q.source) + shorter * bulge,
                    0.5 * (p.size + q.size),
                    0,
                    0,
                    Vec3<float>::UnitX(),
                    false};
      List near = around_[e.a()];
      near.insert(near.end(), around_[e.b()].begin(), around_[e.b()].end());
      draw_onto_element(node, find_position(node, near));
      for (std::size_t side = 0; side < 2; ++side)
        middle_[e.triangle[side]][e.corner[side]] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(node);
    }
  }

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) triangles_.push_back({a, b, c});
  }
  // A triangle of the boundary element mesh, cut at the middles of its edges.
  void cut(std::uint32_t t) {
    std::array<std::uint32_t, 3> corner, middle = middle_[t];
    for (std::size_t c = 0; c < 3; ++c) corner[c] = number_[mesh_.nodes_of[t][c]];
    const auto count = 3 - std::count(middle.begin(), middle.end(), none);
    if (count == 1 || count == 2)  // the first edge is cut, the last is not
      while (middle[0] == none || middle[2] != none) {
        std::rotate(corner.begin(), corner.begin() + 1, corner.end());
        std::rotate(middle.begin(), middle.begin() + 1, middle.end());
      }
    switch (count) {
      case 0:
        add(corner[0], corner[1], corner[2]);
        break;
      case 1:
        add(corner[0], middle[0], corner[2]);
        add(middle[0], corner[1], corner[2]);
        break;
      case 2:
        add(middle[0], corner[1], middle[1]);
        add(corner[0], middle[0], middle[1]);
        add(corner[0], middle[1], corner[2]);
        break;
      default:
        add(corner[0], middle[0], middle[2]);
        add(middle[0], corner[1], middle[1]);
        add(middle[2], middle[1], corner[2]);
        add(middle[0], middle[1], middle[2]);
    }
    whole_.resize(triangles_.size(), t);
  }

  // The neighbours of each node. Those of a solved node are solved ones only: fields have a kink at the rim.
  [[nodiscard]] std::vector<List> rings() const {
    std::vector<List> ring(nodes_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t o = 1; o < 3; ++o) {
          const std::uint32_t k = triangles_[t][c], j = triangles_[t][(c + o) % 3];
          if (!mesh_.fixed_triangle[whole_[t]] || k >= solved_) add_once(ring[k], j);
        }
    return ring;
  }
  // Least squares over the neighbours: g = argmin sum |g.d_j - (h_j - h_k)|^2 / |d_j|^2 in the tangent plane.
  // As a load comes near a crease its w grows beyond what the mesh resolves: nodes of creases are left out
  // where there are others, and up to two edges from a crease a second ring of others is added.
  void fit_gradients(const std::vector<List>& ring) {
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
      const LoadNode& node = nodes_[k];
      const Vec3d t1 = perpendicular(node.normal), t2 = node.normal.cross(t1);
      struct Towards {
        double p, q, distance;  // part of the unit vector along t1, t2; distance [m]
      };
      const auto towards = [&](std::uint32_t j) -> Towards {
        const Vec3d d = nodes_[j].source - node.source;
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
          if (j != k && !nodes_[j].crease && nodes_[j].normal.dot(node.normal) > setup::gradient_cosine)
            add_once(near, j);
      };
      gather(ring[k]);
      if (beside_crease[k])
        for (auto l : ring[k]) gather(ring[l]);
      find_moments(near);
      if (near.size() < 3 || determinant() < setup::min_gradient_determinant * (pp + qq) * (pp + qq)) {
        near = ring[k];
        find_moments(near);
      }
      const double least = setup::gradient_penalty * (pp + qq);
      pp += least, qq += least;
      const double det = determinant();
      Vec3d sum = Vec3d::Zero();
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

  // Beside a crease or the fixed region w grows beyond what the mesh resolves: its second derivatives there
  // are not known.
  void fit_sharpening(const std::vector<List>& ring) {
    sharpening_.resize(nodes_.size());
    std::vector<std::uint8_t> at_edge(nodes_.size()), is_left_out;
    for (std::size_t k = 0; k < nodes_.size(); ++k) at_edge[k] = nodes_[k].crease;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      if (mesh_.fixed_triangle[whole_[t]])
        for (auto k : triangles_[t]) at_edge[k] = 1;
    is_left_out = at_edge;
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      for (auto j : ring[k])
        if (at_edge[j]) is_left_out[k] = 1;
    std::vector<Vec3d> by(nodes_.size(), Vec3d::Zero());
    std::vector<double> mass(nodes_.size(), 0);
    for (const auto& t : triangles_)
      for (std::size_t c = 0; c < 3; ++c)
        add_mean_error({nodes_[t[0]].source, nodes_[t[1]].source, nodes_[t[2]].source}, c,
                       Tangents(nodes_[t[c]].normal), by[t[c]], mass[t[c]]);
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
      if (is_left_out[k]) continue;
      const LoadNode& node = nodes_[k];
      List near = ring[k];
      for (auto j : ring[k])
        for (auto l : ring[j])
          if (l != k && !at_edge[l]) add_once(near, l);
      std::vector<Neighbour> seen;
      for (auto j : near)
        seen.push_back({j, nodes_[j].source - node.source, nodes_[j].normal.dot(node.normal)});
      double sum = 0;
      for (const auto& [j, K] : fit_second_derivatives(node.normal, node.spacing, seen)) {
        sharpening_[k].push_back({j, by[k].dot(K) / mass[k]});
        sum += sharpening_[k].back().weight;
      }
      sharpening_[k].push_back({k, -sum});
    }
  }

  // A node where parts meet, and strips between it and the parts' loads along each side of every crease.
  void add_edges() {
    const ElementMesh& m = mesh_;
    std::vector<List> parts(m.vertices.size());
    for (std::uint32_t k = 0; k < m.nodes.size(); ++k) parts[m.nodes[k].vertex].push_back(number_[k]);
    List edge(m.vertices.size());
    for (std::uint32_t v = 0; v < parts.size(); ++v) {
      if (parts[v].size() == 1) {
        edge[v] = parts[v][0];
        continue;
      }
      if (parts[v].empty()) continue;
      LoadNode node{Vec3d::Zero(), m.vertices[v], 0, 0, 0, Vec3<float>::UnitX(), true};
      for (auto k : parts[v]) {
        node.normal += nodes_[k].normal;
        node.size += nodes_[k].size / double(parts[v].size());
        node.spacing += nodes_[k].spacing / double(parts[v].size());
      }
      node.normal = unit_or(node.normal, nodes_[parts[v][0]].normal);
      find_position(node, around_[v]);
      edge[v] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(node);
      parts[v].resize((std::min)(parts[v].size(), LoadMesh::most_parts));
      parts_.push_back(parts[v]);
    }
    share_begin_.assign(solved_or_fixed() - solved_ + 1, 0);
    for (const auto& p : parts_) {
      for (auto k : p)
        if (k < solved_) shares_.push_back({k, 1.f / static_cast<float>(p.size())});
      share_begin_.push_back(static_cast<std::uint32_t>(shares_.size()));
    }
    for (const MeshEdge& e : edges_) {
      if (!is_crease(e)) continue;
      for (std::size_t side = 0; side < 2; ++side) {
        const auto [k, l] = ends(e, side);
        const std::uint32_t a = number_[k], b = number_[l], at = edge[m.nodes[k].vertex],
                            bt = edge[m.nodes[l].vertex];
        add(at, bt, b);
        add(at, b, a);
      }
    }
  }

  const ElementMesh& mesh_;
  std::vector<MeshEdge> edges_;
  std::vector<List> around_;                          // triangles at each vertex
  List number_;                                       // of the boundary element mesh's nodes
  std::vector<std::array<std::uint32_t, 3>> middle_;  // by triangle and edge from corner c to c + 1
  std::vector<LoadNode> nodes_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  List whole_;  // the boundary element mesh's, of each
  std::vector<std::vector<Weight>> gradient_;
  std::vector<std::vector<NodeWeight>> sharpening_;
  std::size_t solved_ = 0;
  std::vector<List> parts_;  // of the last nodes
  std::vector<std::uint32_t> share_begin_;
  std::vector<LoadMesh::Share> shares_;
};

}  // namespace palpate::detail
