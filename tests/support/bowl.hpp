// SPDX-License-Identifier: MIT
#pragma once

/// @file  Tools whose lower side is a given function: paraboloids, cones, hills.

#include <palpate/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpate::test {

/// A tool whose lower side is y = height(x, z) over the ellipse with semi-axes a, b; it touches at its origin.
template <class Height>
[[nodiscard]] MeshData<double> bowl(double a, double b, const Height& height) {
  constexpr std::uint32_t rings = 40, sectors = 96;
  constexpr double pi = std::numbers::pi;
  MeshData<double> mesh;
  mesh.vertices.emplace_back(0, height(0., 0.), 0);
  double top = 0;
  for (std::uint32_t r = 1; r <= rings; ++r)
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const double x = a * r / rings * std::cos(2 * pi * s / sectors),
                   z = b * r / rings * std::sin(2 * pi * s / sectors);
      mesh.vertices.emplace_back(x, height(x, z), z);
      top = (std::max)(top, height(x, z));
    }
  mesh.vertices.emplace_back(0, top + 0.2 * b, 0);
  const auto at = [](std::uint32_t r, std::uint32_t s) { return 1 + (r - 1) * sectors + s % sectors; };
  const std::uint32_t lid = rings * sectors + 1;
  for (std::uint32_t s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (std::uint32_t r = 1; r < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    mesh.triangles.push_back({lid, at(rings, s + 1), at(rings, s)});
  }
  return mesh;
}

}  // namespace palpate::test
