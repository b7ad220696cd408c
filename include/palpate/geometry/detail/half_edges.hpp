// SPDX-License-Identifier: MIT
#pragma once

/// @file  Edges of a triangle list: half-edge 3 t + k runs from corner k to k + 1 of triangle t. Set-up.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate::detail {

using Triangle = std::array<std::uint32_t, 3>;

struct HalfEdge {
  std::uint64_t edge;  // lower vertex number, then the higher
  std::uint32_t id;    // 3 t + k

  [[nodiscard]] std::uint32_t low() const noexcept { return static_cast<std::uint32_t>(edge >> 32); }
  [[nodiscard]] std::uint32_t high() const noexcept { return static_cast<std::uint32_t>(edge); }
  friend bool operator<(const HalfEdge& l, const HalfEdge& r) noexcept {
    return l.edge < r.edge || (l.edge == r.edge && l.id < r.id);
  }
};

inline constexpr std::uint32_t no_twin = (std::numeric_limits<std::uint32_t>::max)();

/// Half-edge after and before h in its triangle.
[[nodiscard]] constexpr std::uint32_t next_half_edge(std::uint32_t h) noexcept {
  return h % 3 == 2 ? h - 2 : h + 1;
}
[[nodiscard]] constexpr std::uint32_t previous_half_edge(std::uint32_t h) noexcept {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// All half-edges; those of one edge stand together. At most 1.4e9 triangles.
[[nodiscard]] inline std::vector<HalfEdge> sorted_half_edges(std::span<const Triangle> triangles) {
  std::vector<HalfEdge> list;
  list.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t[k], b = t[k == 2 ? 0 : k + 1];
      list.push_back({a < b ? a << 32 | b : b << 32 | a, static_cast<std::uint32_t>(list.size())});
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

/// The half-edge on the other side of each, `no_twin` where an edge does not have exactly two.
[[nodiscard]] inline std::vector<std::uint32_t> twins(std::span<const HalfEdge> sorted) {
  std::vector<std::uint32_t> twin(sorted.size(), no_twin);
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i + 1;
    while (end < sorted.size() && sorted[end].edge == sorted[i].edge) ++end;
    if (end - i == 2) {
      twin[sorted[i].id] = sorted[i + 1].id;
      twin[sorted[i + 1].id] = sorted[i].id;
    }
    i = end;
  }
  return twin;
}

}  // namespace palpate::detail
