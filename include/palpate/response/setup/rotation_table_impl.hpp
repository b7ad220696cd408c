// SPDX-License-Identifier: MIT
#pragma once

/// @file Set-up of rotation_table.hpp: the fit of du/dt_i at every vertex. Set-up only.

#include <palpate/core/cholesky.hpp>
#include <palpate/response/setup/constants.hpp>
#include <palpate/response/setup/mesh_edges.hpp>
#include <palpate/response/tick/rotation_table.hpp>

namespace palpate {

PALPATE_COMPILED_INLINE RotationTable::RotationTable(const ElementMesh& mesh, std::size_t stride) {
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
      const Vec3<double> up = unit_or(normal[v], Vec3<double>(Vec3<double>::UnitY())), t1 = perpendicular(up);
      const std::array<Vec3<double>, 3> axes{t1, up.cross(t1), up};
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < 3; ++i)
          frame_[(3 * a + i) * stride + v] = static_cast<float>(axes[a][Eigen::Index(i)]);
      fit(mesh, static_cast<std::uint32_t>(v), ring[v], axes);
    }
    begin_.push_back(static_cast<std::uint32_t>(weights_.size()));
  }
}

PALPATE_COMPILED_INLINE void RotationTable::fit(const ElementMesh& mesh, std::uint32_t v,
                                                const std::vector<std::uint32_t>& ring,
                                                const std::array<Vec3<double>, 3>& axes) {
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
  const double slopes = A.at(0, 0) + A.at(1, 1) + detail::setup::no_weight;
  for (std::size_t r = 0; r < 3; ++r)
    A.at(r, r) += (r < 2 ? detail::setup::tangent_penalty : detail::setup::normal_penalty) * slopes;
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

}  // namespace palpate
