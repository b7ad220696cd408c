// SPDX-License-Identifier: MIT

#include "objects.hpp"
#include "play.hpp"

namespace touch {

using namespace palpate;

namespace {

template <class Body>
int run(const Options& options, const Body& body) {
  return run(options, body, body.mesh(display_vertices), "skeleton");
}

}  // namespace

template int play(Options, const Scene<Box<S>>&);
template int play(Options, const Scene<Ellipsoid<S>>&);

int run_surface(const Options& options) {
  if (options.object == "ellipsoid") return run(options, Ellipsoid<S>({.axes = V(0.06, 0.04, 0.04)}));
  if (options.object == "sphere") return run(options, Sphere<S>({.radius = 0.05}));
  if (options.object == "box") return run(options, Box<S>({.half = V(0.05, 0.04, 0.05)}));
  if (options.object == "cylinder") return run(options, Cylinder<S>({.radius = 0.05, .half_height = 0.04}));
  if (options.object == "superellipsoid")
    return run(options, Superellipsoid<S>({.axes = V(0.06, 0.04, 0.05)}));
  refuse("unknown object " + options.object);
}

}  // namespace touch
