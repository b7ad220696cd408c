// SPDX-License-Identifier: MIT
#pragma once

/// @file What bonds a wide patch: its spread, shear and bending are kept at zero, not its mean alone. Per
/// tick.
///
/// Over a patch that is wide for its body, w would spread, shear and bend the surface. Five more loads
/// prevent it: a radial force dipole, two shear dipoles, two bending couples, each with the flat punch's
/// weight times the distance from its centre. Their strengths y are those for which the patch's own moments
/// vanish (Ritz: the energy of all loads is least):
///
///     y = D^-1 (slope of the tool - G P - W M),   D = D_near + W,   C -> C - G^T D^-1 G
///
/// | symbol | name                                                                     | unit         |
/// |--------|--------------------------------------------------------------------------|--------------|
/// | P, M   | force / mu; loads that the contact has anyway (SecondOrderContact) / mu  | m^2, m^3     |
/// | G, W   | moments of w over the patch by unit forces and by unit moments, times mu | 1/m^2, 1/m^3 |
/// | D_near | the half-space's: 3 (1-nu)/(16 a^3), 3 (2-nu)/(32 a^3), 3 (1-nu)/(8 a^3) | 1/m^3        |
///
/// A patch narrower than an edge of the boundary element mesh has none of these loads, a patch of one and a
/// half edges has all of them, in between a share. The loads for the slopes of w replace the rest
/// (linear_loads.hpp). The share falls with the part of the patch that lies on the fixed region, to 0 at
/// half. A contact alone has its share in full; it falls as others come in (ContactSystem::activate), because
/// of what several contacts do to each other's moments only the slopes are known. Nothing is fitted.
/// docs/response_field.md, "Bonded patches".

#include <palpate/core/cholesky.hpp>
#include <palpate/response/response_field.hpp>
#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/constants.hpp>

namespace palpate::detail {

using Moments = Eigen::Matrix<double, 5, 1>;
using MomentsByForce = Eigen::Matrix<double, 5, 3>;
using MomentMatrix = Eigen::Matrix<double, 5, 5>;

struct PatchMoments {
  double share = 0;  ///< 0: narrow, the rest is not set
  Vec3<double> t1, t2, m;
  MomentsByForce G;
  MomentMatrix W, stiffness;  ///< stiffness: share D^-1

  /// Share of a patch of radius a, by the length `size` of the mesh's edges around it.
  [[nodiscard]] static double share_of(double a, double size) noexcept {
    return smooth_step((a / size - tick::narrow_patch) / (tick::wide_patch - tick::narrow_patch));
  }

  /// Reads G and W of a patch of radius a at a position of the load mesh. `counts`: factor of w; `dipole`:
  /// that of a unit normal force (bonded_dipole); `part`: share that the moments have.
  void read(const ResponseField& field, const LoadPosition& position, const PatchTable::Level& level,
            const Vec3<double>& inward, double a, double counts, double dipole, double part) noexcept {
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

  /// What the moments take from a compliance whose trace is `whole`, G^T D^-1 G. In theory less than all of
  /// it; where the mesh does not resolve w, half of it: by (1 + r^4)^(-1/4), r the part over a half.
  [[nodiscard]] Mat3<double> take(double whole) noexcept {
    const MomentsByForce by_force = stiffness * G;
    const Mat3<double> all = G.transpose() * by_force;
    const double r = 2 * all.trace() / whole, r2 = r * r, r4 = r2 * r2,
                 less = 1 / std::sqrt(std::sqrt(1 + r4));
    stiffness *= less;
    share *= less;
    return less * all;
  }

  /// Moments of w by a contact's dipole and couple.
  [[nodiscard]] Moments of_loads(double dipole, const Vec3<double>& couple) const noexcept {
    Moments loads;
    loads << dipole, 0, 0, couple.dot(t1), couple.dot(t2);
    return W * loads;
  }
  /// Moments of a patch whose normal displacement has a slope.
  [[nodiscard]] Moments of_slope(const Vec3<double>& slope) const noexcept {
    Moments out;
    out << 0, 0, 0, slope.dot(t1), slope.dot(t2);
    return out;
  }
  /// y for a tool's slope, a force and loads that the contact has anyway.
  [[nodiscard]] Moments bonding(const Vec3<double>& slope, const Vec3<double>& P, double dipole,
                                const Vec3<double>& couple) const noexcept {
    return stiffness * (of_slope(slope) - G * P - of_loads(dipole, couple));
  }
  /// Loads as a tensor A: a node's force is A q (moment_loads.hpp).
  [[nodiscard]] Mat3<double> tensor(const Moments& y) const noexcept {
    return y[0] * Mat3<double>::Identity() + shear(y) + 2 * m * couple(y).transpose();
  }
  [[nodiscard]] Mat3<double> shear(const Moments& y) const noexcept {
    const Mat3<double> across = t1 * t2.transpose();
    return y[1] * (t1 * t1.transpose() - t2 * t2.transpose()) + y[2] * (across + across.transpose());
  }
  [[nodiscard]] Vec3<double> couple(const Moments& y) const noexcept { return y[3] * t1 + y[4] * t2; }

 private:
  // Adds the moments of node i of the position, rotated from the node's axes into the patch's by the least
  // rotation of one plane into the other; between opposite normals, where there is none, nothing is left.
  void add_node(const ResponseField& field, const LoadPosition& position, const PatchTable::Level& level,
                std::size_t i, double counts) noexcept {
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
    rotate(mean, c, s);
    rotate(own, c, s);
    own.transposeInPlace();
    rotate(own, c, s);
    G += mean;
    W += own;
  }
  // Rows of a node's loads to those of the patch, whose axes are rotated by the angle of cosine c and sine s:
  // shears by twice the angle, couples by the angle.
  template <class M>
  static void rotate(M& rows, double c, double s) noexcept {
    const double c2 = c * c - s * s, s2 = 2 * c * s;
    for (Eigen::Index j = 0; j < rows.cols(); ++j) {
      const double shear = rows(1, j), couple = rows(3, j);
      rows(1, j) = c2 * shear + s2 * rows(2, j);
      rows(2, j) = c2 * rows(2, j) - s2 * shear;
      rows(3, j) = c * couple + s * rows(4, j);
      rows(4, j) = c * rows(4, j) - s * couple;
    }
  }
  // `stiffness`; W, too, where D has an eigenvalue below a tenth. In units in which D_near is the unit
  // matrix.
  void invert(double nu, double a) noexcept {
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
};

}  // namespace palpate::detail
