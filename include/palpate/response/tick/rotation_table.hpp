// SPDX-License-Identifier: MIT
#pragma once

/// @file Rotation of a body's surface, half the curl of u, from u at the boundary element mesh's vertices.
/// The table is made at set-up.
///
/// Without traction the normal derivative of u along the surface is minus the slope of its normal part, so u
/// on the surface determines the rotation: the slopes s_i = n . du/dt_i rotate the normal n, the curl in the
/// surface rotates about it:
///     omega = s_2 t_1 - s_1 t_2 + 1/2 (t_2 . du/dt_1 - t_1 . du/dt_2) n ,   t_1 x t_2 = n
/// du/dt_i: the linear field that fits u best at a vertex's neighbours, in space, so that a rotation of the
/// body is exact on an edge of it, too. Neighbours on a smooth surface hardly determine the normal
/// derivative; a small penalty keeps it bounded.

#include <palpate/config.hpp>
#include <palpate/response/setup/element_mesh.hpp>

#include <span>

namespace palpate {

class RotationTable {
 public:
  struct Weight {
    std::uint32_t vertex;
    float along[2];  ///< du/dt_i = sum along[i] u(vertex) [1/m]
  };

  RotationTable() = default;
  /// `stride`: vertices, rounded up to whole SIMD registers.
  RotationTable(const ElementMesh& mesh, std::size_t stride);

  /// Empty where a vertex is fixed or beyond the last.
  [[nodiscard]] std::span<const Weight> operator[](std::size_t v) const noexcept {
    return {weights_.data() + begin_[v], begin_[v + 1] - begin_[v]};
  }
  /// t_1, t_2, n: coordinate i of axis a at every vertex.
  [[nodiscard]] const float* frame(std::size_t a, std::size_t i) const noexcept {
    return &frame_[(3 * a + i) * (begin_.size() - 1)];
  }
  [[nodiscard]] std::size_t memory() const noexcept {
    return begin_.size() * sizeof(begin_[0]) + weights_.size() * sizeof(Weight) +
           frame_.size() * sizeof(float);
  }

 private:
  void fit(const ElementMesh& mesh, std::uint32_t v, const std::vector<std::uint32_t>& ring,
           const std::array<Vec3<double>, 3>& axes);

  std::vector<std::uint32_t> begin_{0};
  std::vector<Weight> weights_;
  std::vector<float> frame_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/rotation_table_impl.hpp>
#endif
