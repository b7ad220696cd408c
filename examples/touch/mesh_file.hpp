// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triangle meshes from OBJ, PLY and STL files.

#include <palpate/geometry/triangle_mesh.hpp>

#include <string>
#include <string_view>

namespace touch {

struct MeshFile {
  std::string name;
  double scale = 1;     ///< metres per unit of the file
  char up = 'y';        ///< the file's axis that becomes y: x, y or z
  bool repair = false;  ///< mend what can be mended without guessing, and print what was done
};

/// Does the name end as a mesh file's does: .obj, .ply or .stl, in any case?
[[nodiscard]] bool is_mesh_file(const std::string& name);

/// The file's mesh in metres, y up: closed, oriented, without defects. Whatever is wrong is a
/// std::runtime_error that names the file and, of a mesh that is not sound, every defect with its number,
/// place and remedy.
[[nodiscard]] palpate::MeshData<double> read_mesh(const MeshFile& file);

/// The two halves of read_mesh() behind the file system: the triangles in a file's content, and what is wrong
/// with them.
///
/// Vertices of one place become one vertex, as OBJ and STL files do not say which are meant to be the same;
/// points and lines are left out. `repair` also welds vertices that are closer than 1e-6 of the mesh's size,
/// drops triangles that this leaves without three corners and vertices without a triangle, turns neighbours
/// the same way round and each part outside out. Holes, edges of three triangles and triangles without height
/// stay, for check_mesh() to name.
[[nodiscard]] palpate::MeshData<double> parse_mesh(const MeshFile& file, std::string_view content);
void check_mesh(const MeshFile& file, const palpate::MeshData<double>& mesh);

}  // namespace touch
