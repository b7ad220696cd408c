// SPDX-License-Identifier: MIT
#pragma once

/// @file Edges of a closed triangle mesh, and the smooth parts of its surface around each vertex. Set-up
/// only.

#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/response/setup/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace palpate::detail {

using Vec3d = Vec3<double>;
using Triangle = std::array<std::uint32_t, 3>;

/// x at the end of the list, unless it is there already.
inline void add_once(std::vector<std::uint32_t>& list, std::uint32_t x) {
  if (std::find(list.begin(), list.end(), x) == list.end()) list.push_back(x);
}

/// Key of an undirected edge.
[[nodiscard]] inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) noexcept {
  return a < b ? (std::uint64_t{a} << 32) | b : (std::uint64_t{b} << 32) | a;
}

/// An edge and the triangles on its two sides.
struct MeshEdge {
  std::uint64_t key;
  std::uint32_t triangle[2];
  std::uint8_t corner[2];  ///< the edge runs from corner c to corner (c + 1) % 3 of its triangle
  [[nodiscard]] std::uint32_t a() const noexcept { return static_cast<std::uint32_t>(key >> 32); }
  [[nodiscard]] std::uint32_t b() const noexcept { return static_cast<std::uint32_t>(key); }
};

/// The edges of a closed mesh, sorted by key. Reports where the mesh is not closed.
[[nodiscard]] inline std::vector<MeshEdge> mesh_edges(const std::vector<Triangle>& triangles,
                                                      const char* where) {
  struct Half {
    std::uint64_t key;
    std::uint32_t triangle;
    std::uint8_t corner;
  };
  std::vector<Half> half;
  half.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint8_t c = 0; c < 3; ++c)
      half.push_back({edge_key(triangles[t][c], triangles[t][(c + 1u) % 3]), t, c});
  std::sort(half.begin(), half.end(), [](const Half& l, const Half& r) {
    return l.key < r.key || (l.key == r.key && l.triangle < r.triangle);
  });
  std::vector<MeshEdge> edges;
  edges.reserve(half.size() / 2);
  for (std::size_t i = 0; i < half.size(); i += 2) {
    if (i + 1 >= half.size() || half[i].key != half[i + 1].key ||
        (i + 2 < half.size() && half[i + 2].key == half[i].key))
      fail_at(where, "mesh must be closed: each edge needs exactly two triangles", "triangle",
              half[i].triangle);
    const Half &l = half[i], &r = half[i + 1];
    if (triangles[l.triangle][l.corner] == triangles[r.triangle][r.corner])
      fail_at(where, "triangles must all be counter-clockwise seen from outside", "triangle", r.triangle);
    edges.push_back({l.key, {l.triangle, r.triangle}, {l.corner, r.corner}});
  }
  return edges;
}

[[nodiscard]] inline Vec3d area_vector(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
  return 0.5 * (b - a).cross(c - a);
}

[[nodiscard]] inline double longest_edge(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
  return std::sqrt((std::max)({(a - b).squaredNorm(), (b - c).squaredNorm(), (c - a).squaredNorm()}));
}
/// A triangle so thin that its normal says nothing of the surface.
[[nodiscard]] inline bool is_sliver(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
  const double longest = longest_edge(a, b, c);
  return area_vector(a, b, c).norm() < setup::min_shape * longest * longest;
}

/// Disjoint sets of the numbers below `count`, each one its own at first.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    for (std::uint32_t i = 0; i < count; ++i) parent_[i] = i;
  }
  /// The number that stands for i's set.
  [[nodiscard]] std::uint32_t root(std::uint32_t i) noexcept {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// a's set joins b's, whose root stays.
  void join(std::uint32_t a, std::uint32_t b) noexcept { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

/// For each corner of each triangle the number of its fan: corners of one vertex that are joined across edges
/// that are not creases. Returns the fan of corner 3 t + c; `count` receives the number of fans.
[[nodiscard]] inline std::vector<std::uint32_t> corner_fans(const std::vector<Triangle>& triangles,
                                                            const std::vector<MeshEdge>& edges,
                                                            const std::vector<std::uint8_t>& crease,
                                                            std::uint32_t& count) {
  DisjointSets corners(3 * triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (crease[e]) continue;
    const MeshEdge& edge = edges[e];
    const std::uint32_t t0 = edge.triangle[0], t1 = edge.triangle[1], c0 = edge.corner[0],
                        c1 = edge.corner[1];
    // Start of the edge in one triangle is its end in the other.
    const std::uint32_t pairs[2][2] = {{3 * t0 + c0, 3 * t1 + (c1 + 1) % 3},
                                       {3 * t0 + (c0 + 1) % 3, 3 * t1 + c1}};
    for (const auto& pair : pairs) corners.join(pair[0], pair[1]);
  }
  std::vector<std::uint32_t> fan(3 * triangles.size()), number(fan.size(), ~0u);
  count = 0;
  for (std::uint32_t i = 0; i < fan.size(); ++i) {
    const std::uint32_t r = corners.root(i);
    if (number[r] == ~0u) number[r] = count++;
    fan[i] = number[r];
  }
  return fan;
}

}  // namespace palpate::detail
