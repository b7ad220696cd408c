// SPDX-License-Identifier: MIT
#pragma once

/// @file Definitions of triangle_mesh.hpp. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/geometry/detail/mesh_parts.hpp>
#include <palpate/geometry/triangle_mesh.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace palpate {

template <Real S>
TriangleMesh<S>::TriangleMesh(MeshData<S> data) : data_(std::move(data)) {
  const MeshReport report = inspect(data_);
  for (std::size_t d = 0; d < mesh_defect_count; ++d) {
    if (report.defects[d].count > 0) fail("TriangleMesh", describe(report, static_cast<MeshDefect>(d)).text);
  }
  measure();
}

// Sums in double relative to the first vertex, so that a body far from its origin keeps its digits.
template <Real S>
void TriangleMesh<S>::measure() {
  using W = detail::Wide<S>;
  const auto at = [&](std::uint32_t v) { return Vec3<W>(data_.vertices[v].template cast<W>()); };
  const Vec3<W> origin = at(data_.triangles[0][0]);
  std::vector<W> areas(data_.vertices.size(), W(0));
  std::vector<Vec3<W>> vector_areas(data_.vertices.size(), Vec3<W>::Zero());
  std::vector<Vec3<W>> normals(data_.vertices.size(), Vec3<W>::Zero());
  W area = 0, volume = 0;
  Vec3<W> moment = Vec3<W>::Zero();
  for (const auto& t : data_.triangles) {
    const std::array<Vec3<W>, 3> p{at(t[0]) - origin, at(t[1]) - origin, at(t[2]) - origin};
    const Vec3<W> twice = (p[1] - p[0]).cross(p[2] - p[0]);
    const W length = twice.norm(), six_volumes = p[0].dot(p[1].cross(p[2]));
    area += length / 2;
    volume += six_volumes / 6;
    moment += six_volumes / 24 * (p[0] + p[1] + p[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<W> e = p[(k + 1) % 3] - p[k], f = p[(k + 2) % 3] - p[k];
      areas[t[k]] += length / 6;
      vector_areas[t[k]] += twice / 6;
      normals[t[k]] += std::atan2(length, e.dot(f)) / length * twice;
    }
  }
  area_ = static_cast<S>(area);
  volume_ = static_cast<S>(volume);
  centroid_ = (origin + moment / volume).template cast<S>();
  lower_ = upper_ = data_.vertices[0];
  for (const Vec3<S>& v : data_.vertices) {
    lower_ = lower_.cwiseMin(v);
    upper_ = upper_.cwiseMax(v);
  }
  for (const W a : areas) vertex_areas_.push_back(static_cast<S>(a));
  for (const Vec3<W>& a : vector_areas) vertex_vector_areas_.push_back(a.template cast<S>());
  // Where the triangles cancel, as at the tip of a flat spike, no direction is better than another.
  for (const Vec3<W>& n : normals)
    vertex_normals_.push_back(unit_or<W>(n, Vec3<W>::UnitX()).template cast<S>());
}

}  // namespace palpate
