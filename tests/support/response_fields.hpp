// SPDX-License-Identifier: MIT
#pragma once

/// @file  Response fields of the bodies of reference cases, with small boundary element meshes.

#include <palpate/response/response_field.hpp>

#include "support/response_meshes.hpp"

namespace palpate::test {

/// Semi-axes 60, 40, 40 mm, fixed where y <= -36 mm, 1.5 MPa.
[[nodiscard]] inline ResponseField ellipsoid_field(double nu, double vertices) {
  return ResponseField(ellipsoid_mesh(Vec3<double>(0.06, 0.04, 0.04), 14),
                       [](const Vec3<double>& p) { return p.y() <= -0.036; },
                       {.E = 1.5e6, .nu = nu, .mesh = {.vertices = vertices}, .threads = 1});
}

/// Stands on y = 0, where it is fixed, about the y axis.
[[nodiscard]] inline ResponseField block_field(const Vec3<double>& size, double E, double nu,
                                               double vertices) {
  MeshData<double> mesh = box_mesh(size, 12);
  for (auto& p : mesh.vertices) p -= Vec3<double>(size.x() / 2, 0, size.z() / 2);
  return ResponseField(mesh, [](const Vec3<double>& p) { return p.y() <= 1e-6; },
                       {.E = E, .nu = nu, .mesh = {.vertices = vertices}, .threads = 1});
}

}  // namespace palpate::test
