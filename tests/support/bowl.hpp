// SPDX-License-Identifier: MIT
#pragma once

/// @file  Tools whose lower side is a given function: paraboloids, cones, hills, a ball's.

#include <palpate/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace palpate::test {

/// A tool whose lower side is y = height(x, z) over the ellipse with semi-axes a, b; it touches at its
/// origin.
template <class Height>
[[nodiscard]] MeshData<double> bowl(double a, double b, const Height& height) {
  constexpr std::uint32_t rings = 20, sectors = 48;
  constexpr double pi = std::numbers::pi;
  MeshData<double> mesh;
  double top = 0;
  for (std::uint32_t s = 0; s < sectors; ++s)
    top = (std::max)(top, height(a * std::cos(2 * pi * s / sectors), b * std::sin(2 * pi * s / sectors)));
  // Rings from the lowest vertex to the rim, then on to the lid's middle, so that no triangle is long.
  mesh.vertices.emplace_back(0, height(0., 0.), 0);
  for (std::uint32_t r = 1; r < 2 * rings; ++r)
    for (std::uint32_t s = 0; s < sectors; ++s) {
      const double out = static_cast<double>((std::min)(r, 2 * rings - r)) / rings;
      const double x = a * std::cos(2 * pi * s / sectors), z = b * std::sin(2 * pi * s / sectors);
      const double y =
          r <= rings ? height(out * x, out * z) : out * height(x, z) + (1 - out) * (top + 0.2 * b);
      mesh.vertices.emplace_back(out * x, y, out * z);
    }
  mesh.vertices.emplace_back(0, top + 0.2 * b, 0);
  const auto at = [](std::uint32_t r, std::uint32_t s) { return 1 + (r - 1) * sectors + s % sectors; };
  const std::uint32_t last = (2 * rings - 1) * sectors + 1;
  for (std::uint32_t s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (std::uint32_t r = 1; r + 1 < 2 * rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    mesh.triangles.push_back({last, at(2 * rings - 1, s + 1), at(2 * rings - 1, s)});
  }
  return mesh;
}

/// The lower side of a ball of radius R as far as the radius a: of what is sampled all is near the contact.
[[nodiscard]] inline MeshData<double> ball_cap(double R, double a) {
  return bowl(a, a, [R](double x, double z) { return R - std::sqrt(R * R - x * x - z * z); });
}

}  // namespace palpate::test
