// SPDX-License-Identifier: MIT
#pragma once

/// @file  What is wrong with a triangle list, where, and how often: `inspect()`. Set-up only.

#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate {

/// In the order in which they are reported; a later one can be a consequence of an earlier one.
enum class MeshDefect : std::uint8_t {
  empty,                     ///< no triangle
  too_large,                 ///< more than 1e9 triangles or vertices
  bad_index,                 ///< a triangle names a vertex that does not exist
  bad_vertex,                ///< a coordinate is NaN, infinite or above 1e6 m
  repeated_index,            ///< a triangle names a vertex twice
  duplicate_vertex,          ///< two vertices at one position
  zero_area,                 ///< height below the rounding of the coordinates
  unused_vertex,             ///< no triangle names it
  open_edge,                 ///< one triangle only: a hole
  non_manifold_edge,         ///< three triangles or more
  inconsistent_orientation,  ///< two triangles that run through their edge in the same direction
  non_manifold_vertex,       ///< two fans of triangles that share only the vertex
  inside_out,                ///< a closed part that is turned wrong, overlaps another or holds no volume
};
inline constexpr std::size_t mesh_defect_count = 13;

/// Counts of every defect. Where a vertex or an index is bad the rest is not looked for, and parts are looked
/// at only if everything else is right.
struct MeshReport {
  struct Entry {
    std::size_t count = 0;
    std::size_t first = 0;     ///< triangle; vertex for the vertex defects
    std::size_t a = 0, b = 0;  ///< the two vertices for edges and duplicates
  };
  std::array<Entry, mesh_defect_count> defects{};

  [[nodiscard]] const Entry& operator[](MeshDefect d) const noexcept {
    return defects[static_cast<std::size_t>(d)];
  }
  [[nodiscard]] bool valid() const noexcept {
    return std::all_of(defects.begin(), defects.end(), [](const Entry& e) { return e.count == 0; });
  }
  void add(MeshDefect d, std::size_t first, std::size_t a = 0, std::size_t b = 0) noexcept {
    Entry& e = defects[static_cast<std::size_t>(d)];
    if (e.count++ == 0) e = {1, first, a, b};
  }
};

/// One line on defect `d`: how many, where the first is, and how to mend it. Empty if there is none.
struct MeshMessage {
  char text[200] = "";
};
[[nodiscard]] MeshMessage describe(const MeshReport& report, MeshDefect d) noexcept;

/// Looks for every defect of a closed, oriented triangle mesh. Self-intersection within one closed part is
/// not looked for. No equation. Time: n log n; holds a few copies of the mesh.
template <Real S>
[[nodiscard]] MeshReport inspect(const MeshData<S>& mesh);

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/geometry/setup/mesh_report_impl.hpp>
#endif
