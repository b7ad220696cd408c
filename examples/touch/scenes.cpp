// SPDX-License-Identifier: MIT

#include "scenes.hpp"

#include <cmath>

namespace touch {

namespace {

/// From the front, the right and above, so that the body and a tool on it fit in.
View view_of(const Body& body) {
  const V half = 500 * (body.upper() - body.lower());
  const double size = half.norm();
  const V at(0, 0.55 * half.y(), 0);
  return {.from = at + size * V(0.85, 1.7, 3.7), .at = at, .angle = 34, .per_newton = std::round(0.2 * size)};
}

}  // namespace

void preset(Options& options) {
  const std::string& scene = options.scene;
  if (scene == "ellipsoid")
    options.object = "ellipsoid", options.tool = "mallet", options.script = "figure10";
  else if (scene == "cube-head")
    options.object = "cube", options.tool = "head";
  else if (scene == "cube-tail")
    options.object = "cube", options.tool = "tail";
  else if (scene == "heart")
    options.object = "heart", options.tool = "compass";
  else
    refuse("unknown scene " + scene + " (ellipsoid, cube-head, cube-tail, heart, all)");
}

std::string title_of(const Options& options, const Body& body) {
  const std::string& scene = options.scene;
  const std::string model = options.shape == "skeleton"   ? ", as the paper has it"
                            : options.shape == "response" ? ", response field"
                                                          : "";
  if (scene == "ellipsoid") return "Fig. 10: a mallet moves along an ellipsoid" + model;
  if (scene == "cube-head") return "Fig. 11: a cube under the head of a mallet" + model;
  if (scene == "cube-tail") return "Fig. 11: a cube under the tail of a mallet" + model;
  if (scene == "heart") return "Fig. 12: a compass on a heart" + model;
  return "object " + body.title + ", tool " + options.tool + ", script " + options.script + model;
}

View scene_view(const Options& options, const Body& body) {
  const std::string& scene = options.scene;
  if (scene == "ellipsoid")
    return {.from = V(70, 150, 300), .at = V(0, 26, 0), .angle = 32, .per_newton = 20};
  if (scene == "cube-head" || scene == "cube-tail")
    return {.from = V(190, 200, 330), .at = V(12, 14, 0), .angle = 34};
  if (scene == "heart") return {.from = V(70, 110, 330), .at = V(0, 22, 0), .angle = 36, .per_newton = 40};
  return view_of(body);
}

}  // namespace touch
