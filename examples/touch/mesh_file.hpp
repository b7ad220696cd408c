// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triangle meshes from OBJ, PLY and STL files.

#include <palpate/surface/triangle_mesh.hpp>

#include <string>

namespace touch {

struct MeshFile {
  std::string name;
  double scale = 1;     ///< metres per unit of the file
  char up = 'y';        ///< the file's axis that becomes y: x, y or z
  bool repair = false;  ///< mend what can be mended without guessing
};

/// Does the name end as a mesh file's does?
[[nodiscard]] bool is_mesh_file(const std::string& name);

/// The file's triangles in metres, y up. Vertices of one place are one vertex, as OBJ and STL files do not say which are
/// meant to be the same. `repair` also welds vertices that are closer than 1e-6 of the mesh's size, drops triangles
/// without an area and vertices without a triangle, turns neighbours the same way round and each part outside out, and
/// prints what it did; holes and edges of three triangles stay, for TriangleMesh to report.
/// A file that cannot be read is a palpate::SetupError.
[[nodiscard]] palpate::MeshData<double> read_mesh(const MeshFile& file);

}  // namespace touch
