// SPDX-License-Identifier: MIT
#pragma once

/// @file  A triangle mesh that has been checked: closed, oriented, finite, every triangle with area.

#include <palpate/geometry/mesh_report.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace palpate {

/// Closed triangle mesh of a tool or an object, with what follows from it. No equation: elementary geometry.
///
/// | name                   | unit | what                                                              |
/// |------------------------|------|-------------------------------------------------------------------|
/// | `vertex_areas()`       | m^2  | a third of the adjacent triangles' area each; they sum to `area()` |
/// | `vertex_vector_areas()` | m^2 | a third of the adjacent triangles' outward area vectors each: sum 0 |
/// | `vertex_normals()`     | -    | outward, unit, weighted by the angle at the vertex [thurmer1998]   |
/// | `area()`, `volume()`   | m^2, m^3 | of the surface and of what it encloses                         |
/// | `centroid()`           | m    | of what it encloses: the centre of mass of a homogeneous body     |
/// | `lower()`, `upper()`   | m    | bounding box                                                      |
///
/// The constructor reports the first defect that `inspect()` finds: what, how many, where, and how to mend
/// it. Several closed parts and cavities are allowed; self-intersection is not looked for.
template <Real S>
class TriangleMesh {
 public:
  using Scalar = S;

  explicit TriangleMesh(MeshData<S> data);

  [[nodiscard]] const MeshData<S>& data() const noexcept { return data_; }
  [[nodiscard]] const std::vector<Vec3<S>>& vertices() const noexcept { return data_.vertices; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const noexcept {
    return data_.triangles;
  }
  [[nodiscard]] const std::vector<S>& vertex_areas() const noexcept { return vertex_areas_; }
  [[nodiscard]] const std::vector<Vec3<S>>& vertex_vector_areas() const noexcept {
    return vertex_vector_areas_;
  }
  [[nodiscard]] const std::vector<Vec3<S>>& vertex_normals() const noexcept { return vertex_normals_; }
  [[nodiscard]] S area() const noexcept { return area_; }
  [[nodiscard]] S volume() const noexcept { return volume_; }
  [[nodiscard]] Vec3<S> centroid() const noexcept { return centroid_; }
  [[nodiscard]] Vec3<S> lower() const noexcept { return lower_; }
  [[nodiscard]] Vec3<S> upper() const noexcept { return upper_; }

 private:
  void measure();

  MeshData<S> data_;
  std::vector<S> vertex_areas_;
  std::vector<Vec3<S>> vertex_vector_areas_, vertex_normals_;
  S area_{}, volume_{};
  Vec3<S> centroid_, lower_, upper_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/geometry/setup/triangle_mesh_impl.hpp>
#endif
