// SPDX-License-Identifier: MIT
#pragma once

/// @file  A triangle mesh that has been checked: closed, oriented, finite, every triangle with area.

#include <palpate/core/error.hpp>
#include <palpate/geometry/mesh_report.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <utility>

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

  explicit TriangleMesh(MeshData<S> data) : data_(std::move(data)) {
    const MeshReport report = inspect(data_);
    for (std::size_t d = 0; d < mesh_defect_count; ++d) {
      if (report.defects[d].count > 0)
        fail("TriangleMesh", describe(report, static_cast<MeshDefect>(d)).text);
    }
    measure();
  }

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
  // Sums in double relative to the first vertex, so that a body far from its origin keeps its digits.
  void measure() {
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

  MeshData<S> data_;
  std::vector<S> vertex_areas_;
  std::vector<Vec3<S>> vertex_vector_areas_, vertex_normals_;
  S area_{}, volume_{};
  Vec3<S> centroid_, lower_, upper_;
};

}  // namespace palpate
