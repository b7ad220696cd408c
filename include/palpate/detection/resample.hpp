// SPDX-License-Identifier: MIT
#pragma once

/// @file  Even points on a mesh of any resolution, each with its area. Set-up only.

#include <palpate/detection/surface_samples.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <cstddef>

namespace palpate {

inline constexpr std::size_t max_tool_points = 10000000;

/// Points on the mesh about `spacing` [m] apart: no two nearer than 3/4 of it, neighbours at most about 3/2.
/// Edges longer than that are halved, then vertices that stand too close are dropped and their area goes to
/// the nearest one kept, their vector area to those around. Sharp corners are kept first, then sharp edges,
/// because they touch first; then the mesh's own vertices. Reports a spacing that is not positive or asks for
/// more than 10 million points. No equation.
template <Real S>
[[nodiscard]] SurfaceSamples<S> resample(const TriangleMesh<S>& mesh, S spacing);

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/detection/setup/resample_impl.hpp>
#endif
