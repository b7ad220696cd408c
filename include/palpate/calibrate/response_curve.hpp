// SPDX-License-Identifier: MIT
#pragma once

/// @file The force-depth curve of a response field at a point, for a direction and a patch size: what a force
/// law of the solver is fitted to.

#include <palpate/calibrate/curve_fit.hpp>
#include <palpate/response/response_contact.hpp>

namespace palpate {

/// `count` points up to |contact.displacement|, in its direction; force: along that direction, so that it is
/// the curve of a law F(D) with D the displacement's length. Reports a contact that is not usable, one
/// without displacement, count < 2.
template <Real S>
[[nodiscard]] std::vector<CurvePoint> response_curve(const ResponseField& field,
                                                     const ResponseContact<S>& contact,
                                                     std::size_t count = 20) {
  const char* where = "response_curve";
  const double depth = double(contact.displacement.norm());
  if (!is_usable(contact))
    fail(where, "the contact must be finite, its normal a unit vector, its radius > 0");
  require_positive(depth, where, "the displacement's length [m] must be > 0");
  if (count < 2) fail(where, "count must be >= 2", double(count));
  ResponseTick<1> tick(field);
  std::vector<CurvePoint> curve;
  for (std::size_t i = 1; i <= count; ++i) {
    ResponseContact<S> pressed = contact;
    pressed.displacement *= static_cast<S>(double(i) / double(count));
    Vec3<S> force;
    tick.solve(&pressed, 1, &force);
    curve.push_back({double(i) / double(count) * depth, double(force.dot(contact.displacement)) / depth, 1});
  }
  return curve;
}

/// The same for a frictionless ball, `contact.depth` > 0 at most. Its force starts with a power of the depth,
/// so weights are such that relative errors count.
template <Real S>
[[nodiscard]] std::vector<CurvePoint> response_curve(const ResponseField& field,
                                                     const SphereContact<S>& contact,
                                                     std::size_t count = 20) {
  const char* where = "response_curve";
  require_positive(contact.depth, where, "depth [m] must be > 0");
  require_positive(contact.radius, where, "radius [m] must be > 0");
  if (count < 2) fail(where, "count must be >= 2", double(count));
  ResponseTick<1> tick(field);
  std::vector<CurvePoint> curve;
  for (std::size_t i = 1; i <= count; ++i) {
    SphereContact<S> pressed = contact;
    pressed.depth *= static_cast<S>(double(i) / double(count));
    const double force = tick.solve(pressed).force;
    curve.push_back({double(pressed.depth), force, force > 0 ? 1 / (force * force) : 0});
  }
  return curve;
}

}  // namespace palpate
