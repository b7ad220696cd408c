// SPDX-License-Identifier: MIT
#pragma once

/// @file In place of the adapter where Assimp is not installed: any file is an ellipsoid as large as the
/// liver of examples/short.

#include <palpate/geometry/ellipsoid.hpp>

#include <string>

namespace palpate {

struct ReadMeshParams {
  double scale = 1;
  char up = 'y';
};

[[nodiscard]] inline MeshData<double> read_mesh(const std::string&, const ReadMeshParams& params = {}) {
  const Vec3<double> half = params.scale * Vec3<double>(3.2, 1.7, 1.9);
  return Ellipsoid<double>({.axes = half, .centre = {0, half.y(), 0}}).mesh(866);
}

}  // namespace palpate
