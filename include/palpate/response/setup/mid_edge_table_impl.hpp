// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of mid_edge_table.hpp: from the fit to rows of weights. Set-up only.

#include <palpate/core/simd_shuffle.hpp>
#include <palpate/response/setup/mid_edge_fit.hpp>
#include <palpate/response/tick/mid_edge_table.hpp>

namespace palpate {

PALPATE_COMPILED_INLINE MidEdgeTable::MidEdgeTable(const ElementMesh& mesh, const detail::MidEdgeFit& fit) {
  const auto add = [](Rows& rows, const std::vector<detail::VertexWeight>& row) {
    for (const auto& w : row) rows.weights.push_back({w.vertex, static_cast<float>(w.weight)});
    rows.begin.push_back(static_cast<std::uint32_t>(rows.weights.size()));
  };
  of_triangle_.resize(mesh.triangles.size());
  std::vector<std::uint8_t> rests(fit.size());
  for (std::size_t t = 0; t < of_triangle_.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t e = of_triangle_[t][c] = fit.edge(t, c);
      rests[e] = mesh.fixed_vertex[mesh.triangles[t][c]] && mesh.fixed_vertex[mesh.triangles[t][(c + 1) % 3]];
    }
  for (std::size_t e = 0; e < fit.size(); ++e)
    add(edge_rows_, rests[e] ? std::vector<detail::VertexWeight>{} : fit[e]);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) add(vertex_rows_, fit.at_vertex(v));
  find_middles(mesh);
}

PALPATE_COMPILED_INLINE void MidEdgeTable::find_middles(const ElementMesh& mesh) {
  ends_.resize(edge_rows_.size());
  for (std::size_t t = 0; t < of_triangle_.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      ends_[of_triangle_[t][c]] = {mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]};
  for (auto& list : middle_)
    list.assign(detail::padded<detail::Simd4>(edge_rows_.size()), 1e9f);  // fills up: far from all
  for (std::size_t e = 0; e < edge_rows_.size(); ++e) {
    if (edge_rows_[e].empty()) continue;
    Vec3<double> x = 0.5 * (mesh.vertices[ends_[e][0]] + mesh.vertices[ends_[e][1]]);
    for (const Weight& w : edge_rows_[e]) x += double(w.weight) * mesh.vertices[w.vertex];
    for (std::size_t axis = 0; axis < 3; ++axis)
      middle_[axis][e] = static_cast<float>(x[static_cast<Eigen::Index>(axis)]);
  }
}

}  // namespace palpate
