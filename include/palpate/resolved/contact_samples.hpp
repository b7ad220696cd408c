// SPDX-License-Identifier: MIT
#pragma once

/// @file Points of a rigid tool at which contact is resolved: even, one per cell, drawn in from sharp edges.
/// Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/detection/resample.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

namespace palpate {

namespace detail {
[[nodiscard]] SurfaceSamples<double> even_samples(const TriangleMesh<double>& mesh, double spacing,
                                                  double crease);
}  // namespace detail

/// Points on the tool's surface, evenly spread over each of its smooth parts, for `ContactPoints`. A cell has
/// the area spacing^2 in the mean; along sharp edges, where triangles meet at more than `crease` [rad], it
/// reaches beyond the edge by a fifth of the spacing. `areas` are the cells'; curved parts are rounded
/// between the mesh's vertices. At least two cells should fit across what is pressed flat.
/// Reports a spacing that is not positive or asks for more than 20,000 points.
template <Real S>
[[nodiscard]] inline SurfaceSamples<S> contact_samples(const TriangleMesh<S>& mesh, S spacing,
                                                       double crease = 0.7) {
  require_positive(spacing, "contact_samples", "spacing [m] must be > 0");
  const SurfaceSamples<double> even = detail::even_samples(
      TriangleMesh<double>(mesh_cast<double>(mesh.data())), static_cast<double>(spacing), crease);
  SurfaceSamples<S> out;
  for (std::size_t i = 0; i < even.points.size(); ++i) {
    out.points.push_back(even.points[i].cast<S>());
    out.areas.push_back(static_cast<S>(even.areas[i]));
    out.vector_areas.push_back(even.vector_areas[i].cast<S>());
  }
  return out;
}

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/resolved/setup/contact_samples_impl.hpp>
#endif
