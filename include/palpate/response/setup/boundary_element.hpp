// SPDX-License-Identifier: MIT
#pragma once

/// @file Boundary elements: from a boundary element mesh to displacements by one dense factorisation. Set-up
/// only.
///
/// Somigliana's identity at every vertex x, u and geometry quadratic, known t linear on each triangle, mu =
/// 1:
///     c u(x) + int T(x,y) u(y) dS = int U(x,y) t(y) dS       ->       H u = G t
/// u at the middles of edges is no unknown: it follows from the neighbours (mid_edge_fit.hpp). So does the
/// unknown t of the fixed region, where none of the neighbours is free. A rigid translation has no traction,
/// so H's diagonal block is minus the sum of the others in its row: neither c nor a principal value is
/// computed. Unknown: u at free vertices, t at fixed ones. Source: [brebbia1984].

#include <palpate/elasticity/kelvin.hpp>
#include <palpate/response/setup/constants.hpp>
#include <palpate/response/setup/make_element_mesh.hpp>
#include <palpate/response/setup/mid_edge_fit.hpp>
#include <palpate/response/setup/parallel.hpp>
#include <palpate/response/setup/quadrature.hpp>

#include <Eigen/LU>

namespace palpate {

namespace detail {

using Matrix = Eigen::MatrixXd;

struct ElementPoint {
  Vec3d x, normal;  ///< position; outward normal times the point's share of area [m], [m^2]
  Vec3d weight;     ///< barycentric
  double area;
};

template <class Rule>
void element_points(const Element& e, const Rule& rule, std::vector<ElementPoint>& out) {
  for (const TrianglePoint& q : rule) {
    const Vec3d n = (0.5 * q.share) * e.normal(q.weight);
    out.push_back({e.at(q.weight), n, q.weight, n.norm()});
  }
}

/// Points on the element crowded towards its position nearest to `apex` (barycentric): the triangle is cut
/// there in three. `distance`: of a singularity from the apex, 0 if it lies there [m].
template <std::size_t N>
void polar_points(const Element& e, const Vec3d& apex, std::vector<ElementPoint>& out, double distance = 0) {
  const Vec3d x = e.at(apex);
  for (int c = 0; c < 3; ++c) {
    const double share = apex[c];
    if (share < setup::min_share) continue;
    const int b = (c + 1) % 3, d = (c + 2) % 3;
    const double size = 0.5 * ((e.corner[b] - x).norm() + (e.corner[d] - x).norm());
    element_points(e, duffy_rule<N>(apex, Vec3d::Unit(b), Vec3d::Unit(d), share, distance / size), out);
  }
}
}  // namespace detail

/// H, G and the factorised system of one body. Vertices n, nodes k, mu = 1.
class BoundaryElements {
 public:
  BoundaryElements(ElementMesh mesh, double nu, unsigned threads)
      : mesh_(std::move(mesh)), mid_edge_fit_(mesh_), kelvin_(nu), threads_(threads) {
    if (!(nu >= 0 && nu <= 0.5)) fail("BoundaryElements", "nu must be in [0, 1/2]", nu);
    mesh_.middle = mid_edge_fit_.middles(mesh_);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const detail::Element& e = elements_.emplace_back(mesh_, t);
      detail::element_points(e, radon_rule(), points7_);
      detail::element_points(e, three_point_rule(), points3_);
    }
    assemble();
  }

  [[nodiscard]] const ElementMesh& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const detail::MidEdgeFit& mid_edge_fit() const noexcept { return mid_edge_fit_; }
  [[nodiscard]] const Kelvin& kelvin() const noexcept { return kelvin_; }
  [[nodiscard]] const std::vector<detail::Element>& elements() const noexcept { return elements_; }
  [[nodiscard]] unsigned threads() const noexcept { return threads_; }
  [[nodiscard]] const detail::Matrix& H() const noexcept { return H_; }  ///< 3n x 3n
  [[nodiscard]] const detail::Matrix& G() const noexcept { return G_; }  ///< 3n x 3k: traction at nodes
  [[nodiscard]] const std::vector<std::uint32_t>& fixed() const noexcept {
    return fixed_;
  }  ///< numbers of the fixed vertices

  /// Factorises the system with u known at fixed vertices; H is used up except for the fixed vertices'
  /// columns (H_fixed).
  void factorise() {
    H_fixed_.resize(H_.rows(), 3 * Eigen::Index(fixed_.size()));
    for (std::size_t f = 0; f < fixed_.size(); ++f) {
      H_fixed_.middleCols<3>(3 * Eigen::Index(f)) = H_.middleCols<3>(3 * Eigen::Index(fixed_[f]));
      H_.middleCols<3>(3 * Eigen::Index(fixed_[f])) = -G_fixed_.middleCols<3>(3 * Eigen::Index(f));
    }
    G_fixed_.resize(0, 0);
    lu_.compute(H_);
    H_.resize(0, 0);
  }
  [[nodiscard]] const detail::Matrix& H_fixed() const noexcept { return H_fixed_; }  ///< 3n x 3 fixed

  /// Solves in place. Each column: in, G t - H_fixed u_fixed; out, u at free vertices, t at fixed ones.
  void solve(detail::Matrix& columns) const {
    const Eigen::Index block = detail::setup::solved_together, count = (columns.cols() + block - 1) / block;
    detail::parallel_for(static_cast<std::size_t>(count), threads_, [&](std::size_t b) {
      const Eigen::Index first = Eigen::Index(b) * block, size = (std::min)(block, columns.cols() - first);
      columns.middleCols(first, size) = lu_.solve(columns.middleCols(first, size)).eval();
    });
  }

 private:
  using Row = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  void assemble() {
    const Eigen::Index n = Eigen::Index(mesh_.vertices.size());
    std::vector<Eigen::Index> fixed_number(mesh_.vertices.size(), -1);
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v)
      if (mesh_.fixed_vertex[v]) {
        fixed_number[v] = Eigen::Index(fixed_.size());
        fixed_.push_back(v);
      }
    const std::vector<char> within_fixed = edges_within_fixed();
    H_.setZero(3 * n, 3 * n);
    G_.setZero(3 * n, 3 * Eigen::Index(mesh_.nodes.size()));
    G_fixed_.setZero(3 * n, 3 * Eigen::Index(fixed_.size()));
    detail::parallel_for(mesh_.vertices.size(), threads_, [&](std::size_t i) {
      const Vec3<double>& x = mesh_.vertices[i];
      Row h = Row::Zero(3, H_.cols()), g = Row::Zero(3, G_.cols()), gf = Row::Zero(3, G_fixed_.cols());
      Mat3<double> T[3], B[3], U[3], D[3], sum = Mat3<double>::Zero();
      std::vector<Mat3<double>> bent(mid_edge_fit_.size(), Mat3<double>::Zero()), bent_traction = bent;
      std::vector<detail::ElementPoint> scratch;
      for (std::size_t t = 0; t < elements_.size(); ++t) {
        for (int c = 0; c < 3; ++c) T[c].setZero(), B[c].setZero(), U[c].setZero(), D[c].setZero();
        int self = -1;
        for (int c = 0; c < 3; ++c)
          if (mesh_.triangles[t][static_cast<std::size_t>(c)] == i) self = c;
        integrate(x, t, self, T, B, U, D, scratch);
        for (std::size_t c = 0; c < 3; ++c) {
          bent[mid_edge_fit_.edge(t, c)] += B[c];
          bent_traction[mid_edge_fit_.edge(t, c)] += D[c];
          const std::uint32_t v = mesh_.triangles[t][c];
          if (int(c) != self) {
            h.middleCols<3>(3 * Eigen::Index(v)) += T[c];
            sum += T[c];
          }
          g.middleCols<3>(3 * Eigen::Index(mesh_.nodes_of[t][c])) += U[c];
          if (mesh_.fixed_triangle[t]) gf.middleCols<3>(3 * fixed_number[v]) += U[c];
        }
      }
      h.middleCols<3>(3 * Eigen::Index(i)) = -sum;
      for (std::size_t e = 0; e < mid_edge_fit_.size(); ++e)
        for (const detail::VertexWeight& w : mid_edge_fit_[e]) {
          h.middleCols<3>(3 * Eigen::Index(w.vertex)) += w.weight * bent[e];
          if (within_fixed[e]) gf.middleCols<3>(3 * fixed_number[w.vertex]) += w.weight * bent_traction[e];
        }
      H_.middleRows<3>(3 * Eigen::Index(i)) = h;
      G_.middleRows<3>(3 * Eigen::Index(i)) = g;
      G_fixed_.middleRows<3>(3 * Eigen::Index(i)) = gf;
    });
  }

  // For each edge: whether it and all vertices of its mid-edge correction lie in the fixed region.
  [[nodiscard]] std::vector<char> edges_within_fixed() const {
    std::vector<char> out(mid_edge_fit_.size(), 1);
    for (std::size_t t = 0; t < elements_.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c)
        if (!mesh_.fixed_triangle[t]) out[mid_edge_fit_.edge(t, c)] = 0;
    for (std::size_t e = 0; e < out.size(); ++e)
      for (const detail::VertexWeight& w : mid_edge_fit_[e])
        if (!mesh_.fixed_vertex[w.vertex]) out[e] = 0;
    return out;
  }

  // Integrals over one triangle, from x, of T phi_c, U phi_c and, for the middle of edge c, B: T 4 phi_c
  // phi_c+1, D: U 4 phi_c phi_c+1; `self`: x's corner or -1, whose T phi is left out.
  void integrate(const Vec3<double>& x, std::size_t t, int self, Mat3<double>* T, Mat3<double>* B,
                 Mat3<double>* U, Mat3<double>* D, std::vector<detail::ElementPoint>& scratch) const {
    const detail::Element& e = elements_[t];
    const auto add = [&](const detail::ElementPoint& q) {
      const Vec3<double> r = q.x - x;
      const Mat3<double> u = q.area * kelvin_.displacement(r), s = kelvin_.traction(r, q.normal);
      for (int c = 0; c < 3; ++c) {
        U[c] += q.weight[c] * u;
        if (c != self) T[c] += q.weight[c] * s;
        const double both = 4 * q.weight[c] * q.weight[(c + 1) % 3];
        B[c] += both * s;
        D[c] += both * u;
      }
    };
    if (self >= 0) {
      scratch.clear();
      detail::polar_points<detail::setup::self_points>(e, Vec3<double>::Unit(self), scratch);
      for (const auto& q : scratch) add(q);
      return;
    }
    const double distance = (e.centre - x).norm();
    if (distance > detail::setup::three_point_elements * e.edge) {
      for (std::size_t q = 3 * t; q < 3 * t + 3; ++q) add(points3_[q]);
    } else if (distance > detail::setup::seven_point_elements * e.edge) {
      for (std::size_t q = 7 * t; q < 7 * t + 7; ++q) add(points7_[q]);
    } else {
      quarter(x, e, {Vec3<double>::Unit(0), Vec3<double>::Unit(1), Vec3<double>::Unit(2)}, 1, 0, add,
              scratch);
    }
  }

  // Cuts the triangle in four until its parts are small against their distance from x.
  template <class Add>
  void quarter(const Vec3<double>& x, const detail::Element& e, const std::array<Vec3<double>, 3>& part,
               double share, int level, const Add& add, std::vector<detail::ElementPoint>& scratch) const {
    const Vec3<double> p[3] = {e.at(part[0]), e.at(part[1]), e.at(part[2])};
    const double edge = std::sqrt(
        (std::max)({(p[0] - p[1]).squaredNorm(), (p[1] - p[2]).squaredNorm(), (p[2] - p[0]).squaredNorm()}));
    const Vec3<double> w = detail::closest_on_triangle<double>(x, p[0], p[1], p[2]);
    const double distance = (w[0] * p[0] + w[1] * p[1] + w[2] * p[2] - x).norm();
    if (distance > detail::setup::near_elements * edge || level == detail::setup::max_divisions) {
      for (const TrianglePoint& q : radon_rule()) {
        const Vec3<double> l = q.weight[0] * part[0] + q.weight[1] * part[1] + q.weight[2] * part[2];
        const Vec3<double> n = (0.5 * share * q.share) * e.normal(l);
        add(detail::ElementPoint{e.at(l), n, l, n.norm()});
      }
      return;
    }
    const std::array<Vec3<double>, 3> m = {0.5 * (part[0] + part[1]), 0.5 * (part[1] + part[2]),
                                           0.5 * (part[2] + part[0])};
    quarter(x, e, {part[0], m[0], m[2]}, share / 4, level + 1, add, scratch);
    quarter(x, e, {m[0], part[1], m[1]}, share / 4, level + 1, add, scratch);
    quarter(x, e, {m[2], m[1], part[2]}, share / 4, level + 1, add, scratch);
    quarter(x, e, {m[0], m[1], m[2]}, share / 4, level + 1, add, scratch);
  }

  ElementMesh mesh_;
  detail::MidEdgeFit mid_edge_fit_;
  Kelvin kelvin_;
  unsigned threads_;
  std::vector<detail::Element> elements_;
  std::vector<detail::ElementPoint> points7_, points3_;  // 7 and 3 per triangle
  std::vector<std::uint32_t> fixed_;
  detail::Matrix H_, G_, G_fixed_, H_fixed_;
  Eigen::PartialPivLU<detail::Matrix> lu_;
};

}  // namespace palpate
