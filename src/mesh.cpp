// SPDX-License-Identifier: MIT

/// @file Set-up of meshes and of a tool's points, compiled once for programs with PALPATE_COMPILED
/// (config.hpp).

#ifndef PALPATE_COMPILED
#error "compile this file with PALPATE_COMPILED defined, as every file of the program"
#endif

#include <palpate/detection/setup/coarse_tool_impl.hpp>
#include <palpate/detection/setup/proximity_graph_impl.hpp>
#include <palpate/detection/setup/resample_impl.hpp>
#include <palpate/detection/setup/tool_points_impl.hpp>
#include <palpate/geometry/setup/bvh_impl.hpp>
#include <palpate/geometry/setup/mesh_report_impl.hpp>
#include <palpate/geometry/setup/mesh_surface_impl.hpp>
#include <palpate/geometry/setup/triangle_mesh_impl.hpp>

#define PALPATE_MESH_INSTANCES(S)                                              \
  template MeshReport inspect(const MeshData<S>&);                             \
  template class TriangleMesh<S>;                                              \
  template TriangleBvh<S>::TriangleBvh(const MeshData<S>&);                    \
  template MeshSurface<S>::MeshSurface(const TriangleMesh<S>&, const Params&); \
  template SurfaceSamples<S> resample(const TriangleMesh<S>&, S);              \
  template class ToolPoints<S>;                                                \
  template ToolPoints<S> detail::coarse(const ToolPoints<S>&, std::size_t);    \
  template class ProximityGraph<S>;

namespace palpate {
PALPATE_MESH_INSTANCES(float)
PALPATE_MESH_INSTANCES(double)
}  // namespace palpate
