// SPDX-License-Identifier: MIT

/// @file  The main job: a tool held by a haptic device presses and slides on an elastic object, and the hand gets the
/// force of the paper's sections II to IV. Writes forces.csv and a plot script for it; a scene (scenes.cpp) also writes
/// shapes and pictures. Without the vendor's SDK the stand-in device of examples/standin takes its place, with a
/// scripted hand.

#include "scenes.hpp"
#include "session.hpp"

namespace touch {

using namespace palpate;

template <class Body>
int run(const Options& options, const Body& body) {
  const Tool tool = make_tool(options);
  Feel<Contact<Body>> feel{make_contact(body, tool, paper_force)};
  const Script script = make_script(options, body, tool.mesh);
  const V top = body.raycast(V(0, 1, 0), -V::UnitY()).position;
  const std::string title = "object " + options.object + ", tool " + options.tool + ", script " + options.script;
  return perform(options, feel, tool, script, top, title, [](const auto&) {}, [](const auto&) {});
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
    if (options.object == "superellipsoid") return run(options, Superellipsoid<S>({.axes = V(0.06, 0.04, 0.05)}));
    if (options.object.find('.') != std::string::npos)
      refuse(options.object + ": mesh files as elastic objects are not supported yet; choose one of the exact surfaces");
    refuse("unknown object " + options.object);
  } catch (const palpate::SetupError& error) {
    std::fprintf(stderr, "palpate_touch: %s\n", error.what());
    return 1;
  }
}
