// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of contact_samples.hpp: even cells on each smooth part. Set-up only.

#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/setup/centroidal_cells.hpp>

namespace palpate::detail {

[[nodiscard]] PALPATE_COMPILED_INLINE SurfaceSamples<double> even_samples(const TriangleMesh<double>& mesh,
                                                                          double spacing, double crease) {
  if (!(mesh.area() / spacing / spacing <= 2.0 * max_contact_samples))
    fail("contact_samples", "spacing [m] asks for more than 20,000 points", spacing);
  SurfaceSamples<double> out;
  ToolParts tool(mesh, spacing, crease);
  for (CentroidalCells& part : tool.parts()) part.divide(spacing * spacing, out);
  return out;
}

}  // namespace palpate::detail
