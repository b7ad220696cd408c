// SPDX-License-Identifier: MIT
#pragma once

/// @file A mesh's surface with its curvature, smoothed over about a tool's contact. Set-up and drawing.

#include <palpate/geometry/mesh_surface.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate::detail {

/// Closest points and curvature of a mesh; the box is larger than the mesh's by `margin`, for maps of laws
/// that are asked beside the mesh. Both principal curvatures are the mean one: only their sum counts.
class CurvedSurface {
 public:
  using Scalar = double;

  /// `mean`: mean curvature at every vertex [1/m].
  CurvedSurface(std::shared_ptr<const MeshSurface<double>> surface, std::vector<double> mean, double margin)
      : surface_(std::move(surface)),
        mean_(std::make_shared<const std::vector<double>>(std::move(mean))),
        margin_(margin) {}

  [[nodiscard]] SurfacePoint<double> closest(const Vec3<double>& x) const noexcept {
    return surface_->closest(x);
  }
  [[nodiscard]] Curvature<double> curvature(const Vec3<double>& x) const noexcept {
    const auto near = surface_->bvh().closest(x);
    double mean = 0;
    for (std::size_t k = 0; k < 3; ++k)
      mean +=
          near.weight[static_cast<Eigen::Index>(k)] * (*mean_)[surface_->bvh().triangles()[near.triangle][k]];
    const Vec3<double> n = surface_->closest(x).normal, along = perpendicular<double>(n);
    return {mean, mean, along, n.cross(along)};
  }
  [[nodiscard]] double reach() const noexcept { return surface_->reach(); }
  [[nodiscard]] Vec3<double> lower() const noexcept {
    return surface_->lower() - Vec3<double>::Constant(margin_);
  }
  [[nodiscard]] Vec3<double> upper() const noexcept {
    return surface_->upper() + Vec3<double>::Constant(margin_);
  }

 private:
  std::shared_ptr<const MeshSurface<double>> surface_;
  std::shared_ptr<const std::vector<double>> mean_;
  double margin_;
};

}  // namespace palpate::detail
