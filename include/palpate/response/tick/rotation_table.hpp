// SPDX-License-Identifier: MIT
#pragma once

/// @file Rotation of a body's surface, half the curl of u, from u at the solve mesh's vertices. The table is
/// made at set-up.
///
/// Without traction the normal derivative of u along the surface is minus the slope of its normal part, so u
/// on the surface tells all of it: the slopes s_i = n . du/dt_i turn the normal n, the curl in the surface
/// turns about it:
///     omega = s_2 t_1 - s_1 t_2 + 1/2 (t_2 . du/dt_1 - t_1 . du/dt_2) n ,   t_1 x t_2 = n
/// du/dt_i: the linear field that fits u best at a vertex's neighbours, in space, so that a rotation of the
/// body is exact on an edge of it, too; the normal derivative, which smooth neighbours hardly tell, is held
/// by a small penalty.

#include <palpate/core/cholesky.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/response/setup/element_mesh.hpp>

namespace palpate {

class RotationTable {
 public:
  struct Weight {
    std::uint32_t vertex;
    float along[2];  ///< du/dt_i = sum along[i] u(vertex) [1/m]
  };

  RotationTable() = default;
  /// `stride`: vertices, rounded up to whole lanes.
  RotationTable(const SolveMesh& mesh, std::size_t stride) {
    const std::size_t n = mesh.vertices.size();
    std::vector<std::vector<std::uint32_t>> ring(n);
    std::vector<Vec3<double>> normal(n, Vec3<double>::Zero());
    for (const auto& t : mesh.triangles) {
      const Vec3<double>& x = mesh.vertices[t[0]];
      const Vec3<double> area = (mesh.vertices[t[1]] - x).cross(mesh.vertices[t[2]] - x);
      for (std::size_t c = 0; c < 3; ++c) {
        normal[t[c]] += area;
        detail::add_once(ring[t[c]], t[(c + 1) % 3]);
        detail::add_once(ring[t[c]], t[(c + 2) % 3]);
      }
    }
    frame_.assign(9 * stride, 0.f);
    for (std::size_t v = 0; v < stride; ++v) {
      if (v < n && !mesh.fixed_vertex[v]) {
        const Vec3<double> up = unit_or(normal[v], Vec3<double>(Vec3<double>::UnitY())),
                           t1 = perpendicular(up);
        const std::array<Vec3<double>, 3> axes{t1, up.cross(t1), up};
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t i = 0; i < 3; ++i)
            frame_[(3 * a + i) * stride + v] = static_cast<float>(axes[a][Eigen::Index(i)]);
        fit(mesh, static_cast<std::uint32_t>(v), ring[v], axes);
      }
      begin_.push_back(static_cast<std::uint32_t>(weights_.size()));
    }
  }

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
  void fit(const SolveMesh& mesh, std::uint32_t v, const std::vector<std::uint32_t>& ring,
           const std::array<Vec3<double>, 3>& axes) {
    constexpr double penalty = 0.01;
    const auto direction = [&](std::uint32_t j) -> Vec3<double> {
      const Vec3<double> d = mesh.vertices[j] - mesh.vertices[v];
      return Vec3<double>(axes[0].dot(d), axes[1].dot(d), axes[2].dot(d)) / d.norm();
    };
    detail::SpdSystem<3> A{};
    for (auto j : ring) {
      const Vec3<double> d = direction(j);
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c <= r; ++c) A.at(r, c) += d[Eigen::Index(r)] * d[Eigen::Index(c)];
    }
    const double slopes = A.at(0, 0) + A.at(1, 1) + 1e-30;
    for (std::size_t r = 0; r < 3; ++r) A.at(r, r) += (r < 2 ? 1e-6 : penalty) * slopes;
    if (!A.factor(3)) fail_at("RotationTable", "neighbours must be finite", "vertex", v);
    double own[2] = {0, 0};
    for (auto j : ring) {
      const Vec3<double> d = direction(j);
      const double distance = (mesh.vertices[j] - mesh.vertices[v]).norm();
      for (std::size_t r = 0; r < 3; ++r) A.b[r] = d[Eigen::Index(r)];
      A.substitute(3);
      Weight w{j, {}};
      for (std::size_t i = 0; i < 2; ++i) {
        w.along[i] = static_cast<float>(A.b[i] / distance);
        own[i] -= A.b[i] / distance;
      }
      weights_.push_back(w);
    }
    weights_.push_back({v, {static_cast<float>(own[0]), static_cast<float>(own[1])}});
  }

  std::vector<std::uint32_t> begin_{0};
  std::vector<Weight> weights_;
  std::vector<float> frame_;
};

}  // namespace palpate
