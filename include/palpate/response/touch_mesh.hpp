// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where a response field can be touched: triangles between the places of its nodes' loads, without gaps.

#include <palpate/response/solve_mesh.hpp>

#include <optional>

namespace palpate {

/// A place among the nodes: weights >= 0 that sum to 1. Continuous in the point it was found from.
struct TouchPlace {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 3> node{};
  Vec3<double> weight = Vec3<double>::UnitX();
  double distance2 = 0;  ///< squared, from the point to the place [m^2]
};

/// Nodes with a free triangle, and triangles between the places of their loads. The loads of a crease's nodes lie inside
/// their own parts; strips between the parts and polygons at corners close the gap, so that a contact that crosses an
/// edge goes over gradually from one part's nodes to the other's.
class TouchMesh {
 public:
  /// A weighted node.
  struct Weight {
    std::uint32_t node;
    Vec3<double> g;
  };
  TouchMesh() = default;

  explicit TouchMesh(const SolveMesh& m) {
    std::vector<std::uint32_t> number(m.nodes.size(), none);
    for (std::size_t t = 0; t < m.triangles.size(); ++t) {
      if (m.fixed_triangle[t]) continue;
      for (auto k : m.nodes_of[t]) number[k] = 0;
    }
    for (std::uint32_t k = 0; k < number.size(); ++k) {
      if (number[k] == none) continue;
      number[k] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(m.nodes[k]);
    }
    for (std::size_t t = 0; t < m.triangles.size(); ++t)
      if (!m.fixed_triangle[t])
        add(number[m.nodes_of[t][0]], number[m.nodes_of[t][1]], number[m.nodes_of[t][2]]);
    fit_gradients();
    bridge(m, number);
    index();
  }
  /// From saved parts; the gradients are not needed in a tick and are not there.
  TouchMesh(std::vector<SolveMesh::Node> nodes, std::vector<std::array<std::uint32_t, 3>> triangles)
      : nodes_(std::move(nodes)), triangles_(std::move(triangles)) {
    index();
  }

  [[nodiscard]] const std::vector<SolveMesh::Node>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const noexcept {
    return triangles_;
  }

  /// The place nearest to x. Where the search starts depends on x alone, so the answer has no memory.
  [[nodiscard]] TouchPlace locate(const Vec3<double>& x) const noexcept {
    const auto at = bvh_->closest(x, start_[cell(x)]);
    return {at.triangle, triangles_[at.triangle], at.weight, at.distance2};
  }
  /// Weights g such that sum g h(node) is the gradient of h along the surface at node k, for any h. Set-up only.
  [[nodiscard]] const std::vector<Weight>& gradient(std::size_t k) const noexcept { return gradient_[k]; }

 private:
  static constexpr std::uint32_t none = ~0u;
  static constexpr int cells = 16;  // along each axis

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != none && b != none && c != none && a != b && b != c && c != a) triangles_.push_back({a, b, c});
  }

  void bridge(const SolveMesh& m, const std::vector<std::uint32_t>& number) {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> joined(m.vertices.size());
    for (const detail::MeshEdge& e : detail::mesh_edges(m.triangles, "TouchMesh")) {
      const auto& l = m.nodes_of[e.triangle[0]];
      const auto& r = m.nodes_of[e.triangle[1]];
      const std::uint32_t a0 = number[l[e.corner[0]]], b0 = number[l[(e.corner[0] + 1u) % 3]];
      const std::uint32_t b1 = number[r[e.corner[1]]], a1 = number[r[(e.corner[1] + 1u) % 3]];
      add(a0, b0, b1);
      add(a0, b1, a1);
      if (a0 != a1) joined[m.triangles[e.triangle[0]][e.corner[0]]].push_back({a0, a1});
      if (b0 != b1) joined[m.triangles[e.triangle[1]][e.corner[1]]].push_back({b0, b1});
    }
    for (auto& pairs : joined) {  // the ring of nodes around a corner, cut into a fan
      if (pairs.size() < 3) continue;
      const std::uint32_t first = pairs[0][0];
      std::uint32_t at = pairs[0][1];
      pairs.erase(pairs.begin());
      while (!pairs.empty() && at != first) {
        const auto next = std::find_if(pairs.begin(), pairs.end(),
                                       [at](const auto& p) { return p[0] == at || p[1] == at; });
        if (next == pairs.end()) break;
        const std::uint32_t other = (*next)[0] == at ? (*next)[1] : (*next)[0];
        pairs.erase(next);
        add(first, at, other);
        at = other;
      }
    }
  }

  void index() {
    MeshData<double> mesh;
    mesh.triangles = triangles_;
    for (const auto& n : nodes_) mesh.vertices.push_back(n.source);
    bvh_.emplace(mesh);
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
  [[nodiscard]] std::size_t cell(const Vec3<double>& x) const noexcept {
    std::size_t at = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double s = (x[axis] - low_[axis]) * per_size_[axis];
      at = at * cells + (s > 0 ? static_cast<std::size_t>((std::min)(s, cells - 0.5)) : 0);
    }
    return at;
  }

  // Least squares over the neighbours: g = argmin sum |g.d_j - (h_j - h_k)|^2 / |d_j|^2 in the tangent plane.
  void fit_gradients() {
    std::vector<std::vector<std::uint32_t>> ring(nodes_.size());
    for (const auto& t : triangles_)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t o = 1; o < 3; ++o) {
          auto& r = ring[t[c]];
          if (std::find(r.begin(), r.end(), t[(c + o) % 3]) == r.end()) r.push_back(t[(c + o) % 3]);
        }
    gradient_.resize(nodes_.size());
    for (std::uint32_t k = 0; k < nodes_.size(); ++k) {
      const Vec3<double> n = nodes_[k].normal, t1 = perpendicular(n), t2 = n.cross(t1);
      Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
      for (auto j : ring[k]) {
        const Vec3<double> d = nodes_[j].source - nodes_[k].source;
        const Eigen::Vector2d s(d.dot(t1), d.dot(t2));
        A += s * s.transpose() / d.squaredNorm();
      }
      A += 1e-6 * A.trace() * Eigen::Matrix2d::Identity();
      const Eigen::Matrix2d inverse = A.inverse();
      Vec3<double> sum = Vec3<double>::Zero();
      for (auto j : ring[k]) {
        const Vec3<double> d = nodes_[j].source - nodes_[k].source;
        const Eigen::Vector2d g = inverse * Eigen::Vector2d(d.dot(t1), d.dot(t2)) / d.squaredNorm();
        gradient_[k].push_back({j, g[0] * t1 + g[1] * t2});
        sum += gradient_[k].back().g;
      }
      gradient_[k].push_back({k, -sum});
    }
  }

  std::vector<SolveMesh::Node> nodes_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::vector<Weight>> gradient_;
  std::optional<TriangleBvh<double>> bvh_;
  std::vector<std::uint32_t> start_;  // per cell, a triangle near it
  Vec3<double> low_ = Vec3<double>::Zero(), per_size_ = Vec3<double>::Ones();
};

}  // namespace palpate
