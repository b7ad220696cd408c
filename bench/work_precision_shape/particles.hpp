// SPDX-License-Identifier: MIT
#pragma once

/// @file  Baselines by particles: mass-spring by local and global steps, and position based dynamics (XPBD).
/// Quasi-static: velocities are dropped each tick.

#include "work_precision_shape/body.hpp"

#include <Eigen/SparseCholesky>

#include <map>

namespace bench {

struct Spring {
  std::uint32_t a, b;
  double length, k;  // [m], [N/m]
};

/// Springs along the tetrahedra's edges: k = E V / l^2, V the volume of the tetrahedra around
/// [vangelder1998].
inline std::vector<Spring> springs_of(const Tetrahedra& mesh, double E) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> volume;
  for (const auto& e : mesh.element) {
    const V p = mesh.node[e[1]] - mesh.node[e[0]], q = mesh.node[e[2]] - mesh.node[e[0]],
            r = mesh.node[e[3]] - mesh.node[e[0]];
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        volume[std::minmax(e[i], e[j])] += std::abs(p.dot(q.cross(r))) / 6;
  }
  std::vector<Spring> springs;
  for (const auto& [ends, v] : volume) {
    const double length = (mesh.node[ends.first] - mesh.node[ends.second]).norm();
    springs.push_back({ends.first, ends.second, length, E * v / (length * length)});
  }
  return springs;
}

/// Mass-spring model at rest in every tick: each step projects all springs on their rest length, then one
/// back-solve with the springs' Laplacian [liu2013].
class MassSpring {
 public:
  MassSpring(const Tetrahedra& mesh, double E) : mesh_(&mesh), x_(mesh.node), springs_(springs_of(mesh, E)) {
    number_.assign(x_.size(), -1);
    for (std::size_t v = 0; v < x_.size(); ++v)
      if (!mesh.fixed[v] && !mesh.patch[v]) number_[v] = free_++;
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& [a, b, length, k] : springs_) {
      const int i = number_[a], j = number_[b];
      if (i >= 0) entries.emplace_back(i, i, k);
      if (j >= 0) entries.emplace_back(j, j, k);
      if (i >= 0 && j >= 0) entries.emplace_back((std::max)(i, j), (std::min)(i, j), -k);
    }
    Eigen::SparseMatrix<double> L(free_, free_);
    L.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(L);
    rhs_.resize(free_, 3);
  }

  V tick(const V& tool, int steps) {
    for (std::size_t v = 0; v < x_.size(); ++v)
      if (mesh_->patch[v]) x_[v] = mesh_->node[v] + tool;
    for (int s = 0; s < steps; ++s) {
      rhs_.setZero();
      for (const Spring& p : springs_) {
        const V d = x_[p.a] - x_[p.b], pull = p.k * p.length / d.norm() * d;
        const int i = number_[p.a], j = number_[p.b];
        if (i >= 0) rhs_.row(i) += (pull + (j < 0 ? V(p.k * x_[p.b]) : V(V::Zero()))).transpose();
        if (j >= 0) rhs_.row(j) += (-pull + (i < 0 ? V(p.k * x_[p.a]) : V(V::Zero()))).transpose();
      }
      rhs_ = factor_.solve(rhs_).eval();
      for (std::size_t v = 0; v < x_.size(); ++v)
        if (number_[v] >= 0) x_[v] = rhs_.row(number_[v]).transpose();
    }
    V force = V::Zero();
    for (const Spring& p : springs_) {
      if (mesh_->patch[p.a] == mesh_->patch[p.b]) continue;
      const V d = x_[p.a] - x_[p.b], f = p.k * (1 - p.length / d.norm()) * d;
      force += mesh_->patch[p.a] ? f : V(-f);
    }
    return force;
  }
  void reset() { x_ = mesh_->node; }
  [[nodiscard]] const std::vector<V>& position() const { return x_; }

 private:
  const Tetrahedra* mesh_;
  std::vector<V> x_;
  std::vector<Spring> springs_;
  std::vector<int> number_;
  int free_ = 0;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> rhs_;
};

/// Position based dynamics with compliance [macklin2016]: a distance constraint per edge, with the springs'
/// stiffness, and a volume constraint per tetrahedron, with the bulk modulus. Gauss-Seidel sweeps; velocities
/// are dropped.
class PositionBased {
 public:
  struct Settings {
    double step;     ///< [s]: the longer, the stiffer the constraints
    int iterations;  ///< Gauss-Seidel sweeps within a step
    int steps;       ///< per tick
  };

  PositionBased(const Tetrahedra& mesh, double E, double nu) : mesh_(&mesh), x_(mesh.node) {
    const double bulk = E / (3 * (1 - 2 * nu));
    std::vector<double> mass(x_.size(), 0.0);
    for (const auto& e : mesh.element) {
      Cell cell{{e[0], e[1], e[2], e[3]}, 0, 0, 0};
      cell.rest = volume(cell);
      cell.stiffness = bulk / cell.rest;
      for (std::size_t i = 0; i < 4; ++i) mass[e[i]] += 1000 * cell.rest / 4;
      cells_.push_back(cell);
    }
    for (const Spring& s : springs_of(mesh, E)) edges_.push_back({s.a, s.b, s.length, s.k, 0});
    for (std::size_t v = 0; v < x_.size(); ++v)
      w_.push_back(mesh.fixed[v] || mesh.patch[v] ? 0 : 1 / mass[v]);
  }

  V tick(const V& tool, const Settings& s) {
    for (std::size_t v = 0; v < x_.size(); ++v)
      if (mesh_->patch[v]) x_[v] = mesh_->node[v] + tool;
    for (int k = 0; k < s.steps; ++k) {
      for (Edge& e : edges_) e.multiplier = 0;
      for (Cell& c : cells_) c.multiplier = 0;
      for (int i = 0; i < s.iterations; ++i) {
        for (Edge& e : edges_) project(e, s.step);
        for (Cell& c : cells_) project(c, s.step);
      }
    }
    V force = V::Zero();  // from the energy's gradient at the patch
    for (const Edge& e : edges_) {
      if (mesh_->patch[e.a] == mesh_->patch[e.b]) continue;
      const V d = x_[e.a] - x_[e.b], f = e.stiffness * (1 - e.rest / d.norm()) * d;
      force += mesh_->patch[e.a] ? f : V(-f);
    }
    for (const Cell& c : cells_)
      for (std::size_t i = 0; i < 4; ++i)
        if (mesh_->patch[c.corner[i]]) force += c.stiffness * (volume(c) - c.rest) * slope(c, i);
    return force;
  }
  void reset() { x_ = mesh_->node; }
  [[nodiscard]] const std::vector<V>& position() const { return x_; }

 private:
  struct Edge {
    std::uint32_t a, b;
    double rest, stiffness, multiplier;  // [m], [N/m]
  };
  struct Cell {
    std::array<std::uint32_t, 4> corner;
    double rest, stiffness, multiplier;  // [m^3], [Pa/m^3]
  };
  [[nodiscard]] const V& at(const Cell& c, std::size_t i) const { return x_[c.corner[i]]; }
  [[nodiscard]] double volume(const Cell& c) const {
    return (at(c, 1) - at(c, 0)).dot((at(c, 2) - at(c, 0)).cross(at(c, 3) - at(c, 0))) / 6;
  }
  [[nodiscard]] V slope(const Cell& c, std::size_t i) const {  // of the volume by corner i
    constexpr std::array<std::array<std::size_t, 3>, 4> opposite{
        {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};
    const auto [p, q, r] = opposite[i];
    return (at(c, q) - at(c, p)).cross(at(c, r) - at(c, p)) / 6;
  }
  void project(Edge& e, double step) {
    const double w = w_[e.a] + w_[e.b], compliance = 1 / (e.stiffness * step * step);
    if (!(w > 0)) return;
    const V d = x_[e.a] - x_[e.b];
    const double length = d.norm(), change = (e.rest - length - compliance * e.multiplier) / (w + compliance);
    e.multiplier += change;
    x_[e.a] += change * w_[e.a] / length * d;
    x_[e.b] -= change * w_[e.b] / length * d;
  }
  void project(Cell& c, double step) {
    std::array<V, 4> g;
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      g[i] = slope(c, i);
      sum += w_[c.corner[i]] * g[i].squaredNorm();
    }
    if (!(sum > 0)) return;
    const double compliance = 1 / (c.stiffness * step * step);
    const double change = (c.rest - volume(c) - compliance * c.multiplier) / (sum + compliance);
    c.multiplier += change;
    for (std::size_t i = 0; i < 4; ++i) x_[c.corner[i]] += change * w_[c.corner[i]] * g[i];
  }

  const Tetrahedra* mesh_;
  std::vector<V> x_;
  std::vector<double> w_;
  std::vector<Edge> edges_;
  std::vector<Cell> cells_;
};

}  // namespace bench
