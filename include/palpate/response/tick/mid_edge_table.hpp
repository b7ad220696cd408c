// SPDX-License-Identifier: MIT
#pragma once

/// @file Corrections that make a linear field over a mesh quadratic: at the middles of edges, and at vertices
/// in the mean. Made at set-up.

#include <palpate/core/simd_shuffle.hpp>
#include <palpate/response/setup/mid_edge_fit.hpp>

#include <span>

namespace palpate {

/// Corrections of a linear field, from the boundary element mesh alone: by edge, weights with b = sum weight
/// u(vertex), how far u at the edge's middle lies from the mean of its ends (none where both ends are fixed);
/// by vertex, weights with r = sum weight u(vertex), the displacement to add there so that a linear field is
/// right in the mean (none where the vertex is fixed). Derivation: mid_edge_fit.hpp.
class MidEdgeTable {
 public:
  struct Weight {
    std::uint32_t vertex;
    float weight;
  };
  struct Rows {
    std::vector<std::uint32_t> begin{0};  ///< first weight of each, and one more
    std::vector<Weight> weights;

    [[nodiscard]] std::span<const Weight> operator[](std::size_t i) const noexcept {
      return {weights.data() + begin[i], begin[i + 1] - begin[i]};
    }
    [[nodiscard]] std::size_t size() const noexcept { return begin.size() - 1; }
    [[nodiscard]] std::size_t memory() const noexcept {
      return begin.size() * sizeof(begin[0]) + weights.size() * sizeof(Weight);
    }
    void push_back(const std::vector<detail::VertexWeight>& row) {
      for (const auto& w : row) weights.push_back({w.vertex, static_cast<float>(w.weight)});
      begin.push_back(static_cast<std::uint32_t>(weights.size()));
    }
  };
  using Edges = std::array<std::uint32_t, 3>;  ///< from corner c to c + 1

  MidEdgeTable() = default;
  MidEdgeTable(const ElementMesh& mesh, const detail::MidEdgeFit& fit) {
    of_triangle_.resize(mesh.triangles.size());
    std::vector<std::uint8_t> rests(fit.size());
    for (std::size_t t = 0; t < of_triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t e = of_triangle_[t][c] = fit.edge(t, c);
        rests[e] =
            mesh.fixed_vertex[mesh.triangles[t][c]] && mesh.fixed_vertex[mesh.triangles[t][(c + 1) % 3]];
      }
    for (std::size_t e = 0; e < fit.size(); ++e)
      edge_rows_.push_back(rests[e] ? std::vector<detail::VertexWeight>{} : fit[e]);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) vertex_rows_.push_back(fit.raise(v));
    find_middles(mesh);
  }
  /// From saved parts (save.hpp).
  MidEdgeTable(const ElementMesh& mesh, std::vector<Edges> of_triangle, Rows edge_rows, Rows vertex_rows)
      : of_triangle_(std::move(of_triangle)),
        edge_rows_(std::move(edge_rows)),
        vertex_rows_(std::move(vertex_rows)) {
    find_middles(mesh);
  }

  [[nodiscard]] const Rows& edge_rows() const noexcept { return edge_rows_; }      ///< of b
  [[nodiscard]] const Rows& vertex_rows() const noexcept { return vertex_rows_; }  ///< of r
  [[nodiscard]] const std::array<std::uint32_t, 2>& ends(std::size_t edge) const noexcept {
    return ends_[edge];
  }
  /// Middles of all edges, by coordinate, padded to whole SIMD vectors; out of reach where an edge has no
  /// correction.
  [[nodiscard]] const std::array<std::vector<float>, 3>& middles() const noexcept { return middle_; }
  [[nodiscard]] const std::vector<Edges>& of_triangle() const noexcept { return of_triangle_; }
  [[nodiscard]] std::size_t memory() const noexcept {
    return of_triangle_.size() * sizeof(Edges) + ends_.size() * sizeof(ends_[0]) +
           3 * middle_[0].size() * sizeof(float) + edge_rows_.memory() + vertex_rows_.memory();
  }

 private:
  void find_middles(const ElementMesh& mesh) {
    ends_.resize(edge_rows_.size());
    for (std::size_t t = 0; t < of_triangle_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        ends_[of_triangle_[t][c]] = {mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]};
    for (auto& list : middle_) list.assign(detail::padded<detail::Simd4>(edge_rows_.size()), 1e9f);
    for (std::size_t e = 0; e < edge_rows_.size(); ++e) {
      if (edge_rows_[e].empty()) continue;
      Vec3<double> x = 0.5 * (mesh.vertices[ends_[e][0]] + mesh.vertices[ends_[e][1]]);
      for (const Weight& w : edge_rows_[e]) x += double(w.weight) * mesh.vertices[w.vertex];
      for (std::size_t axis = 0; axis < 3; ++axis)
        middle_[axis][e] = static_cast<float>(x[static_cast<Eigen::Index>(axis)]);
    }
  }

  std::vector<Edges> of_triangle_;
  std::vector<std::array<std::uint32_t, 2>> ends_;
  std::array<std::vector<float>, 3> middle_;
  Rows edge_rows_, vertex_rows_;
};

}  // namespace palpate
