// SPDX-License-Identifier: MIT
#pragma once

/// @file  Normals of a closed mesh: of its faces, of its corners with creases kept sharp; and its smooth
/// patches. Set-up only.

#include <palpate/geometry/detail/corner_weight.hpp>
#include <palpate/geometry/detail/half_edges.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>

namespace palpate::detail {

/// An edge whose triangles' normals differ by more than `crease` is sharp. A corner's normal is the sum of
/// the normals of the triangles that are joined to it around the vertex without crossing a sharp edge, by
/// corner_weight(); a patch is what is joined over the surface without crossing one. Without sharp edges a
/// corner's normal is the same all around the vertex.
template <Real S>
struct CreaseNormals {
  std::vector<std::uint32_t> twin;    // other side of half-edge 3 t + k
  std::vector<Vec3<S>> face;          // unit, per triangle
  std::vector<Vec3<S>> normal;        // unit, shared by the corners of a fan
  std::vector<std::uint32_t> corner;  // 3 t + k -> normal
  std::vector<std::uint32_t> patch;   // per triangle
  std::uint32_t patches = 0;

  CreaseNormals(const TriangleMesh<S>& mesh, S crease) : twin(twins(sorted_half_edges(mesh.triangles()))) {
    using W = Wide<S>;
    const std::size_t count = mesh.triangles().size();
    std::vector<Vec3<W>> flat(count);
    std::vector<W> angle(3 * count), twice_area(count);
    face.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
      std::array<Vec3<W>, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices()[mesh.triangles()[t][k]].template cast<W>();
      const Vec3<W> twice = (p[1] - p[0]).cross(p[2] - p[0]);
      twice_area[t] = twice.norm();
      flat[t] = twice / twice_area[t];
      face.push_back(flat[t].template cast<S>());
      for (std::size_t k = 0; k < 3; ++k)
        angle[3 * t + k] = std::atan2(twice_area[t], (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]));
    }
    const W least = std::cos(static_cast<W>(crease));
    const auto sharp = [&](std::uint32_t h) { return flat[h / 3].dot(flat[twin[h] / 3]) < least; };

    // Around the vertex at the start of h: over h to one side, over the half-edge before h to the other.
    constexpr std::uint32_t open = no_twin;
    corner.assign(3 * count, open);
    std::vector<std::uint32_t> fan;
    for (std::uint32_t seed = 0; seed < corner.size(); ++seed) {
      if (corner[seed] != open) continue;
      std::uint32_t h = seed;
      while (!sharp(h)) {
        h = next_half_edge(twin[h]);
        if (h == seed) break;
      }
      const auto index = static_cast<std::uint32_t>(normal.size());
      W largest = 0;
      fan.clear();
      for (;;) {
        corner[h] = index;
        fan.push_back(h);
        largest = (std::max)(largest, twice_area[h / 3]);
        const std::uint32_t before = previous_half_edge(h);
        if (sharp(before) || corner[twin[before]] == index) break;
        h = twin[before];
      }
      Vec3<W> sum = Vec3<W>::Zero();
      for (const std::uint32_t c : fan)
        sum += corner_weight(angle[c], twice_area[c / 3], largest) * flat[c / 3];
      normal.push_back(unit_or<W>(sum, flat[seed / 3]).template cast<S>());
    }

    patch.assign(count, open);
    std::vector<std::uint32_t> list;
    for (std::uint32_t seed = 0; seed < count; ++seed) {
      if (patch[seed] != open) continue;
      patch[seed] = patches;
      list.assign(1, seed);
      while (!list.empty()) {
        const std::uint32_t t = list.back();
        list.pop_back();
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
          const std::uint32_t other = twin[h] / 3;
          if (patch[other] != open || sharp(h)) continue;
          patch[other] = patches;
          list.push_back(other);
        }
      }
      ++patches;
    }
  }
};

}  // namespace palpate::detail
