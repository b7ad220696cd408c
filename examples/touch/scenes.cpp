// SPDX-License-Identifier: MIT

#include "scenes.hpp"

#include "heart.hpp"
#include "play.hpp"

namespace touch {

namespace {

using namespace palpate;

/// Down on one point until the hand's spring holds `press` [m], and up again.
template <class Body>
Script press_at(const Body& body, double x, double press) {
  constexpr double hover = 4e-3;
  const V position = body.raycast(V(x, 1, 0), -V::UnitY()).position;
  return table(5.4, [=](double t) -> V {
    const double down = smooth_step(t, 1.2, 3.0) - smooth_step(t, 3.4, 5.2);
    return position + V(0, hover - (hover + press) * down, 0);
  });
}

/// The compass comes down tilted, with one pin, then turns about that pin until the other stands as deep.
Script with_both_pins(const Heart& heart) {
  Script script = press_at(heart, -18e-3, 6e-3);
  script.seconds = 7.0;
  const auto upright = script.target;
  script.target = [upright](double t) -> V { return upright(t < 3.2 ? t : (std::max)(3.2, t - 1.7)); };
  script.turn = [](double t) -> Mat3<S> {
    const double angle = 0.28 * (1 - smooth_step(t, 3.0, 4.6)), c = std::cos(angle), s = std::sin(angle);
    Mat3<S> turn;
    turn << c, -s, 0, s, c, 0, 0, 0, 1;
    return turn;
  };
  return script;
}

Scene<Box<S>> cube(const char* title, const char* tool) {
  const Box<S> body({.half = V(50e-3, 50e-3, 50e-3)});
  return {.title = title,
          .body = body,
          .display = body.mesh(display_vertices),
          .tool = tool,
          .force = paper_force,
          .coupling = {},
          .view = {.from = V(190, 200, 330), .at = V(12, 14, 0), .angle = 34},
          .script = [](const Options&, const Box<S>& box, const Tool&) { return press_at(box, 0, 6.2e-3); }};
}

}  // namespace

int run_scene(Options options) {
  options.out += "/" + options.scene;
  options.stepped = !options.real_time;
  if (options.shape.empty()) options.shape = "skeleton";
  if (options.scene == "ellipsoid") {
    const Ellipsoid<S> body({.axes = V(0.06, 0.04, 0.04)});
    return play(options,
                Scene<Ellipsoid<S>>{
                    .title = "Fig. 10: a mallet moves along an ellipsoid",
                    .body = body,
                    .display = body.mesh(display_vertices),
                    .tool = "mallet",
                    .force = paper_force,
                    .coupling = {},
                    .view = {.from = V(70, 150, 300), .at = V(0, 26, 0), .angle = 32, .per_newton = 20},
                    .script = [](const Options& o, const Ellipsoid<S>& b, const Tool& tool) {
                      return make_script(o, b, tool.mesh);
                    }});
  }
  if (options.scene == "cube-head")
    return play(options, cube("Fig. 11: a cube under the head of a mallet", "head"));
  if (options.scene == "cube-tail")
    return play(options, cube("Fig. 11: a cube under the tail of a mallet", "tail"));
  if (options.scene == "heart") {
    const Heart body({});
    return play(
        options,
        Scene<Heart, Beams>{
            .title = "Fig. 12: a compass on a heart, with one pin, then both",
            .body = body,
            .display = body.mesh(display_vertices),
            .tool = "compass",
            .force = DuffingForce<S>({.c1 = 100, .c3 = 1e7}),  // softer than the paper's
            .coupling = make_beams(body),
            .view = {.from = V(60, 120, 250), .at = V(0, 14, 0), .angle = 33, .per_newton = 30},
            .script = [](const Options&, const Heart& heart, const Tool&) { return with_both_pins(heart); }});
  }
  refuse("unknown scene " + options.scene + " (ellipsoid, cube-head, cube-tail, heart)");
}

}  // namespace touch
