// SPDX-License-Identifier: MIT
#pragma once

/// @file The response field's set-up and tick, for programs of two objects.

#include <palpate/response/response_contact.hpp>
#include <palpate/response/save.hpp>

#include "support/response_meshes.hpp"

#include <vector>

/// Set-up and tick of a small body, and its bytes, as one object sees them.
static std::vector<std::byte> field_here() {
  using palpate::Vec3;
  const palpate::ResponseField field(palpate::test::ellipsoid_mesh(Vec3<double>(0.06, 0.04, 0.04), 6),
                                     [](const Vec3<double>& p) { return p.y() <= -0.03; },
                                     {.E = 1.5e6, .nu = 0.45, .mesh = {.vertices = 20}, .threads = 1});
  palpate::ResponseTick<1> tick(field);
  const palpate::ResponseContact<double> contact{Vec3<double>(0, 0.04, 0), Vec3<double>::UnitY(), 0.01,
                                                 Vec3<double>(0, -0.001, 0)};
  Vec3<double> force;
  tick.solve(&contact, 1, &force);
  std::vector<std::byte> bytes = palpate::save_response_field(field);
  const auto* const at = reinterpret_cast<const std::byte*>(force.data());
  bytes.insert(bytes.end(), at, at + sizeof(force));
  return bytes;
}
