// SPDX-License-Identifier: MIT

/// @file The main job: a tool held by a haptic device presses and slides on an elastic object, and the hand
/// gets the force of the paper's sections II to IV. Writes forces.csv and a plot script for it; a scene
/// (scenes.cpp) also writes shapes and pictures. Without the vendor's SDK the stand-in device of
/// examples/standin takes its place, with a scripted hand.

#include "play.hpp"
#include "scenes.hpp"

#include <palpate/geometry/mesh_surface.hpp>

#include <exception>

namespace touch {

using namespace palpate;

template <class Body>
int run(Options options, const Body& body, MeshData<S> display, const char* shape) {
  if (options.shape.empty()) options.shape = shape;
  return play(options,
              Scene<Body>{.title = "object " + std::filesystem::path(options.object).stem().string() +
                                   ", tool " + options.tool + ", script " + options.script,
                          .body = body,
                          .display = std::move(display),
                          .tool = options.tool,
                          .force = paper_force,
                          .coupling = {},
                          .view = view_of(body),
                          .script = [](const Options& o, const Body& b, const Tool& tool) {
                            return make_script(o, b, tool.mesh);
                          }});
}

template <class Body>
int run(const Options& options, const Body& body) {
  return run(options, body, body.mesh(display_vertices), "skeleton");
}

/// The middle of the mesh's box becomes the origin.
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

int main(int argc, char** argv) {
  using namespace touch;
  const Options options = parse(argc, argv);
  if (options.help) {
    std::fputs(usage, stdout);
    return 0;
  }
  try {
    if (!options.scene.empty()) return run_scene(options);
    if (options.object == "ellipsoid") return run(options, Ellipsoid<S>({.axes = V(0.06, 0.04, 0.04)}));
    if (options.object == "sphere") return run(options, Sphere<S>({.radius = 0.05}));
    if (options.object == "box") return run(options, Box<S>({.half = V(0.05, 0.04, 0.05)}));
    if (options.object == "cylinder") return run(options, Cylinder<S>({.radius = 0.05, .half_height = 0.04}));
    if (options.object == "superellipsoid")
      return run(options, Superellipsoid<S>({.axes = V(0.06, 0.04, 0.05)}));
    if (is_mesh_file(options.object)) return run_file(options);
    refuse("unknown object " + options.object);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate_touch: %s\n", error.what());
    return 1;
  }
}
