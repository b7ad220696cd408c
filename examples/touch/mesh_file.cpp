// SPDX-License-Identifier: MIT

#include "mesh_file.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#if __has_include(<assimp/Importer.hpp>)
#include <palpate/adapters/assimp.hpp>
#define TOUCH_READS_MESHES 1
#else
#define TOUCH_READS_MESHES 0
#endif

namespace touch {

bool is_mesh_file(const std::string& name) {
  std::string last = name.size() < 4 ? "" : name.substr(name.size() - 4);
  std::transform(last.begin(), last.end(), last.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return last == ".obj" || last == ".ply" || last == ".stl";
}

palpate::MeshData<double> read_mesh(const MeshFile& file) {
#if TOUCH_READS_MESHES
  return palpate::read_mesh(file.name, {.scale = file.scale, .up = file.up});
#else
  throw std::runtime_error(file.name + ": cannot be read: this was built without Assimp (libassimp-dev)");
#endif
}

}  // namespace touch
