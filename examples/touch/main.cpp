// SPDX-License-Identifier: MIT

/// @file The main job: a tool held by a haptic device presses and slides on an elastic object; the hand gets
/// the force, the eye the shape. Writes forces.csv and contacts.csv, shapes and pictures. Without the
/// vendor's SDK the stand-in device of examples/standin takes its place, with a scripted hand.

#include <exception>

#include "play.hpp"
#include "scenes.hpp"

int main(int argc, char** argv) {
  using namespace touch;
  Options options = parse(argc, argv);
  if (options.help) {
    std::fputs(usage, stdout);
    return 0;
  }
  if (options.paper) options.out += "/paper";
  try {
    if (options.scene != "all") return play(options);
    for (const char* scene : all_scenes) {
      options.scene = scene;
      if (const int failed = play(options)) return failed;
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate_touch: %s\n", error.what());
    return 1;
  }
}
