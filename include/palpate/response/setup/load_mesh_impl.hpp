// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of load_mesh.hpp: search structures over the load mesh. Set-up only.

#include <palpate/response/setup/constants.hpp>
#include <palpate/response/setup/mesh_edges.hpp>
#include <palpate/response/tick/load_mesh.hpp>

#include <algorithm>

namespace palpate {

PALPATE_COMPILED_INLINE void LoadMesh::index() {
  MeshData<double> mesh;
  mesh.triangles = triangles_;
  for (const auto& n : nodes_) mesh.vertices.push_back(n.source);
  bvh_.emplace(mesh);
  find_neighbours();
  find_beneath();
  Vec3<double> high = low_ = mesh.vertices[0];
  for (const auto& v : mesh.vertices) {
    low_ = low_.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const Vec3<double> size =
      ((high - low_) / cells)
          .cwiseMax(detail::setup::min_cell * (high - low_).maxCoeff() + detail::setup::min_cell_length);
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
PALPATE_COMPILED_INLINE void LoadMesh::find_neighbours() {
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

PALPATE_COMPILED_INLINE void LoadMesh::find_beneath() {
  beneath_begin_ = {0};
  for (const auto& triangle : triangles_) {
    const auto first = static_cast<std::ptrdiff_t>(beneath_.size());
    const auto add = [&](std::uint32_t node, std::size_t corner, float part) {
      auto at = std::find_if(beneath_.begin() + first, beneath_.end(),
                             [node](const Beneath& b) { return b.node == node; });
      if (at == beneath_.end()) at = beneath_.insert(at, {node, Vec3<float>::Zero()});
      at->part[Eigen::Index(corner)] += part;
    };
    for (std::size_t c = 0; c < 3; ++c) {
      if (triangle[c] < solved_)
        add(triangle[c], c, 1);
      else
        for (const Share& s : shares(triangle[c])) add(s.node, c, s.weight);
    }
    beneath_begin_.push_back(static_cast<std::uint32_t>(beneath_.size()));
  }
}

}  // namespace palpate
