// SPDX-License-Identifier: MIT
#pragma once

/// @file Baselines by finite elements: linear, with a Cholesky factor made at set-up, and co-rotational with
/// the same factor.

#include "work_precision_shape/body.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

namespace bench {

class FiniteElements {
 public:
  static constexpr int most = 30;
  using Stiffness = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;
  using Local = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1>;

  FiniteElements(Tetrahedra mesh, double E, double nu)
      : mesh_(std::move(mesh)), u_(mesh_.node.size(), V::Zero()) {
    const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    const int count = mesh_.corners();
    number_.assign(mesh_.node.size(), -1);
    for (std::size_t v = 0; v < number_.size(); ++v)
      if (!mesh_.fixed[v] && !mesh_.patch[v]) number_[v] = free_++;
    // Gauss points: one, or four of degree 2.
    constexpr double p = 0.58541019662496845, q = 0.13819660112501052;
    std::vector<std::array<double, 4>> points{{0.25, 0.25, 0.25, 0.25}};
    if (mesh_.order == 2) points = {{p, q, q, q}, {q, p, q, q}, {q, q, p, q}, {q, q, q, p}};
    std::vector<Eigen::Triplet<double>> entries;
    std::array<double, 10> N{};
    std::array<V, 10> dN;
    for (const auto& e : mesh_.element) {
      Stiffness K = Stiffness::Zero(3 * count, 3 * count);
      std::array<V, 10> centre_gradient{};
      const auto gradients = [&](const std::array<double, 4>& b, std::array<V, 10>& g) {
        shape(mesh_.order, b, N, dN);
        Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < std::size_t(count); ++i) J += mesh_.node[e[i]] * dN[i].transpose();
        const Eigen::Matrix3d back = J.inverse().transpose();
        for (std::size_t i = 0; i < std::size_t(count); ++i) g[i] = back * dN[i];
        return J.determinant() / 6;
      };
      std::array<V, 10> mean;  // of the gradients: one dilatation per element, against locking
      mean.fill(V::Zero());
      double whole = 0;
      for (const auto& b : points) {
        std::array<V, 10> g;
        const double volume = gradients(b, g) / double(points.size());
        least_volume = (std::min)(least_volume, volume);
        whole += volume;
        for (std::size_t i = 0; i < std::size_t(count); ++i) mean[i] += volume * g[i];
        for (int i = 0; i < count; ++i)
          for (int j = 0; j < count; ++j) {
            const V &gi = g[std::size_t(i)], &gj = g[std::size_t(j)];
            K.block<3, 3>(3 * i, 3 * j) +=
                volume * mu * (gj * gi.transpose() + gi.dot(gj) * Eigen::Matrix3d::Identity());
          }
      }
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
          K.block<3, 3>(3 * i, 3 * j) +=
              lambda / whole * mean[std::size_t(i)] * mean[std::size_t(j)].transpose();
      gradients({0.25, 0.25, 0.25, 0.25}, centre_gradient);
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
          const int a = number_[e[std::size_t(i)]], b = number_[e[std::size_t(j)]];
          if (a < 0 || b < 0 || b > a) continue;
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              if (3 * b + c <= 3 * a + r) entries.emplace_back(3 * a + r, 3 * b + c, K(3 * i + r, 3 * j + c));
        }
      K_.push_back(K);
      gradient_.push_back(centre_gradient);
    }
    Eigen::SparseMatrix<double> A(3 * free_, 3 * free_);
    A.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(A);
    f_.resize(mesh_.node.size());
    rhs_.resize(3 * free_);
    lead_ = solve_lead();
  }

  /// Linear: one back-solve for the patch moved by `tool`. Returns the force that pushes the patch.
  V linear(const V& tool) {
    // K u = -K_p tool: the right-hand side is linear in the tool's move.
    rhs_ = lead_ * tool;
    const Eigen::VectorXd x = factor_.solve(rhs_);
    scatter(x, tool);
    internal_force(false);
    return patch_force();
  }

  /// Co-rotational: the patch moves on to `tool`, then `steps` half steps with the factor of the rest shape.
  V corotational(const V& tool, int steps) {
    for (std::size_t v = 0; v < u_.size(); ++v)
      if (mesh_.patch[v]) u_[v] = tool;
    constexpr double share = 0.5;  // whole steps diverge on the finer meshes
    for (int s = 0; s < steps; ++s) {
      internal_force(true);
      for (std::size_t v = 0; v < u_.size(); ++v)
        if (number_[v] >= 0) rhs_.segment<3>(3 * number_[v]) = -f_[v];
      const Eigen::VectorXd x = factor_.solve(rhs_);
      for (std::size_t v = 0; v < u_.size(); ++v)
        if (number_[v] >= 0) u_[v] += share * x.segment<3>(3 * number_[v]);
    }
    internal_force(true);
    return patch_force();
  }

  void reset() {
    std::fill(u_.begin(), u_.end(), V::Zero());
    rotation_.assign(K_.size(), Eigen::Quaterniond::Identity());
  }
  [[nodiscard]] const std::vector<V>& displacement() const { return u_; }
  [[nodiscard]] const Tetrahedra& mesh() const { return mesh_; }
  double least_volume = 1e300;

 private:
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 3> solve_lead() {
    Eigen::Matrix<double, Eigen::Dynamic, 3> lead(3 * free_, 3);
    for (int axis = 0; axis < 3; ++axis) {
      for (std::size_t v = 0; v < u_.size(); ++v) u_[v] = mesh_.patch[v] ? V(V::Unit(axis)) : V(V::Zero());
      internal_force(false);
      for (std::size_t v = 0; v < u_.size(); ++v)
        if (number_[v] >= 0) lead.block<3, 1>(3 * number_[v], axis) = -f_[v];
    }
    reset();
    return lead;
  }
  void scatter(const Eigen::VectorXd& x, const V& tool) {
    for (std::size_t v = 0; v < u_.size(); ++v)
      u_[v] = number_[v] >= 0 ? V(x.segment<3>(3 * number_[v])) : mesh_.patch[v] ? tool : V(V::Zero());
  }
  // Nodal forces R K (R^T x - X), R the rotation of the gradient at the element's centre; linear: R = 1, and
  // only the elements at the patch are needed.
  void internal_force(bool rotated) {
    std::fill(f_.begin(), f_.end(), V::Zero());
    const std::size_t count = std::size_t(mesh_.corners());
    Local local(3 * Eigen::Index(count));
    for (std::size_t k = 0; k < K_.size(); ++k) {
      const auto& e = mesh_.element[k];
      if (!rotated) {
        bool touches = false;
        for (std::size_t i = 0; i < count; ++i) touches = touches || mesh_.patch[e[i]] != 0;
        if (!touches) continue;
      }
      Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
      if (rotated) {
        Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
        for (std::size_t i = 0; i < count; ++i) F += u_[e[i]] * gradient_[k][i].transpose();
        for (int i = 0; i < 4;
             ++i) {  // from the last tick's rotation; safe for elements turned inside out [mueller2016]
          R = rotation_[k].toRotationMatrix();
          V turn = V::Zero();
          for (int c = 0; c < 3; ++c) turn += R.col(c).cross(F.col(c));
          turn /= std::abs(R.cwiseProduct(F).sum()) + 1e-9;
          const double angle = turn.norm();
          if (angle < 1e-9) break;
          rotation_[k] =
              (Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * rotation_[k]).normalized();
        }
        R = rotation_[k].toRotationMatrix();
      }
      for (std::size_t i = 0; i < count; ++i) {
        const V& X = mesh_.node[e[i]];
        local.segment<3>(3 * Eigen::Index(i)) = rotated ? V(R.transpose() * (X + u_[e[i]]) - X) : u_[e[i]];
      }
      local = (K_[k] * local).eval();
      for (std::size_t i = 0; i < count; ++i) f_[e[i]] += R * local.segment<3>(3 * Eigen::Index(i));
    }
  }
  [[nodiscard]] V patch_force() const {
    V sum = V::Zero();
    for (std::size_t v = 0; v < f_.size(); ++v)
      if (mesh_.patch[v]) sum += f_[v];
    return sum;
  }

  Tetrahedra mesh_;
  std::vector<V> u_, f_;
  std::vector<int> number_;
  int free_ = 0;
  std::vector<Stiffness> K_;
  std::vector<std::array<V, 10>> gradient_;  // at the element's centre
  std::vector<Eigen::Quaterniond> rotation_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> lead_;
  Eigen::VectorXd rhs_;
};

}  // namespace bench
