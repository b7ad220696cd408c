// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triangle meshes from OBJ, PLY and STL files, where Assimp is there.

#include <palpate/geometry/concept.hpp>

#include <string>

namespace touch {

struct MeshFile {
  std::string name;
  double scale = 1;  ///< metres per unit of the file
  char up = 'y';     ///< the file's axis that becomes y: x, y or z
};

/// Does the name end as a mesh file's does: .obj, .ply or .stl, in any case?
[[nodiscard]] bool is_mesh_file(const std::string& name);

/// The file's mesh in metres, y up: closed, oriented, without defects (palpate/adapters/assimp.hpp, which
/// says what is wrong).
[[nodiscard]] palpate::MeshData<double> read_mesh(const MeshFile& file);

}  // namespace touch
