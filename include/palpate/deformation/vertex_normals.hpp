// SPDX-License-Identifier: MIT
#pragma once

/// @file  Area-weighted vertex normals of a closed mesh whose vertices move.

#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// x, y, z, x, y: from the first and from the second entry on, four numbers are one load, and a cross product needs no
/// shuffles.
template <Real S>
using CyclicPoint = std::array<S, 5>;

/// The ring of neighbours p_0 .. p_{m-1} of every vertex, counter-clockwise from outside. The area vectors of a
/// vertex's triangles sum to that of its ring, a closed polygon, in which the vertex itself cancels. Cut into
/// quadrilaterals from o = p_{m-1} it is (m even; otherwise p_{m-1} counts twice)
///
///     2 A = sum_{j < m/2 - 1} (p_{2j+1} - o) x (p_{2j+2} - p_{2j})
///
/// two cross products for six neighbours instead of six, and every product is of short vectors. No equation of the
/// paper; elementary geometry.
///
/// Set-up reports a mesh whose triangles do not close around every vertex.
template <Real S>
class VertexNormals {
 public:
  VertexNormals() = default;

  VertexNormals(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices) {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> sides(vertices);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        if (a >= vertices) fail_at(name, "vertex does not exist", "triangle", t, static_cast<double>(a));
        sides[a].push_back({b, c});
      }
    }
    start_.reserve(vertices + 1);
    start_.push_back(0);
    for (std::size_t v = 0; v < vertices; ++v) {
      const auto& open = sides[v];
      const auto fan = [v] { fail_at(name, "triangles must close around it", "mesh vertex", v); };
      if (open.size() < 3) fan();
      std::uint32_t at = open[0][0];
      for (std::size_t k = 0; k < open.size(); ++k) {
        ring_.push_back(at);
        std::size_t found = open.size();
        for (std::size_t j = 0; j < open.size(); ++j) {
          if (open[j][0] != at) continue;
          if (found != open.size()) fan();
          found = j;
        }
        if (found == open.size()) fan();
        at = open[found][1];
        if (at == open[0][0] && k + 1 < open.size()) fan();
      }
      if (at != open[0][0]) fan();
      if (open.size() % 2 != 0) ring_.push_back(ring_.back());
      start_.push_back(static_cast<std::uint32_t>(ring_.size()));
    }
  }

  /// Neighbours of a vertex.
  [[nodiscard]] std::span<const std::uint32_t> ring(std::size_t vertex) const noexcept {
    return {ring_.data() + start_[vertex], ring_.data() + start_[vertex + 1]};
  }

  /// Twice the area vector of the vertex's ring; its direction is the normal.
  [[nodiscard]] Vec3<S> area(std::size_t vertex, const CyclicPoint<S>* position) const noexcept {
    using Four = Eigen::Map<const Eigen::Array<S, 4, 1>>;
    const std::uint32_t* r = ring_.data() + start_[vertex];
    const std::size_t m = start_[vertex + 1] - start_[vertex];
    const S* const o = position[r[m - 1]].data();
    Eigen::Array<S, 4, 1> sum = Eigen::Array<S, 4, 1>::Zero();  // z, x, y of the cross products
    for (std::size_t j = 0; j + 2 < m; j += 2) {
      const S* const p = position[r[j]].data();
      const S* const q = position[r[j + 1]].data();
      const S* const s = position[r[j + 2]].data();
      sum += (Four(q) - Four(o)) * (Four(s + 1) - Four(p + 1)) -
             (Four(q + 1) - Four(o + 1)) * (Four(s) - Four(p));
    }
    return Vec3<S>(sum[1], sum[2], sum[0]);
  }

 private:
  static constexpr const char* name = "VertexNormals";

  std::vector<std::uint32_t> ring_, start_;
};

}  // namespace palpate
