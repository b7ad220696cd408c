// SPDX-License-Identifier: MIT
#pragma once

/// @file Influence functions: for a unit force at each node, the regular part w of the displacement u =
/// u_near + w. Set-up only.
///
/// u_near: the half-space solution in the node's tangent plane. It satisfies the elastic equations inside the
/// body, so w does, too, and w is smooth: a coarse mesh resolves it.
///     H w = -int U t_near dS + G_fixed t ,   w = -u_near on the fixed region
/// t_near varies fast only near the node. There t_near less its nodal interpolant is integrated by Duffy's
/// map; the rest is G times nodal values. These are not t_near's own, but those whose interpolant has the
/// same integrals: t_near is not linear between nodes, and its own values are 10 % too large at two edges
/// from the node.

#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/elasticity/point_load.hpp>
#include <palpate/response/setup/boundary_element.hpp>
#include <palpate/response/setup/load_positions.hpp>

#include <Eigen/SVD>

namespace palpate {

namespace detail {

/// -int U t_near dS for the three unit forces at a node, at every vertex (3n x 3).
class NearSource {
 public:
  NearSource(const BoundaryElements& bem, double nu) : bem_(bem), nu_(nu), mass_(bem.mesh().nodes.size(), 0) {
    std::vector<ElementPoint> scratch;
    for (std::size_t t = 0; t < bem.elements().size(); ++t) {
      scratch.clear();
      element_points(bem.elements()[t], radon_rule(), scratch);
      for (const ElementPoint& q : scratch)
        for (std::size_t c = 0; c < 3; ++c)
          mass_[bem.mesh().nodes_of[t][c]] += q.area * q.weight[Eigen::Index(c)];
    }
  }

  /// A triangle near a node, where t_near varies fast.
  struct Close {
    std::uint32_t triangle;
    Vec3d apex;       ///< barycentric, its position nearest to the load
    double distance;  ///< of that position [m]
  };
  [[nodiscard]] std::vector<Close> close(const LoadNode& s) const {
    std::vector<Close> out;
    for (std::uint32_t t = 0; t < bem_.elements().size(); ++t) {
      if (t == s.triangle) {
        out.push_back({t, s.part.cast<double>(), 0});
        continue;
      }
      const Element& e = bem_.elements()[t];
      const Vec3d w = closest_on_triangle<double>(s.source, e.corner[0], e.corner[1], e.corner[2]);
      const double distance =
          (w[0] * e.corner[0] + w[1] * e.corner[1] + w[2] * e.corner[2] - s.source).norm();
      if (distance <= setup::near_traction * s.size)
        out.push_back({t, w, distance < setup::on_element * s.size ? 0 : distance});
    }
    return out;
  }

  /// Points over such a triangle.
  void points(const LoadNode& s, const Close& at, std::vector<ElementPoint>& out) const {
    const Element& e = bem_.elements()[at.triangle];
    if (at.distance < setup::singular_traction * s.size)
      polar_points<setup::traction_points>(e, at.apex, out, at.distance);
    else
      element_points(e, radon_rule(), out);
  }

  /// Nodal values that stand for t_near of a node on all but the close triangles (3 nodes x 3).
  void nodal(const LoadNode& s, const std::vector<Close>& close, Eigen::Ref<Matrix> out) const {
    const ElementMesh& m = bem_.mesh();
    for (std::uint32_t j = 0; j < m.nodes.size(); ++j) {
      const Vec3d& x = m.vertices[m.nodes[j].vertex];
      if ((x - s.source).norm() < setup::singular_traction * s.size)  // not smooth there
        out.middleRows<3>(3 * Eigen::Index(j)).setZero();
      else
        out.middleRows<3>(3 * Eigen::Index(j)) = traction(s, x, m.nodes[j].normal);
    }
    raise_to_integrals(s, close, out);
  }

  /// Adds -int U (t_near - nodal interpolant) over the triangles around a node. Returns -int t_near dS over
  /// the whole surface: of a body that is a half-space around the node, the unit forces.
  [[nodiscard]] Mat3<double> remainder(const LoadNode& s, const std::vector<Close>& close,
                                       const Eigen::Ref<const Matrix>& nodal, Eigen::Ref<Matrix> out) const {
    const ElementMesh& m = bem_.mesh();
    struct Point {
      Vec3d x;
      Mat3<double> f;
    };
    std::vector<Point> loads;
    std::vector<ElementPoint> scratch;
    std::vector<std::pair<std::uint32_t, Mat3<double>>> lumps;
    Mat3<double> force = Mat3<double>::Zero();
    for (std::size_t j = 0; j < mass_.size(); ++j)
      force -= mass_[j] * nodal.middleRows<3>(3 * Eigen::Index(j));
    for (const auto& [t, apex, distance] : close) {
      scratch.clear();
      points(s, {t, apex, distance}, scratch);
      Mat3<double> lump[3] = {Mat3<double>::Zero(), Mat3<double>::Zero(), Mat3<double>::Zero()};
      for (const ElementPoint& q : scratch) {
        Mat3<double> f = -q.area * traction(s, q.x, q.normal / q.area);
        for (int c = 0; c < 3; ++c)
          f += (q.area * q.weight[c]) * nodal.middleRows<3>(3 * Eigen::Index(m.nodes_of[t][std::size_t(c)]));
        loads.push_back({q.x, f});
        force += f;
        for (int c = 0; c < 3; ++c) lump[c] += q.weight[c] * f;
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = m.triangles[t][c];
        const auto found =
            std::find_if(lumps.begin(), lumps.end(), [v](const auto& l) { return l.first == v; });
        if (found == lumps.end())
          lumps.emplace_back(v, lump[c]);
        else
          found->second += lump[c];
      }
    }
    double reach = 0;
    for (const auto& l : lumps) reach = (std::max)(reach, (m.vertices[l.first] - s.source).norm());
    for (std::uint32_t i = 0; i < m.vertices.size(); ++i) {
      const Vec3d& x = m.vertices[i];
      const double distance = (x - s.source).norm();
      Mat3<double> sum = Mat3<double>::Zero();
      if (distance > setup::far_from_elements * reach) {  // from afar, forces at the vertices do
        for (const auto& [v, f] : lumps) sum += bem_.kelvin().displacement(m.vertices[v] - x, f);
      } else {
        // At the node itself the mean over a patch is wanted: 1/R^2 is cut off there.
        const double cut_off = distance < setup::own_vertex * s.size ? setup::own_cut_off * s.size : 0;
        for (const Point& q : loads) {
          const Vec3d r = q.x - x;
          if (r.squaredNorm() < cut_off * cut_off) continue;
          sum += bem_.kelvin().displacement(r, q.f);
        }
      }
      out.middleRows<3>(3 * Eigen::Index(i)) += sum;
    }
    return force;
  }

 private:
  [[nodiscard]] Mat3<double> traction(const LoadNode& s, const Vec3d& x, const Vec3d& normal) const {
    return point_load_traction(Vec3d(x - s.source), Vec3d(-s.normal), normal, nu_);
  }

  // Adds to t_near's own values the integrals of its mid-edge correction b, which linear interpolation leaves
  // out: int phi 4 phi_c phi_d b dS, by the lumped mass of the triangles that are not close. (A consistent
  // mass changes nothing.)
  void raise_to_integrals(const LoadNode& s, const std::vector<Close>& close, Eigen::Ref<Matrix> out) const {
    const ElementMesh& m = bem_.mesh();
    Matrix missing = Matrix::Zero(out.rows(), 3);
    std::vector<double> mass(m.nodes.size(), 0);
    auto skip = close.begin();
    for (std::uint32_t t = 0; t < m.triangles.size(); ++t) {
      if (skip != close.end() && skip->triangle == t) {
        ++skip;
        continue;
      }
      const Element& e = bem_.elements()[t];
      const auto& node = m.nodes_of[t];
      const auto at = [&node](std::size_t corner) { return 3 * Eigen::Index(node[corner]); };
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t d = (c + 1) % 3, opposite = (c + 2) % 3;
        const Vec3d normal = e.normal(0.5 * (Vec3d::Unit(Eigen::Index(c)) + Vec3d::Unit(Eigen::Index(d))));
        const double area = 0.5 * normal.norm();
        const Mat3<double> quadratic = traction(s, e.middle[c], normal.normalized()) -
                                       0.5 * (out.middleRows<3>(at(c)) + out.middleRows<3>(at(d)));
        missing.middleRows<3>(at(c)) += 2 * area / 15 * quadratic;
        missing.middleRows<3>(at(d)) += 2 * area / 15 * quadratic;
        missing.middleRows<3>(at(opposite)) += area / 15 * quadratic;
        mass[node[c]] += area / 3;
      }
    }
    for (std::size_t j = 0; j < mass.size(); ++j)
      if (mass[j] > 0) {
        const Eigen::Index row = 3 * Eigen::Index(j);
        out.middleRows<3>(row) += missing.middleRows<3>(row) / mass[j];
      }
  }

  const BoundaryElements& bem_;
  double nu_;
  std::vector<double> mass_;  // of the nodes [m^2]
};

}  // namespace detail

namespace detail {
/// u_near at vertex v of a unit force along axis l at a node, mu = 1 [1/m]. At the node's own vertex the mean
/// over a disc of half the edge length.
[[nodiscard]] inline Vec3d near_at_vertex(const ElementMesh& m, const LoadNode& node, std::uint32_t v, int l,
                                          double nu) {
  const Vec3d r = m.vertices[v] - node.source, e = Vec3d::Unit(l);
  const bool own = r.norm() < setup::own_vertex * node.size;
  const Vec3d u = own ? flat_punch_load(r, -node.normal, 0, setup::own_disc * node.size, e, nu)
                      : point_load<double>(r, -node.normal, e, nu);
  return u / (4 * std::numbers::pi);
}
/// Inverse of what acts on the body for the unit forces at a node: the identity, nearly. Its singular values
/// are bounded where a mesh that folds over itself leaves hardly any force.
[[nodiscard]] inline Mat3<double> bounded_inverse(const Mat3<double>& force) {
  const Eigen::JacobiSVD<Mat3<double>> parts(force, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return parts.matrixV() * parts.singularValues().cwiseMax(setup::min_force).cwiseInverse().asDiagonal() *
         parts.matrixU().transpose();
}
}  // namespace detail

/// w for unit forces at `nodes`, mu = 1: column 3 j + l is the field of direction l at node j; row 3 v + i is
/// component i at vertex v [1/m]. `bem` must be factorised.
[[nodiscard]] inline detail::Matrix solve_influence_functions(const BoundaryElements& bem, double nu,
                                                              std::span<const LoadNode> nodes) {
  using detail::Matrix;
  const ElementMesh& m = bem.mesh();
  const Eigen::Index n3 = 3 * Eigen::Index(m.vertices.size()), count = Eigen::Index(nodes.size());
  Matrix w(n3, 3 * count);
  const detail::NearSource source(bem, nu);
  const auto prescribe = [&](Eigen::Ref<Matrix> out, Eigen::Index row, std::uint32_t v,
                             const LoadNode& node) {
    for (int l = 0; l < 3; ++l) out.block<3, 1>(row, l) = detail::near_at_vertex(m, node, v, l, nu);
  };
  std::vector<Mat3<double>> force(nodes.size());
  constexpr Eigen::Index block = detail::setup::loads_together;
  const Eigen::Index blocks = (count + block - 1) / block;
  detail::parallel_for(static_cast<std::size_t>(blocks), bem.threads(), [&](std::size_t b) {
    const Eigen::Index first = Eigen::Index(b) * block, size = (std::min)(block, count - first);
    Matrix traction(3 * Eigen::Index(m.nodes.size()), 3 * size),
        prescribed(3 * Eigen::Index(bem.fixed().size()), 3 * size);
    std::vector<std::vector<detail::NearSource::Close>> close;
    for (Eigen::Index j = 0; j < size; ++j) {
      const LoadNode& s = nodes[std::size_t(first + j)];
      close.push_back(source.close(s));
      source.nodal(s, close.back(), traction.middleCols<3>(3 * j));
      for (std::size_t f = 0; f < bem.fixed().size(); ++f)
        prescribe(prescribed.middleCols<3>(3 * j), 3 * Eigen::Index(f), bem.fixed()[f], s);
    }
    auto columns = w.middleCols(3 * first, 3 * size);
    columns.noalias() = bem.H_fixed() * prescribed;
    columns.noalias() -= bem.G() * traction;
    for (Eigen::Index j = 0; j < size; ++j)
      force[std::size_t(first + j)] =
          source.remainder(nodes[std::size_t(first + j)], close[std::size_t(j)],
                           traction.middleCols<3>(3 * j), columns.middleCols<3>(3 * j));
  });
  bem.solve(w);
  // Where the surface is not smooth, or another part is near, what acts on the body is not quite the unit
  // forces: u = (u_near + w) force^-1.
  detail::parallel_for(nodes.size(), bem.threads(), [&](std::size_t j) {
    const Mat3<double> per_force = detail::bounded_inverse(force[j]);
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) {
      Mat3<double> near;
      prescribe(near, 0, v, nodes[j]);
      auto regular = w.block<3, 3>(3 * Eigen::Index(v), 3 * Eigen::Index(j));
      if (m.fixed_vertex[v])  // these rows contain tractions; the displacement is 0
        regular = -near;
      else
        regular = (near + regular) * per_force - near;
    }
  });
  return w;
}

}  // namespace palpate
