// SPDX-License-Identifier: MIT
#pragma once

/// @file Statics of nearly incompressible neo-Hookean rubber at any displacement, by finite elements: what
/// references are made with.
///
/// W = mu/2 (J^(-2/3) tr C - 3) + ks/4 (J^2 - 1 - 2 ln J) + (K - ks)/2 (J - 1)^2, ks = 10 mu, or K where that
/// is less; the last term through a continuous linear pressure (Taylor and Hood's ten-node tetrahedra). Total
/// Lagrangian, full Newton, MUMPS. Shares no code with the library.

#include "truth/tetrahedra.hpp"

#include <dmumps_c.h>
#include <Eigen/Dense>

#include <cmath>
#include <memory>
#include <vector>

namespace bench {

/// Symmetric indefinite sparse equations by MUMPS; entries of the lower triangle, repeated ones add up.
class SymmetricEquations {
 public:
  SymmetricEquations(int n, std::vector<int> rows, std::vector<int> columns)
      : rows_(std::move(rows)), columns_(std::move(columns)) {
    id_.par = 1;
    id_.sym = 2;
    id_.comm_fortran = -987654;
    call(-1);
    for (int k : {0, 1, 2}) id_.icntl[k] = -1;  // prints nothing
    id_.icntl[13] = 60;                         // percent of room more than it estimates, for pivots
    id_.n = n;
    id_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    id_.irn = rows_.data();
    id_.jcn = columns_.data();
    call(1);
  }
  SymmetricEquations(const SymmetricEquations&) = delete;
  SymmetricEquations& operator=(const SymmetricEquations&) = delete;
  ~SymmetricEquations() {
    id_.job = -2;
    dmumps_c(&id_);
  }
  /// Replaces `b` by the solution.
  void solve(std::vector<double>& values, Eigen::VectorXd& b) {
    id_.a = values.data();
    call(2);
    id_.rhs = b.data();
    call(3);
  }

 private:
  void call(int job) {
    id_.job = job;
    dmumps_c(&id_);
    if (id_.infog[0] < 0)
      throw std::runtime_error("MUMPS: error " + std::to_string(id_.infog[0]) + " in job " +
                               std::to_string(job));
  }
  DMUMPS_STRUC_C id_{};
  std::vector<int> rows_, columns_;
};

/// A rigid frictionless sphere that faces of the body (six nodes each) may not enter: a penalty holds them
/// out.
struct RigidSphere {
  V centre;
  double radius = 0, penalty = 0;  ///< [mm], [MPa/mm]
  std::vector<std::array<int, 6>> faces;
};

/// A body some of whose displacements are prescribed. Unknowns: three displacements [mm] per node, then a
/// pressure [MPa] per corner.
class Rubber {
 public:
  /// `prescribed(node, axis)`: is this displacement given, not sought?
  template <class Prescribed>
  Rubber(const Tetrahedra& mesh, double E, double nu, Prescribed prescribed)
      : mesh_(mesh), mu_(E / 2 / (1 + nu)), K_(E / 3 / (1 - 2 * nu)), ks_((std::min)(10 * mu_, 0.99 * K_)) {
    const int nodes = static_cast<int>(mesh.nodes.size());
    std::vector<int> pressure(mesh.nodes.size(), -1);
    int count = 3 * nodes;
    for (const auto& e : mesh.elements)
      for (int c = 0; c < 4; ++c)
        if (pressure[e[c]] < 0) pressure[e[c]] = count++;
    equation_.assign(count, -1);
    for (int i = 0; i < count; ++i)
      if (i >= 3 * nodes || !prescribed(i / 3, i % 3)) equation_[i] = equations_++;
    x_ = Eigen::VectorXd::Zero(count);
    unknowns_.resize(mesh.elements.size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
      for (int n = 0; n < 10; ++n)
        for (int k = 0; k < 3; ++k) unknowns_[e][3 * n + k] = 3 * mesh.elements[e][n] + k;
      for (int c = 0; c < 4; ++c) unknowns_[e][30 + c] = pressure[mesh.elements[e][c]];
    }
    set_gradients();
  }

  const Eigen::VectorXd& state() const { return x_; }
  /// Forces that hold the state [N], by unknown, as of the last step.
  const Eigen::VectorXd& forces() const { return force_; }
  int equations() const { return equations_; }

  /// Moves the prescribed displacements by those of `increment` and finds equilibrium. False, and nothing
  /// changed, where Newton's method does not get there. `linear`: one step from rest, small strain.
  bool step(const Eigen::VectorXd& increment, bool linear = false) {
    const Eigen::VectorXd before = x_;
    const double size = increment.cwiseAbs().maxCoeff();
    double last = 1e300;
    for (int iteration = 0; iteration < 15; ++iteration) {
      const double largest = newton_step(iteration == 0 ? &increment : nullptr);
      if (largest < 0) break;
      if (linear) {
        set_linear_forces(before);
        return true;
      }
      if (iteration > 2 && largest > 3 * last) break;
      last = largest;
      if (largest < 1e-7 * size) {
        Eigen::VectorXd b;
        assemble(nullptr, b);
        return true;
      }
    }
    x_ = before;
    return false;
  }
  /// Finds equilibrium with a sphere, first from `guess`, then from the state by softer penalties. False, and
  /// nothing changed, where neither gets there. Faces are those of the first call.
  bool settle(const RigidSphere& sphere, const Eigen::VectorXd& guess) {
    const Eigen::VectorXd before = x_;
    sphere_ = sphere;
    x_ = guess;
    if (settle_once(1e-7, 12)) return true;
    x_ = before;
    for (double share : {0.03, 0.2, 1.0}) {
      sphere_.penalty = share * sphere.penalty;
      if (settle_once(share < 1 ? 1e-3 : 1e-7, 25)) continue;
      x_ = before;
      return false;
    }
    return true;
  }
  /// Force of the sphere on the body [N], as of the last step.
  const V& sphere_force() const { return sphere_force_; }
  /// Back to a state that was one of equilibrium.
  void reset(const Eigen::VectorXd& state) { x_ = state; }
  /// The least J at any integration point of the state.
  double least_volume_ratio() const { return least_J_; }

 private:
  using Matrix34 = Eigen::Matrix<double, 34, 34>;
  using Vector34 = Eigen::Matrix<double, 34, 1>;
  struct Point {
    Eigen::Matrix<double, 10, 3> gradient;  // of the ten functions [1/mm]
    Eigen::Vector4d corner;                 // barycentric coordinates
    double volume;                          // [mm^3]
  };
  static constexpr int points_ = 14;

  void set_gradients() {
    // Fourteen points, exact to the fifth degree.
    constexpr double a[2] = {0.0927352503108912264, 0.3108859192633005},
                     wa[2] = {0.0734930431163619495, 0.112687925718015851};
    constexpr double c = 0.0455037041256496495, wc = 0.0425460207770814664;
    std::array<Eigen::Vector4d, points_> position;
    std::array<double, points_> weight;
    int q = 0;
    for (int k : {0, 1})
      for (int i = 0; i < 4; ++i, ++q) {
        position[q].setConstant(a[k]);
        position[q][i] = 1 - 3 * a[k];
        weight[q] = wa[k];
      }
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j, ++q) {
        position[q].setConstant(0.5 - c);
        position[q][i] = position[q][j] = c;
        weight[q] = wc;
      }
    constexpr int ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {2, 3}, {1, 3}};
    data_.resize(mesh_.elements.size());
    for (std::size_t e = 0; e < data_.size(); ++e)
      for (q = 0; q < points_; ++q) {
        const Eigen::Vector4d& L = position[q];
        Eigen::Matrix<double, 10, 4> by_L = Eigen::Matrix<double, 10, 4>::Zero();
        for (int i = 0; i < 4; ++i) by_L(i, i) = 4 * L[i] - 1;
        for (int m = 0; m < 6; ++m) {
          by_L(4 + m, ends[m][0]) = 4 * L[ends[m][1]];
          by_L(4 + m, ends[m][1]) = 4 * L[ends[m][0]];
        }
        Eigen::Matrix<double, 10, 3> by_xi;
        for (int k = 0; k < 3; ++k) by_xi.col(k) = by_L.col(k + 1) - by_L.col(0);
        Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
        for (int n = 0; n < 10; ++n) jacobian += mesh_.nodes[mesh_.elements[e][n]] * by_xi.row(n);
        const double det = jacobian.determinant();
        if (!(det > 0)) throw std::runtime_error("element " + std::to_string(e) + " is turned inside out");
        data_[e][q] = {by_xi * jacobian.inverse(), L, weight[q] * det / 6};
      }
  }

  // Residual and tangent of one element. False where its volume is not positive.
  bool element(const Eigen::VectorXd& state, std::size_t e, Vector34& r, Matrix34& k) {
    Vector34 x;
    for (int i = 0; i < 34; ++i) x[i] = state[unknowns_[e][i]];
    const Eigen::Map<const Eigen::Matrix<double, 3, 10>> u(x.data());
    r.setZero();
    k.setZero();
    for (const Point& point : data_[e]) {
      const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + u * point.gradient;
      const double J = F.determinant(), p = x.tail<4>().dot(point.corner);
      least_J_ = (std::min)(least_J_, J);
      if (!(J > 0)) return false;
      const Eigen::Matrix3d G = F.inverse().transpose();
      const double iso = mu_ * std::pow(J, -2.0 / 3), third = F.squaredNorm() / 3;
      const Eigen::Matrix3d P = iso * (F - third * G) + (ks_ / 2 * (J * J - 1) + p * J) * G;
      const double GG = ks_ * J * J + p * J + iso * 2 / 3 * third,
                   swapped = iso * third - ks_ / 2 * (J * J - 1) - p * J;
      Eigen::Matrix<double, 9, 9> A;  // dP/dF, index i + 3 j
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < 3; ++l)
            for (int m = 0; m < 3; ++m)
              A(i + 3 * j, m + 3 * l) = (i == m && j == l ? iso : 0) -
                                        iso * 2 / 3 * (F(i, j) * G(m, l) + G(i, j) * F(m, l)) +
                                        GG * G(i, j) * G(m, l) + swapped * G(i, l) * G(m, j);
      Eigen::Matrix<double, 9, 30> B = Eigen::Matrix<double, 9, 30>::Zero();
      for (int n = 0; n < 10; ++n)
        for (int j = 0; j < 3; ++j)
          for (int i = 0; i < 3; ++i) B(i + 3 * j, 3 * n + i) = point.gradient(n, j);
      const double w = point.volume, soft = K_ - ks_;
      const Eigen::Map<const Eigen::Matrix<double, 9, 1>> P9(P.data()), G9(G.data());
      r.head<30>() += w * B.transpose() * P9;
      r.tail<4>() += w * (J - 1 - p / soft) * point.corner;
      k.topLeftCorner<30, 30>() += w * B.transpose() * A * B;
      k.bottomLeftCorner<4, 30>() += w * J * point.corner * (G9.transpose() * B);
      k.bottomRightCorner<4, 4>() -= w / soft * point.corner * point.corner.transpose();
    }
    k.topRightCorner<30, 4>() = k.bottomLeftCorner<4, 30>().transpose();
    return true;
  }

  // Adds one of Newton's steps to the state, the first of an increment with its prescribed part. The largest
  // displacement, or -1 where there is none to be had.
  double newton_step(const Eigen::VectorXd* increment) {
    Eigen::VectorXd b;
    if (!assemble(increment, b) || !std::isfinite(b.norm())) return -1;
    if (system_ == nullptr) system_ = std::make_unique<SymmetricEquations>(equations_, rows_, columns_);
    system_->solve(values_, b);
    double largest = 0;
    for (int i = 0; i < x_.size(); ++i) {
      const double d = equation_[i] >= 0 ? b[equation_[i]] : increment != nullptr ? (*increment)[i] : 0;
      x_[i] += d;
      if (i < 3 * static_cast<int>(mesh_.nodes.size())) largest = (std::max)(largest, std::abs(d));
    }
    return largest;
  }
  // Newton's method, to steps of less than `tolerance` of the radius.
  bool settle_once(double tolerance, int most) {
    for (int iteration = 0; iteration < most; ++iteration) {
      const double largest = newton_step(nullptr);
      if (largest < 0) return false;
      Eigen::VectorXd b;
      if (largest < tolerance * sphere_.radius) return assemble(nullptr, b);
    }
    return false;
  }
  // The sphere's penalty over undeformed faces, seven points each, exact to the fifth degree.
  void add_sphere(Eigen::VectorXd& b, bool first) {
    constexpr double r15 = 3.872983346207417, a[2] = {(6 - r15) / 21, (6 + r15) / 21},
                     wa[2] = {(155 - r15) / 1200, (155 + r15) / 1200};
    std::array<std::array<double, 4>, 7> points{{{1. / 3, 1. / 3, 1. / 3, 0.225}}};
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < 3; ++i) {
        points[1 + 3 * k + i] = {a[k], a[k], a[k], wa[k]};
        points[1 + 3 * k + i][i] = 1 - 2 * a[k];
      }
    sphere_force_.setZero();
    for (const auto& face : sphere_.faces) {
      Eigen::Matrix<double, 18, 18> k = Eigen::Matrix<double, 18, 18>::Zero();
      Eigen::Matrix<double, 18, 1> r = Eigen::Matrix<double, 18, 1>::Zero();
      for (const auto& [l0, l1, l2, weight] : points) {
        const std::array<double, 6> shape{l0 * (2 * l0 - 1), l1 * (2 * l1 - 1), l2 * (2 * l2 - 1),
                                          4 * l0 * l1,       4 * l1 * l2,       4 * l2 * l0},
            by1{1 - 4 * l0, 4 * l1 - 1, 0, 4 * (l0 - l1), 4 * l2, -4 * l2},
            by2{1 - 4 * l0, 0, 4 * l2 - 1, -4 * l1, 4 * l1, 4 * (l0 - l2)};
        V from = -sphere_.centre, t1 = V::Zero(), t2 = V::Zero();
        for (int i = 0; i < 6; ++i) {
          const V& p = mesh_.nodes[face[i]];
          from += shape[i] * (p + x_.segment<3>(3 * face[i]));
          t1 += by1[i] * p;
          t2 += by2[i] * p;
        }
        const double distance = from.norm(), inside = sphere_.radius - distance;
        if (!(inside > 0)) continue;
        const V n = from / distance;
        const double w = sphere_.penalty * 0.5 * t1.cross(t2).norm() * weight;
        sphere_force_ += w * inside * n;
        const Eigen::Matrix3d nn = n * n.transpose(),
                              stiffness = w * (nn - inside / distance * (Eigen::Matrix3d::Identity() - nn));
        for (int i = 0; i < 6; ++i) {
          r.segment<3>(3 * i) -= w * inside * shape[i] * n;
          for (int j = 0; j < 6; ++j) k.block<3, 3>(3 * i, 3 * j) += shape[i] * shape[j] * stiffness;
        }
      }
      std::array<int, 18> unknowns;
      for (int i = 0; i < 18; ++i) unknowns[i] = 3 * face[i / 3] + i % 3;
      add(unknowns, r, k, first, b);
    }
  }
  // An element's part of the equations.
  template <class Unknowns, class Vector, class Matrix>
  void add(const Unknowns& unknowns, const Vector& r, const Matrix& k, bool first, Eigen::VectorXd& b) {
    for (int i = 0; i < r.size(); ++i) {
      const int row = equation_[unknowns[i]];
      if (row < 0) continue;
      b[row] -= r[i];
      for (int j = 0; j <= i; ++j) {
        const int column = equation_[unknowns[j]];
        if (column < 0) continue;
        values_.push_back(k(i, j));
        if (first)
          rows_.push_back((std::max)(row, column) + 1), columns_.push_back((std::min)(row, column) + 1);
      }
    }
  }

  // b = -(forces of x_ and of the increment's prescribed part), and the tangent's values.
  bool assemble(const Eigen::VectorXd* increment, Eigen::VectorXd& b) {
    const bool first = rows_.empty();
    b = Eigen::VectorXd::Zero(equations_);
    force_ = Eigen::VectorXd::Zero(x_.size());
    values_.clear();
    least_J_ = 1;
    for (std::size_t e = 0; e < unknowns_.size(); ++e) {
      Vector34 r;
      Matrix34 k;
      if (!element(x_, e, r, k)) return false;
      for (int i = 0; i < 34; ++i) force_[unknowns_[e][i]] += r[i];
      if (increment != nullptr)
        for (int i = 0; i < 30; ++i)
          if (equation_[unknowns_[e][i]] < 0 && (*increment)[unknowns_[e][i]] != 0)
            r += k.col(i) * (*increment)[unknowns_[e][i]];
      add(unknowns_[e], r, k, first, b);
    }
    add_sphere(b, first);
    return true;
  }
  // Forces by the tangent at `state` for what x_ is more.
  void set_linear_forces(const Eigen::VectorXd& state) {
    force_ = Eigen::VectorXd::Zero(x_.size());
    Vector34 r, d;
    Matrix34 k;
    for (std::size_t e = 0; e < unknowns_.size(); ++e) {
      element(state, e, r, k);
      for (int i = 0; i < 34; ++i) d[i] = x_[unknowns_[e][i]] - state[unknowns_[e][i]];
      const Vector34 f = k * d;
      for (int i = 0; i < 34; ++i) force_[unknowns_[e][i]] += f[i];
    }
  }

  const Tetrahedra& mesh_;
  double mu_, K_, ks_;  // [MPa]
  std::vector<std::array<int, 34>> unknowns_;
  std::vector<std::array<Point, points_>> data_;
  std::vector<int> equation_;  // of each unknown; -1: prescribed
  int equations_ = 0;
  Eigen::VectorXd x_, force_;
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
  std::unique_ptr<SymmetricEquations> system_;
  double least_J_ = 1;
  RigidSphere sphere_;
  V sphere_force_ = V::Zero();
};

}  // namespace bench
