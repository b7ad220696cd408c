// SPDX-License-Identifier: MIT

/// @file The response field: boundary elements at set-up give the shape and the force of the same body.

#include "shape.hpp"

#include <palpate/calibrate/response_map.hpp>
#include <palpate/response/deformation.hpp>

#include <cmath>
#include <numbers>

namespace touch {

using namespace palpate;

namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Answer response_answer(const Body& body, const Tool& tool) {
  auto begin = std::chrono::steady_clock::now();
  const bool terminal = is_terminal();
  const auto fixed = [below = fixed_below(body)](const auto& position) { return position.y() <= below; };
  const auto field = std::make_shared<const ResponseField>(
      body.display, fixed,
      ResponseField::Params{.E = rubber.params().E,
                            .nu = rubber.params().nu,
                            .threads = 2,
                            .progress = [terminal](double done) {
                              if (terminal)
                                std::printf("\rresponse field %3.0f %%", 100 * done), std::fflush(stdout);
                            }});
  std::printf("%sresponse field of %zu boundary element vertices, E = %.0f kPa: %.1f s\n",
              terminal ? "\r" : "", field->mesh().vertices.size(), 1e-3 * rubber.params().E,
              seconds_since(begin));

  // The force under the tool's contact area, down to two radii.
  begin = std::chrono::steady_clock::now();
  const S radius = std::sqrt(tool.contact_area / std::numbers::pi_v<S>);
  auto fitted = response_map(
      *field, body,
      ResponseMapParams<S>{.radius = radius, .depth = 2 * radius, .spacing = field->mesh().length / 2});
  const auto law = fitted.map.at(body.top()).params();
  std::printf("force          of the field: c1 %.0f N/m, c3 %.2g N/m^3 on top, fits within %.1f %%: %.1f s\n",
              law.c1, law.c3, 100 * fitted.worst_rms, seconds_since(begin));
  return {shape_of(ResponseFieldDeformation<S, max_regions>(field, body.display)), std::move(fitted.map)};
}

}  // namespace touch
