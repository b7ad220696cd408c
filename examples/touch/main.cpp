// SPDX-License-Identifier: MIT

/// @file The main job: a tool held by a haptic device presses and slides on an elastic object, and the hand
/// gets the force of the paper's sections II to IV. Writes forces.csv and a plot script for it; a scene
/// (scenes.cpp) also writes shapes and pictures. Without the vendor's SDK the stand-in device of
/// examples/standin takes its place, with a scripted hand.

#include "objects.hpp"
#include "scenes.hpp"

#include <exception>

int main(int argc, char** argv) {
  using namespace touch;
  const Options options = parse(argc, argv);
  if (options.help) {
    std::fputs(usage, stdout);
    return 0;
  }
  try {
    if (!options.scene.empty()) return run_scene(options);
    return is_mesh_file(options.object) ? run_file(options) : run_surface(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate_touch: %s\n", error.what());
    return 1;
  }
}
