// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of mesh_surface.hpp. Set-up only.

#include <palpate/geometry/mesh_surface.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {

// Which children of nodes hold triangles of one patch only; children come after their parent.
template <Real S>
void MeshSurface<S>::mark_patches() {
  const auto nodes = bvh_.nodes();
  node_patch_.resize(nodes.size());
  for (std::size_t n = nodes.size(); n-- > 0;) {
    for (std::size_t i = 0; i < nodes[n].count; ++i) {
      const std::uint32_t child = nodes[n].child[i];
      if (nodes[n].leaf != 0) {
        node_patch_[n][i] = normals_.patch[child];
        continue;
      }
      std::uint32_t patch = node_patch_[child][0];
      for (std::size_t j = 1; j < nodes[child].count; ++j)
        if (node_patch_[child][j] != patch) patch = mixed;
      node_patch_[n][i] = patch;
    }
  }
}

template <Real S>
S MeshSurface<S>::estimate_reach() const {
  const auto& v = bvh_.vertices();
  const std::size_t count = bvh_.triangles().size(), step = count / 2000 + 1;
  std::vector<S> half;
  for (std::size_t i = 0; i < count; i += step) {
    const auto& t = bvh_.triangles()[i];
    const Vec3<S>& n = normals_.face[i];
    const Vec3<S> middle = (v[t[0]] + v[t[1]] + v[t[2]]) / S(3);
    // From a little inside, so that the ray does not meet its own triangle (1e-4 is chosen).
    const S skip = S(1e-4L) * edge_;
    const auto hit = bvh_.raycast(middle - skip * n, -n);
    if (hit.triangle != bvh_.none) half.push_back((hit.t + skip) / S(2));
  }
  if (half.empty()) return S(0);
  const auto quantile = half.begin() + static_cast<std::ptrdiff_t>(half.size() / 20);
  std::nth_element(half.begin(), quantile, half.end());
  return *quantile;
}

template <Real S>
MeshSurface<S>::MeshSurface(const TriangleMesh<S>& mesh, const Params& params)
    : crease_(checked(params)),
      bvh_(mesh.data()),
      normals_(mesh, crease_),
      vertex_normals_(mesh.vertex_normals()),
      lower_(mesh.lower()),
      upper_(mesh.upper()),
      centroid_(mesh.centroid()),
      volume_(mesh.volume()),
      edge_(detail::mean_edge(mesh.area(), mesh.triangles().size())),
      blend_(edge_),
      grid_(
          lower_, upper_, (std::clamp)(4 * mesh.triangles().size(), std::size_t(4096), std::size_t(1000000)),
          [this](const Vec3<S>& x, std::uint32_t& triangle) {
            const Nearest near = bvh_.near(x, triangle, detail::DistanceGrid<S>::slack);
            triangle = near.triangle;
            return std::sqrt(near.distance2) / (S(1) + detail::DistanceGrid<S>::slack);
          },
          [this](const Vec3<S>& x, std::uint32_t& triangle) {
            const Nearest near = bvh_.closest(x, triangle);
            triangle = near.triangle;
            return distance(x, near);
          }) {
  mark_patches();
  reach_ = estimate_reach();
}

}  // namespace palpate
