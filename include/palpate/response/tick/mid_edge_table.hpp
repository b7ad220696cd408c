// SPDX-License-Identifier: MIT
#pragma once

/// @file Corrections that make a linear field over a mesh quadratic: at the middles of edges, and at vertices
/// in the mean. Made at set-up.

#include <palpate/response/setup/element_mesh.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

namespace detail {
class MidEdgeFit;
}

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
  };
  using Edges = std::array<std::uint32_t, 3>;  ///< from corner c to c + 1

  MidEdgeTable() = default;
  MidEdgeTable(const ElementMesh& mesh, const detail::MidEdgeFit& fit);
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
  void find_middles(const ElementMesh& mesh);

  std::vector<Edges> of_triangle_;
  std::vector<std::array<std::uint32_t, 2>> ends_;
  std::array<std::vector<float>, 3> middle_;
  Rows edge_rows_, vertex_rows_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/mid_edge_table_impl.hpp>
#endif
