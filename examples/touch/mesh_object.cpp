// SPDX-License-Identifier: MIT

#include "objects.hpp"
#include "play.hpp"

namespace touch {

using namespace palpate;

int run_file(const Options& options) {
  MeshData<S> mesh = read_mesh(options.file(options.object));
  V low = mesh.vertices.front(), high = low;
  for (const V& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  for (V& v : mesh.vertices) v -= (low + high) / 2;
  const V size = 1e3 * (high - low);
  const MeshSurface<S> body{TriangleMesh<S>(mesh)};
  std::printf("%s: %zu vertices, %zu triangles, %.0f x %.0f x %.0f mm\n", options.object.c_str(),
              mesh.vertices.size(), mesh.triangles.size(), size.x(), size.y(), size.z());
  if (!(size.maxCoeff() > 10 && size.maxCoeff() < 1000))
    std::printf("note           the tools are 3 to 60 mm wide: is --scale right?\n");
  return run(options, body, std::move(mesh), "half-space");
}

}  // namespace touch
