// SPDX-License-Identifier: MIT

#include "shape.hpp"

namespace touch {

using namespace palpate;

DuffingMap<S> same_everywhere(const Body& body, const DuffingForce<S>::Params& law) {
  return DuffingMap<S>(
      {.spacing = (body.upper() - body.lower()).norm(), .lower = body.lower(), .upper = body.upper()},
      [&](const V&) { return law; });
}

Answer make_answer(const Options& options, const Body& body, const Tool& tool) {
  // The paper's parameters (section VII), lengths in mm and m = 1 kg: F = 0.04 D + 0.3 D^3. Those of the
  // heart are softer.
  const DuffingForce<S>::Params law = options.object == "heart"
                                          ? DuffingForce<S>::Params{.c1 = 100, .c3 = 1e7}
                                          : DuffingForce<S>::Params{.c1 = 40, .c3 = 3e8};
  const std::string& shape = options.shape;
  if (shape == "response") return response_answer(body, tool);
  const DuffingMap<S> force = same_everywhere(body, law);
  if (shape == "none") return {Shape(), force};
  if (shape == "skeleton") return {skeleton_shape(body), force};
  if (shape == "half-space") return {half_space_shape(body), force};
  refuse("unknown shape " + shape + " (skeleton, half-space, response, none)");
}

}  // namespace touch
