// SPDX-License-Identifier: MIT
#pragma once

/// @file Contacts that move along a closed path over the upper half of the ellipsoid of scenes.hpp, 1 to 2 mm
/// deep and askew.

#include "scenes.hpp"

#include <palpate/response/contact_types.hpp>

#include <array>
#include <numbers>

namespace bench {

struct PathContact {
  std::array<ResponseContact<double>, 2> patches;  // of 5 mm radius, 36 mm or more apart
  ResponseContact<double> turned;                  // the first, tilted and twisted
  SphereContact<double> ball;                      // of 10 mm radius, where the first is
  ContactState<double> state;                      // the first, as a contact solver hands it over
};

/// One of `positions`, with a depth and a direction of its own.
inline PathContact contact_on_path(std::size_t k, std::size_t positions) {
  using V = Vec3<double>;
  const auto body = ellipsoid<double>();
  const double radius = 5e-3, angle = 2 * std::numbers::pi * double(k) / double(positions),
               depth = 1.5e-3 + 0.5e-3 * std::sin(5 * angle);
  const auto at = [](double phi) {
    const double s = 0.45 + 0.15 * std::sin(3 * phi);
    return V(0.06 * s * std::cos(phi), 0.04 * std::sqrt(1 - s * s), 0.04 * s * std::sin(phi));
  };
  const auto patch = [&](double phi, double turn) {
    const V p = at(phi), normal = body.normal(p), along = (at(phi + 1e-4) - p).normalized();
    return ResponseContact<double>{p, normal, radius, depth * (0.4 * along - normal),
                                   turn * (0.2 * along + 0.1 * normal)};
  };
  PathContact out{};
  out.patches = {patch(angle, 0), patch(angle + std::numbers::pi, 0)};
  out.turned = patch(angle, 1);
  const auto& first = out.patches[0];
  const Curvature<double> bend = body.curvature(first.position);
  out.ball = {first.position, first.normal, 2 * radius, bend.k1 + bend.k2, depth};
  out.state.displacement = first.displacement;
  out.state.centre = first.position + first.displacement;
  out.state.normal = first.normal;
  out.state.area = std::numbers::pi * radius * radius;
  return out;
}

}  // namespace bench
