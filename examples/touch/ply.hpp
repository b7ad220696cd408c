// SPDX-License-Identifier: MIT
#pragma once

/// @file Polygons of a PLY file. Not through Assimp as the other formats: its reader of PLY files (5.2.5)
/// crashes or hangs on a tenth of damaged ones.

#include <palpate/core/vector.hpp>

#include <cstdint>
#include <string_view>
#include <vector>

namespace touch {

/// Polygon i: vertices corner[end[i - 1]] to corner[end[i] - 1].
struct Polygons {
  std::vector<palpate::Vec3<double>> vertices;
  std::vector<std::uint32_t> corner;
  std::vector<std::size_t> end;
};

/// The elements "vertex" (x, y, z) and "face" (vertex_indices or vertex_index) of a PLY file, ASCII or
/// binary; everything else in it is passed over. The content must be what the header says: what is not is a
/// std::runtime_error.
[[nodiscard]] Polygons parse_ply(std::string_view content);

}  // namespace touch
