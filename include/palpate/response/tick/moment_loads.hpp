// SPDX-License-Identifier: MIT
#pragma once

/// @file Force dipoles and couples that are spread over a patch, and the regular part of their fields; for
/// the patch table.
///
/// | number | load of unit moment on the flat punch's weight, p from its centre         | tensor A |
/// |--------|---------------------------------------------------------------------------|----------|
/// | 0      | radial force dipole, sum p.f = 1                                          | I        |
/// | 1, 2   | shear dipoles s = t1 t1 - t2 t2, t1 t2 + t2 t1, moment sum f p^T = s / 2  | s        |
/// | 3, 4   | bending couples along t1, t2, m the inward normal, sum p (f.m) = t        | 2 m t^T  |
/// t1 = perpendicular(normal), t2 = normal x t1. A node of weight g at p has the force A q, q = g p / sum g
/// p^2, less where part of the patch is fixed: none from half on.

#include <palpate/response/setup/constants.hpp>
#include <palpate/response/tick/load_mesh.hpp>

namespace palpate {

/// Of a patch around a node, mu = 1.
struct MomentRow {
  float mean[5][3] = {};   ///< means of the loads' fields w [1/m^2]
  float own[15] = {};      ///< their moments, lower triangle by row [1/m^3]
  float sagitta = 0;       ///< how deep the patch's edge lies below its plane, at most [m]
  float mean_sagitta = 0;  ///< in the mean [m]
};

namespace detail {

/// each(node, q) of the nodes that share a load around node k; none where they are one position.
template <class Each>
void each_moment(const LoadMesh& load_mesh, std::size_t k, std::span<const LoadMesh::Share> shares,
                 const Each& each) noexcept {
  const LoadNode& node = load_mesh.nodes()[k];
  const auto offset = [&](const LoadMesh::Share& s) {
    return tangential(Vec3<double>(load_mesh.nodes()[s.node].source - node.source), node.normal);
  };
  double sum = 0, square = 0;
  Vec3<double> first = Vec3<double>::Zero();
  for (const LoadMesh::Share& s : shares) {
    const Vec3<double> p = offset(s);
    sum += double(s.weight);
    first += double(s.weight) * p;
    square += double(s.weight) * p.squaredNorm();
  }
  square -= first.squaredNorm() / (std::max)(sum, setup::min_weight);
  if (!(square > setup::min_second_moment * node.spacing * node.spacing)) return;
  const Vec3<double> centre = first / sum;
  const double t = std::clamp(2 * sum - 1, 0.0, 1.0), unit = t * t * (3 - 2 * t) / square;
  for (const LoadMesh::Share& s : shares)
    each(s.node, Vec3<double>(double(s.weight) * unit * (offset(s) - centre)));
}

}  // namespace detail
}  // namespace palpate
