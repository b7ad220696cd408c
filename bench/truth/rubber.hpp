// SPDX-License-Identifier: MIT
#pragma once

/// @file Statics of nearly incompressible neo-Hookean rubber at any displacement, by finite elements: what
/// references are made with.
///
/// W = mu/2 (J^(-2/3) tr C - 3) + ks/4 (J^2 - 1 - 2 ln J) + (K - ks)/2 (J - 1)^2, ks = 10 mu, or K where that
/// is less; the last term through a continuous linear pressure (Taylor and Hood's ten-node tetrahedra). Total
/// Lagrangian, full Newton, MUMPS. Shares no code with the library.

#include "truth/contact.hpp"
#include "truth/sparse_equations.hpp"
#include "truth/tetrahedra.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace bench {

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
  /// The body touches rigid tools from now on, which the caller moves.
  void touch(Contact& contact) { contact_ = &contact; }
  /// Small strain and displacement from now on: forces by the tangent at rest. The tools' overlap is exact.
  void linearize() { linear_ = true; }
  /// Finds equilibrium with the tools, to `tolerance` [mm], from `guess`, or from the state by softer
  /// penalties. False, and nothing changed, where neither gets there.
  bool settle(const Eigen::VectorXd& guess, double tolerance) {
    const Eigen::VectorXd before = x_;
    x_ = guess;
    if (settle_once(tolerance, 25)) return true;
    x_ = before;
    if (contact_->rubs()) return false;  // a softer penalty would let go of what sticks
    for (double share : {0.03, 0.2, 1.0}) {
      contact_->share = share;
      if (settle_once(share < 1 ? 1e4 * tolerance : tolerance, 25)) continue;
      contact_->share = 1;
      x_ = before;
      return false;
    }
    return true;
  }
  /// Newton's steps, so far.
  int newton_steps() const { return newton_steps_; }
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
    ++newton_steps_;
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
  // Newton's method, to steps of less than `tolerance`; at first as if all stuck, lest points slip both ways
  // in turn. A step that goes too far by the forces along it, or turns an element inside out, is shortened.
  bool settle_once(double tolerance, int most) {
    const Eigen::Index displacements = 3 * static_cast<Eigen::Index>(mesh_.nodes.size());
    Eigen::VectorXd b, step = Eigen::VectorXd::Zero(x_.size());
    bool held = contact_->holds = contact_->friction > 0;
    if (!assemble(nullptr, b)) return contact_->holds = false;
    for (int iteration = 0; iteration < most; ++iteration) {
      const Eigen::VectorXd before = x_, residual = b;
      ++newton_steps_;
      if (system_ == nullptr) system_ = std::make_unique<SymmetricEquations>(equations_, rows_, columns_);
      system_->solve(values_, b);
      if (!std::isfinite(b.norm())) return contact_->holds = false;
      for (Eigen::Index i = 0; i < x_.size(); ++i) step[i] = equation_[i] >= 0 ? b[equation_[i]] : 0;
      const auto along = [&](const Eigen::VectorXd& force) {
        double sum = 0;
        for (Eigen::Index i = 0; i < displacements; ++i)
          if (equation_[i] >= 0) sum += force[equation_[i]] * step[i];
        return sum;
      };
      const double start = along(residual);
      contact_->holds = false;
      double share = 1;
      for (int cut = 0;; ++cut) {
        x_ = before + share * step;
        const bool whole = assemble(nullptr, b);
        if (cut == 6 && !whole) return false;
        const double end = whole ? along(b) : 0;
        if (whole && (held || cut == 6 || end > -0.5 * std::abs(start))) break;
        share *= whole ? (std::max)(0.1, std::abs(start) / (std::abs(start) - end)) : 0.5;
      }
      const double largest = share * step.head(displacements).cwiseAbs().maxCoeff();
      if (largest < tolerance && !held) return true;
      held = false;
    }
    return false;
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
        if (first) {
          const auto [low, high] = std::minmax(row, column);
          const auto [at, fresh] = entry_.try_emplace(std::pair{high, low}, static_cast<int>(rows_.size()));
          slots_.push_back(at->second);
          if (fresh) {
            rows_.push_back(high + 1);
            columns_.push_back(low + 1);
            values_.push_back(0);
          }
        }
        values_[slots_[next_++]] += k(i, j);
      }
    }
  }

  // b = -(forces of x_ and of the increment's prescribed part), and the tangent's values.
  bool assemble(const Eigen::VectorXd* increment, Eigen::VectorXd& b) {
    const bool first = rows_.empty();
    b = Eigen::VectorXd::Zero(equations_);
    force_ = Eigen::VectorXd::Zero(x_.size());
    values_.assign(rows_.size(), 0);
    next_ = 0;
    least_J_ = 1;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(x_.size());
    for (std::size_t e = 0; e < unknowns_.size(); ++e) {
      Vector34 r;
      Matrix34 k;
      if (linear_) {
        element(rest, e, r, k);
        Vector34 x;
        for (int i = 0; i < 34; ++i) x[i] = x_[unknowns_[e][i]];
        r = k * x;
      } else if (!element(x_, e, r, k)) {
        return false;
      }
      for (int i = 0; i < 34; ++i) force_[unknowns_[e][i]] += r[i];
      if (increment != nullptr)
        for (int i = 0; i < 30; ++i)
          if (equation_[unknowns_[e][i]] < 0 && (*increment)[unknowns_[e][i]] != 0)
            r += k.col(i) * (*increment)[unknowns_[e][i]];
      add(unknowns_[e], r, k, first, b);
    }
    if (contact_ != nullptr)
      contact_->assemble(mesh_.nodes, x_, [&](const auto& unknowns, const auto& r, const auto& k) {
        add(unknowns, r, k, first, b);
      });
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
  int equations_ = 0, newton_steps_ = 0;
  Eigen::VectorXd x_, force_;
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
  std::map<std::pair<int, int>, int> entry_;
  std::vector<int> slots_;  // where the elements' entries go, in their order
  std::size_t next_ = 0;
  std::unique_ptr<SymmetricEquations> system_;
  double least_J_ = 1;
  Contact* contact_ = nullptr;
  bool linear_ = false;
};

}  // namespace bench
