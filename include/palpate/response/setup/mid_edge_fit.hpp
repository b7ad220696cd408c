// SPDX-License-Identifier: MIT
#pragma once

/// @file Quadratic displacement without more unknowns: how far u at the middle of an edge lies from the mean
/// of its ends. Set-up only.
///
///     b = u(m) - (u(p) + u(q)) / 2 = -1/8 e^T K e ,   e = q - p
///
/// K: second derivatives of u in the tangent plane, from the quadratic that fits u best at the neighbours of
/// two rings on the same smooth part; mean over the edge's ends and sides. Exact where u is quadratic in a
/// plane; 0 where it is linear. With linear u alone the bending of a bar or plate is 10 to 900 % wrong
/// (docs/accuracy.md). The idea is that of gradient recovery, [zienkiewicz1992].
///
/// The same weights on the vertices' positions place the middles of the elements' edges, so that geometry and
/// displacement are of one kind (isoparametric): else a rotation is none of the body's displacements, and a
/// rod of seven edges around bends half as far as it should. For this least weights w are added by which the
/// middle comes onto the surface, x, as far as the neighbours y span the way there:
///     w_k = (y_k - mean) . l / |y_k - half|^2,   (M + penalty tr M) l = x - half - sum weight (y - half)
///
/// Where u is drawn linearly nevertheless, r is added at the vertices, so that the mean of u is right without
/// mid-edge corrections:
///     r_v = sum int phi_v 4 phi_c phi_d b_cd dS / sum int phi_v dS
/// The sums are over the triangles around v, with b by K there. Over equal triangles, a quarter of a
/// quadratic's error is left where it is curved in all directions alike, two fifths where in one.

#include <palpate/core/cholesky.hpp>
#include <palpate/response/setup/element_mesh.hpp>
#include <palpate/response/setup/mesh_edges.hpp>
#include <palpate/response/setup/quadratic_fit.hpp>

#include <algorithm>

namespace palpate::detail {

struct VertexWeight {
  std::uint32_t vertex;
  double weight;
};

/// For every edge of a boundary element mesh, weights with b = sum weight u(vertex); for every vertex, those
/// of r. They sum to 0.
class MidEdgeFit {
 public:
  explicit MidEdgeFit(const ElementMesh& m) : of_(m.triangles.size()) {
    const std::vector<MeshEdge> edges = mesh_edges(m.triangles, "MidEdgeFit");
    const std::vector<Fit> fits = fit_nodes(m);
    weights_.resize(edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      const MeshEdge& edge = edges[i];
      const Vec3d e = m.vertices[edge.b()] - m.vertices[edge.a()];
      std::vector<VertexWeight>& all = weights_[i];
      for (std::size_t side = 0; side < 2; ++side) {
        const auto& nodes = m.nodes_of[edge.triangle[side]];
        const std::uint32_t c = edge.corner[side];
        of_[edge.triangle[side]][c] = i;
        for (auto k : {nodes[c], nodes[(c + 1) % 3]}) {  // twice where the edge is smooth
          const Vec3d square = Tangents(m.nodes[k].normal).squares(e);
          double sum = 0;
          for (const auto& [vertex, K] : fits[k]) {
            const double w = -0.125 / 4 * square.dot(K);
            all.push_back({vertex, w});
            sum += w;
          }
          all.push_back({m.nodes[k].vertex, -sum});
        }
      }
      for (std::size_t side = 0; side < 2; ++side)
        all.push_back({m.triangles[edge.triangle[side]][(edge.corner[side] + 2) % 3], 0});
      add_up(all);
      draw_to(m.middle[edge.triangle[0]][edge.corner[0]], m.vertices[edge.a()] + 0.5 * e, m, all);
    }
    fit_vertices(m, fits);
  }

  [[nodiscard]] std::size_t size() const noexcept { return weights_.size(); }
  [[nodiscard]] const std::vector<VertexWeight>& operator[](std::size_t edge) const noexcept {
    return weights_[edge];
  }
  /// Middles of the edges where these weights place them, in place of ElementMesh::middle, to which they were
  /// drawn.
  [[nodiscard]] std::vector<std::array<Vec3d, 3>> middles(const ElementMesh& m) const {
    std::vector<std::array<Vec3d, 3>> out(m.triangles.size());
    for (std::size_t t = 0; t < out.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        out[t][c] = 0.5 * (m.vertices[m.triangles[t][c]] + m.vertices[m.triangles[t][(c + 1) % 3]]);
        for (const VertexWeight& w : weights_[of_[t][c]]) out[t][c] += w.weight * m.vertices[w.vertex];
      }
    return out;
  }
  /// r at vertex v; empty where it is fixed.
  [[nodiscard]] const std::vector<VertexWeight>& at_vertex(std::size_t v) const noexcept {
    return at_vertex_[v];
  }
  /// Number of the edge from corner c to c + 1 of triangle t.
  [[nodiscard]] std::uint32_t edge(std::size_t t, std::size_t c) const noexcept { return of_[t][c]; }

 private:
  using Fit = std::vector<SecondDerivative>;  // at a node, by the displacement of vertices

  [[nodiscard]] static std::vector<Fit> fit_nodes(const ElementMesh& m) {
    std::vector<std::vector<std::uint32_t>> ring(m.nodes.size());
    for (const auto& t : m.nodes_of)
      for (std::size_t c = 0; c < 3; ++c) {
        add_once(ring[t[c]], t[(c + 1) % 3]);
        add_once(ring[t[c]], t[(c + 2) % 3]);
      }
    std::vector<Fit> fits(m.nodes.size());
    for (std::uint32_t k = 0; k < m.nodes.size(); ++k) {
      const ElementMesh::Node& node = m.nodes[k];
      std::vector<std::uint32_t> near = ring[k];
      for (auto j : ring[k])
        for (auto l : ring[j]) add_once(near, l);
      std::vector<Neighbour> seen;
      for (auto j : near)
        if (m.nodes[j].vertex != node.vertex)
          seen.push_back({m.nodes[j].vertex, m.vertices[m.nodes[j].vertex] - m.vertices[node.vertex],
                          m.nodes[j].normal.dot(node.normal)});
      fits[k] = fit_second_derivatives(node.normal, node.size, seen);
    }
    return fits;
  }

  // One weight for each vertex.
  static void add_up(std::vector<VertexWeight>& all) {
    std::sort(all.begin(), all.end(), [](const auto& l, const auto& r) { return l.vertex < r.vertex; });
    std::size_t count = 0;
    for (const VertexWeight& w : all)
      if (count > 0 && all[count - 1].vertex == w.vertex)
        all[count - 1].weight += w.weight;
      else
        all[count++] = w;
    all.resize(count);
  }
  // Adds the smallest weights, of sum 0, by which those of the positions are x, the middle of the edge a, b.
  static void draw_to(const Vec3d& x, const Vec3d& half, const ElementMesh& m,
                      std::vector<VertexWeight>& all) {
    Vec3d missing = x - half, mean = Vec3d::Zero();
    Mat3<double> M = Mat3<double>::Zero();
    double sum = 0;
    for (const VertexWeight& w : all) {
      const Vec3d y = m.vertices[w.vertex] - half;
      const double near = 1 / y.squaredNorm();
      missing -= w.weight * y;
      mean += near * y;
      M += near * y * y.transpose();
      sum += near;
    }
    mean /= sum;
    M -= sum * mean * mean.transpose();
    M.diagonal().array() += setup::middle_penalty * M.trace();
    SpdSystem<3> system;
    system.set(M);
    std::copy_n(missing.data(), 3, system.b.begin());
    if (!system.solve(3)) return;  // all of them in one place: they cannot
    const Vec3d by(system.b.data());
    for (VertexWeight& w : all) {
      const Vec3d y = m.vertices[w.vertex] - half;
      w.weight += by.dot(y - mean) / y.squaredNorm();
    }
  }

  void fit_vertices(const ElementMesh& m, const std::vector<Fit>& fits) {
    // r times the vertex's mass = sum by . K over its nodes.
    std::vector<Vec3d> by(m.nodes.size(), Vec3d::Zero());
    std::vector<double> mass(m.vertices.size(), 0);
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
      const Triangle& at = m.triangles[t];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t k = m.nodes_of[t][c];
        add_mean_error({m.vertices[at[0]], m.vertices[at[1]], m.vertices[at[2]]}, c,
                       Tangents(m.nodes[k].normal), by[k], mass[at[c]]);
      }
    }
    at_vertex_.resize(m.vertices.size());
    for (std::size_t k = 0; k < m.nodes.size(); ++k) {
      const std::uint32_t v = m.nodes[k].vertex;
      if (m.fixed_vertex[v]) continue;
      double sum = 0;
      for (const auto& [vertex, K] : fits[k]) {
        at_vertex_[v].push_back({vertex, by[k].dot(K) / mass[v]});
        sum += at_vertex_[v].back().weight;
      }
      at_vertex_[v].push_back({v, -sum});
    }
  }

  std::vector<std::array<std::uint32_t, 3>> of_;
  std::vector<std::vector<VertexWeight>> weights_, at_vertex_;
};

}  // namespace palpate::detail
