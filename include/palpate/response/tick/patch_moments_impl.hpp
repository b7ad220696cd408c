// SPDX-License-Identifier: MIT
#pragma once

/// @file What bonds a wide patch (patch_moments.hpp), the functions of it.

#include <palpate/core/cholesky.hpp>
#include <palpate/response/tick/patch_moments.hpp>

namespace palpate::detail {

PALPATE_COMPILED_INLINE void PatchMoments::read(const ResponseField& field, const LoadPosition& position,
                                                const PatchTable::Level& level, const Vec3<double>& inward,
                                                double a, double counts, double dipole,
                                                double part) noexcept {
  share = part;
  m = inward;
  t1 = perpendicular(Vec3<double>(-m));
  t2 = t1.cross(m);
  G.setZero();
  W.setZero();
  for (std::size_t i = 0; i < 3; ++i) add_node(field, position, level, i, counts);
  // For nu < 1/2 a force has a dipole and a couple of its own.
  for (int r = 0; r < 5; ++r)
    for (int j = 0; j < 3; ++j)
      G(r, j) += dipole * (W(r, 0) * m[j] - 0.5 * (W(r, 3) * t1[j] + W(r, 4) * t2[j]));
  invert(field.nu(), a);
}

PALPATE_COMPILED_INLINE Mat3<double> PatchMoments::take(double whole) noexcept {
  const MomentsByForce by_force = stiffness * G;
  const Mat3<double> all = G.transpose() * by_force;
  const double r = 2 * all.trace() / whole, r2 = r * r, r4 = r2 * r2, less = 1 / std::sqrt(std::sqrt(1 + r4));
  stiffness *= less;
  share *= less;
  return less * all;
}

PALPATE_COMPILED_INLINE Moments PatchMoments::of_loads(double dipole,
                                                       const Vec3<double>& couple) const noexcept {
  Moments loads;
  loads << dipole, 0, 0, couple.dot(t1), couple.dot(t2);
  return W * loads;
}
PALPATE_COMPILED_INLINE Moments PatchMoments::of_slope(const Vec3<double>& slope) const noexcept {
  Moments out;
  out << 0, 0, 0, slope.dot(t1), slope.dot(t2);
  return out;
}
PALPATE_COMPILED_INLINE Moments PatchMoments::bonding(const Vec3<double>& slope, const Vec3<double>& P,
                                                      double dipole,
                                                      const Vec3<double>& couple) const noexcept {
  return stiffness * (of_slope(slope) - G * P - of_loads(dipole, couple));
}
PALPATE_COMPILED_INLINE Mat3<double> PatchMoments::tensor(const Moments& y) const noexcept {
  return y[0] * Mat3<double>::Identity() + shear(y) + 2 * m * couple(y).transpose();
}
PALPATE_COMPILED_INLINE Mat3<double> PatchMoments::shear(const Moments& y) const noexcept {
  const Mat3<double> across = t1 * t2.transpose();
  return y[1] * (t1 * t1.transpose() - t2 * t2.transpose()) + y[2] * (across + across.transpose());
}

// Rows of a node's loads to those of the patch, whose axes are rotated by the angle of cosine c and sine s:
// shears by twice the angle, couples by the angle.
template <class M>
void rotate_moments(M& rows, double c, double s) noexcept {
  const double c2 = c * c - s * s, s2 = 2 * c * s;
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    const double shear = rows(1, j), couple = rows(3, j);
    rows(1, j) = c2 * shear + s2 * rows(2, j);
    rows(2, j) = c2 * rows(2, j) - s2 * shear;
    rows(3, j) = c * couple + s * rows(4, j);
    rows(4, j) = c * rows(4, j) - s * couple;
  }
}

// Adds the moments of node i of the position, rotated from the node's axes into the patch's by the least
// rotation of one plane into the other; between opposite normals, where there is none, nothing is left.
PALPATE_COMPILED_INLINE void PatchMoments::add_node(const ResponseField& field, const LoadPosition& position,
                                                    const PatchTable::Level& level, std::size_t i,
                                                    double counts) noexcept {
  const std::size_t k = position.node[i];
  const Vec3<double>& n = field.load_mesh().nodes()[k].normal;
  const Vec3<double> k1 = perpendicular(n), k2 = n.cross(k1);
  const double c = 0.5 * (t1.dot(k1) + t2.dot(k2)), s = 0.5 * (t1.dot(k2) - t2.dot(k1));
  MomentsByForce mean = MomentsByForce::Zero();
  MomentMatrix own = MomentMatrix::Zero();
  for (std::size_t l = 0; l < 2; ++l) {
    const double part = counts * position.weight[Eigen::Index(i)] * (l == 0 ? 1 - level.part : level.part);
    const PatchTable::Moments& row = field.table().moments(k, level.below + l);
    for (int r = 0, e = 0; r < 5; ++r) {
      for (int j = 0; j < 3; ++j) mean(r, j) += part * double(row.mean[r][j]);
      for (int j = 0; j <= r; ++j) own(r, j) += part * double(row.own[e++]);
    }
  }
  for (int r = 0; r < 5; ++r)
    for (int j = 0; j < r; ++j) own(j, r) = own(r, j);
  rotate_moments(mean, c, s);
  rotate_moments(own, c, s);
  own.transposeInPlace();
  rotate_moments(own, c, s);
  G += mean;
  W += own;
}
// `stiffness`; W, too, where D has an eigenvalue below a tenth. In units in which D_near is the unit
// matrix.
PALPATE_COMPILED_INLINE void PatchMoments::invert(double nu, double a) noexcept {
  const double unit = 3 / (32 * a * a * a);
  Moments root;  // of 1 / D_near
  root << 2 * (1 - nu), 2 - nu, 2 - nu, 4 * (1 - nu), 4 * (1 - nu);
  for (int r = 0; r < 5; ++r) root[r] = 1 / std::sqrt(unit * root[r]);
  MomentMatrix D;
  SpdSystem<5> system{};
  const auto fill = [&system, &D] {
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c <= r; ++c) system.at(std::size_t(r), std::size_t(c)) = D(r, c);
  };
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c) D(r, c) = root[r] * W(r, c) * root[c] + (r == c ? 1 : 0);
  fill();
  SpdSystem<5> less = system;
  for (std::size_t r = 0; r < 5; ++r) less.at(r, r) -= tick::min_moment_compliance;
  if (!less.factor(5)) {
    bound_below(D, tick::min_moment_compliance);
    for (int r = 0; r < 5; ++r)
      for (int c = 0; c < 5; ++c) W(r, c) = (D(r, c) - (r == c ? 1 : 0)) / (root[r] * root[c]);
    fill();
  }
  stiffness.setZero();
  if (!system.factor(5)) return;
  for (int c = 0; c < 5; ++c) {
    system.b.fill(0);
    system.b[std::size_t(c)] = share * root[c];
    system.substitute(5);
    for (int r = 0; r < 5; ++r) stiffness(r, c) = root[r] * system.b[std::size_t(r)];
  }
}

}  // namespace palpate::detail
