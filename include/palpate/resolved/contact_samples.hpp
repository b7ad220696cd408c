// SPDX-License-Identifier: MIT
#pragma once

/// @file Points of a rigid tool at which contact is resolved: even, one per cell, drawn in from sharp edges.
/// Set-up only.

#include <palpate/resolved/setup/centroidal_cells.hpp>

namespace palpate {

/// Points on the tool's surface, evenly spread over each of its smooth parts, for `ContactPoints`. A cell has
/// the area spacing^2 in the mean; along sharp edges, where triangles meet at more than `crease` [rad], it
/// reaches beyond the edge by a fifth of the spacing. `areas` are the cells'; curved parts are rounded
/// between the mesh's vertices. At least two cells should fit across what is pressed flat.
/// Reports a spacing that is not positive or asks for more than 20,000 points.
template <Real S>
[[nodiscard]] inline SurfaceSamples<S> contact_samples(const TriangleMesh<S>& mesh, S spacing,
                                                       double crease = 0.7) {
  require_positive(spacing, "contact_samples", "spacing [m] must be > 0");
  if (!(static_cast<double>(mesh.area() / spacing / spacing) <= 2.0 * detail::max_contact_samples))
    fail("contact_samples", "spacing [m] asks for more than 20,000 points", static_cast<double>(spacing));
  const TriangleMesh<double> wide(mesh_cast<double>(mesh.data()));
  const auto h = static_cast<double>(spacing);
  SurfaceSamples<S> out;
  detail::ToolParts tool(wide, h, crease);
  for (detail::CentroidalCells& part : tool.parts()) part.divide(h * h, out);
  return out;
}

}  // namespace palpate
