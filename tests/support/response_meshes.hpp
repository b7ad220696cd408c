// SPDX-License-Identifier: MIT
#pragma once

/// @file  Closed triangle meshes for the response field's tests.

#include <palpate/geometry/concept.hpp>

#include <cmath>
#include <map>
#include <numbers>

namespace palpate::test {

/// Box with corner at the origin, n squares along each edge.
inline MeshData<double> box_mesh(const Vec3<double>& size, int n) {
  MeshData<double> mesh;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto vertex = [&](std::array<int, 3> c) {
    const auto [at, is_new] = number.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(size.cwiseProduct(Vec3<double>(c[0], c[1], c[2])) / n);
    return at->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          std::uint32_t corner[4];
          const int du[4] = {0, 1, 1, 0}, dv[4] = {0, 0, 1, 1};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> c{};
            c[axis] = side * n;
            c[u] = i + du[k];
            c[v] = j + dv[k];
            corner[k] = vertex(c);
          }
          const bool out = side == 1;
          mesh.triangles.push_back(out ? std::array{corner[0], corner[1], corner[2]}
                                       : std::array{corner[0], corner[2], corner[1]});
          mesh.triangles.push_back(out ? std::array{corner[0], corner[2], corner[3]}
                                       : std::array{corner[0], corner[3], corner[2]});
        }
      }
    }
  }
  return mesh;
}

/// Ellipsoid about the origin: a box's vertices drawn onto it.
inline MeshData<double> ellipsoid_mesh(const Vec3<double>& axes, int n) {
  MeshData<double> mesh = box_mesh(Vec3<double>::Constant(2), n);
  for (auto& p : mesh.vertices) {
    const Vec3<double> t = ((p.array() - 1) * (std::numbers::pi / 4)).tan();
    p = axes.cwiseProduct(t.normalized());
  }
  return mesh;
}

/// A box with rounded edges about the origin, as CAD programs write it: each flat face two triangles, each
/// quarter of a rounding 2 n strips.
inline MeshData<double> rounded_box_mesh(const Vec3<double>& half, double radius, int n) {
  MeshData<double> mesh = box_mesh(Vec3<double>::Constant(2 * n + 1), 2 * n + 1);
  for (auto& p : mesh.vertices) {
    Vec3<double> out, middle;  // direction on the rounding; its centre
    for (int i = 0; i < 3; ++i) {
      const bool upper = p[i] > n + 0.5;
      out[i] = std::tan((p[i] - n - (upper ? 1 : 0)) / n * (std::numbers::pi / 4));
      middle[i] = (upper ? 1 : -1) * (half[i] - radius);
    }
    p = middle + radius * out.normalized();
  }
  return mesh;
}

}  // namespace palpate::test
