// SPDX-License-Identifier: MIT
#pragma once

/// @file  Points that stand for a surface.

#include <palpate/core/vector.hpp>

#include <vector>

namespace palpate {

/// Points on a surface and the area that each stands for; #points = #areas.
template <Real S>
struct SurfaceSamples {
  std::vector<Vec3<S>> points;  ///< [m]
  std::vector<S> areas;         ///< sums to the surface's area [m^2]
  /// Outward normal times area, summed over its part [m^2]; empty: unknown.
  std::vector<Vec3<S>> vector_areas;
};

}  // namespace palpate
