// SPDX-License-Identifier: MIT
#pragma once

/// @file Second derivatives along a surface from values at scattered positions, and what linear interpolation
/// between these positions is off by in the mean. Set-up only.

#include <palpate/core/cholesky.hpp>
#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/response/setup/constants.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate::detail {

/// A position that values are known at, seen from another.
struct Neighbour {
  std::uint32_t id;
  Vec3<double> offset;  ///< [m]
  double facing;        ///< cosine of the angle between the normals
};
/// A neighbour's part of the second derivatives: K = sum by (u - u_0), u_0 the value they are seen from.
struct SecondDerivative {
  std::uint32_t id;
  Vec3<double> by;  ///< 11, 12, 22 along the surface's tangents [1/m^2]
};
/// The tangents that second derivatives at a position refer to.
struct Tangents {
  Vec3<double> t1, t2;
  explicit Tangents(const Vec3<double>& normal) : t1(perpendicular(normal)), t2(normal.cross(t1)) {}
  /// e^T K e = squares(e) . K.
  [[nodiscard]] Vec3<double> squares(const Vec3<double>& e) const noexcept {
    const double p = e.dot(t1), q = e.dot(t2);
    return {p * p, 2 * p * q, q * q};
  }
};

/// The quadratic that fits best: least squares with the weight facing/d^2, with penalties where the
/// neighbours do not determine it. Those round a corner are left out. `size`: their usual distance [m].
[[nodiscard]] inline std::vector<SecondDerivative> fit_second_derivatives(
    const Vec3<double>& normal, double size, const std::vector<Neighbour>& near) {
  struct Row {  // one neighbour's: its value less the own is by . (slopes, second derivatives)
    std::uint32_t id;
    double weight;
    std::array<double, 5> by;
  };
  const Tangents tangents(normal);
  SpdSystem<5> A{};
  std::vector<Row> rows;
  for (const Neighbour& n : near) {
    if (n.facing < setup::curvature_cosine) continue;
    const Vec3<double> d = n.offset / size, square = tangents.squares(d);
    const double w = n.facing / d.squaredNorm();
    const Row row{
        n.id, w * w, {d.dot(tangents.t1), d.dot(tangents.t2), square[0] / 2, square[1] / 2, square[2] / 2}};
    for (std::size_t r = 0; r < 5; ++r)
      for (std::size_t c = 0; c <= r; ++c) A.at(r, c) += row.weight * row.by[r] * row.by[c];
    rows.push_back(row);
  }
  const double slopes = A.at(0, 0) + A.at(1, 1) + setup::no_weight;
  for (std::size_t r = 0; r < 5; ++r)
    A.at(r, r) += (r < 2 ? setup::slope_penalty : setup::curvature_penalty) * slopes;
  if (!A.factor(5)) fail("fit_second_derivatives", "neighbours must be finite");
  std::vector<SecondDerivative> out;
  for (const Row& row : rows) {
    for (std::size_t r = 0; r < 5; ++r) A.b[r] = row.weight * row.by[r];
    A.substitute(5);
    out.push_back({row.id, Vec3<double>(A.b[2], A.b[3], A.b[4]) / (size * size)});
  }
  return out;
}

/// Adds what corner c of a triangle has of the mean error of linear interpolation: with second derivatives K
/// there, integral += by . K of the values that are missing, phi_c 4 phi_p phi_q b_pq by edge pq, and of
/// phi_c: mass.
inline void add_mean_error(const std::array<Vec3<double>, 3>& triangle, std::size_t c,
                           const Tangents& tangents, Vec3<double>& by, double& mass) {
  const auto edge = [&triangle](std::size_t k) -> Vec3<double> {
    return triangle[(k + 1) % 3] - triangle[k];
  };
  const double area = 0.5 * edge(0).cross(edge(1)).norm();
  for (std::size_t k = 0; k < 3; ++k)
    by -= 0.125 * (k == (c + 1) % 3 ? 1 : 2) * area / 15 * tangents.squares(edge(k));
  mass += area / 3;
}

}  // namespace palpate::detail
