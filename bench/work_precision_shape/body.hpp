// SPDX-License-Identifier: MIT
#pragma once

/// @file  The two reference bodies: data, tetrahedra that fit them, and how a shape is judged.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/geometry/detail/lattice_mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace bench {

using V = palpate::Vec3<double>;

struct Truth {
  std::string name;
  double E = 0, nu = 0.49, patch = 0;    // [Pa], [-], radius [m]
  V top = V::Zero();                     // centre of the patch [m]
  std::vector<double> depth{}, force{};  // [m], [N]
  std::vector<std::array<std::uint32_t, 3>> triangles{};
  std::vector<V> rest{};                       // [m]
  std::vector<double> area{}, r_over_a{};      // [m^2], [-]
  std::vector<std::vector<V>> displacement{};  // per depth [m]

  [[nodiscard]] bool in_patch(std::size_t v) const { return r_over_a[v] <= 1; }
  [[nodiscard]] double fixed_height() const {
    return is_cube() ? 1e-6 : -0.036 + 1e-6;
  }  // y up to which the body is fixed [m]
  [[nodiscard]] bool is_cube() const { return name == "cube"; }
};

inline Truth read_truth(const std::string& folder, const std::string& name) {
  Truth t{.name = name};
  t.E = t.is_cube() ? 1.0e6 : 1.5e6;
  t.patch = t.is_cube() ? 0.010 : 0.005;
  t.top = t.is_cube() ? V(0, 0.1, 0) : V(0, 0.04, 0);
  const auto rows = [&](const std::string& file, const auto& take) {
    std::ifstream in(folder + "/" + file);
    if (!in) {
      std::fprintf(stderr, "no %s/%s\n", folder.c_str(), file.c_str());
      std::exit(2);
    }
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::vector<double> values;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',');)
        values.push_back(std::strtod(cell.c_str(), nullptr));
      take(values);
    }
  };
  rows(name + "_force.csv", [&](const std::vector<double>& v) {
    t.depth.push_back(1e-3 * v.at(0));
    t.force.push_back(v.at(1));
  });
  rows(name + "_triangles.csv", [&](const std::vector<double>& v) {
    t.triangles.push_back({std::uint32_t(v.at(0)), std::uint32_t(v.at(1)), std::uint32_t(v.at(2))});
  });
  t.displacement.resize(t.depth.size());
  rows(name + ".csv", [&](const std::vector<double>& v) {
    t.rest.push_back(1e-3 * V(v.at(0), v.at(1), v.at(2)));
    t.area.push_back(1e-6 * v.at(3));
    t.r_over_a.push_back(v.at(4));
    for (std::size_t d = 0; d < t.depth.size(); ++d)
      t.displacement[d].push_back(1e-3 * V(v.at(5 + 3 * d), v.at(6 + 3 * d), v.at(7 + 3 * d)));
  });
  return t;
}

/// What the force half hands over: the patch, pushed straight down by d [m] with F [N].
inline palpate::ContactState<double> pressed(const Truth& t, double d, double F) {
  palpate::ContactState<double> contact{};
  contact.id = contact.points = 1;
  contact.mode = palpate::ContactMode::sticking;
  contact.centre = t.top - d * V::UnitY();
  contact.normal = V::UnitY();
  contact.displacement = -d * V::UnitY();
  contact.force = F * V::UnitY();
  contact.friction = V::Zero();
  contact.normal_force = F;
  contact.area = std::numbers::pi * t.patch * t.patch;
  return contact;
}

/// Relative errors of a shape at one depth: area weighted L2, the same beyond two patch radii, largest over
/// largest.
struct ShapeError {
  double l2 = 0, far_l2 = 0, most = 0;
};
inline ShapeError judge(const Truth& t, std::size_t depth, const std::vector<V>& u) {
  double e = 0, n = 0, far_e = 0, far_n = 0, most = 0, largest = 0;
  for (std::size_t v = 0; v < u.size(); ++v) {
    const V& exact = t.displacement[depth][v];
    const double d2 = (u[v] - exact).squaredNorm(), u2 = exact.squaredNorm();
    e += t.area[v] * d2;
    n += t.area[v] * u2;
    if (t.r_over_a[v] > 2) {
      far_e += t.area[v] * d2;
      far_n += t.area[v] * u2;
    }
    most = (std::max)(most, d2);
    largest = (std::max)(largest, u2);
  }
  return {std::sqrt(e / n), std::sqrt(far_e / far_n), std::sqrt(most / largest)};
}

/// Tetrahedra of 4 or 10 nodes for a reference body: a cube's lattice, 2n cells across, mapped to the body so
/// that one ring of its top face is the patch's rim and (ellipsoid) one ring of its bottom face the rim of
/// the fixed cap. Cells are thin and small at the patch: rings, blend and layers were chosen for the least
/// error of linear finite elements. A cell is cut in six along the diagonal that points outwards, so that no
/// tetrahedron is flat.
struct Tetrahedra {
  std::vector<V> node;
  std::vector<std::array<std::uint32_t, 10>> element;  // corners; then the middles of 01 12 20 03 13 23
  std::vector<char> fixed, patch;
  int order;                         // 1: the corners only
  std::vector<std::uint32_t> outer;  // elements at the surface

  [[nodiscard]] int corners() const { return order == 1 ? 4 : 10; }
};

namespace detail {

/// A point of the square's ring r = max(|x|, |z|) on the unit circle.
inline std::array<double, 2> on_circle(double x, double z) {
  constexpr double quarter = std::numbers::pi / 4;
  if (x == 0 && z == 0) return {0, 0};
  if (std::abs(x) >= std::abs(z)) {
    const double phi = quarter * z / x;
    return {std::copysign(std::cos(phi), x), std::copysign(std::sin(std::abs(phi)), z)};
  }
  const double phi = quarter * x / z;
  return {std::copysign(std::sin(std::abs(phi)), x), std::copysign(std::cos(phi), z)};
}
inline constexpr double rim_ring = 0.25;  // ring of the lattice that is a rim

/// Radius of ring r: even up to the rim's radius a, then in geometric growth to `end`.
inline double ring_radius(double r, double a, double end) {
  return r <= rim_ring ? a * r / rim_ring : a * std::pow(end / a, (r - rim_ring) / (1 - rim_ring));
}
inline double blend(double r) {
  const double t = (r - rim_ring) / (1 - rim_ring);
  return t > 0 ? t * t * t : 0;
}
inline constexpr double thin = 1.6;  // exponent by which layers grow from the surface inwards

inline V ellipsoid_direction(const V& d,
                             double patch) {  // of the unit ball, from a point of the cube's surface
  const V plain = palpate::detail::cube_to_sphere<double>(d);
  const double r = (std::max)(std::abs(d.x()), std::abs(d.z()));
  if (std::abs(d.y()) < 1 || r > 1) return plain;
  const auto [c, s] = on_circle(d.x(), d.z());
  V ring;
  if (d.y() > 0) {  // chord from the top in the ellipsoid's own size
    const double chord = ring_radius(r, patch, 0.025);
    double flat = chord;
    for (int i = 0; i < 60; ++i) {
      const double x = flat * c / 0.06, z = flat * s / 0.04, sink = 0.04 * (1 - std::sqrt(1 - x * x - z * z));
      flat = std::sqrt(chord * chord - sink * sink);
    }
    const double x = flat * c / 0.06, z = flat * s / 0.04;
    ring = V(x, std::sqrt(1 - x * x - z * z), z);
  } else {  // y = -36 mm is a circle of the unit ball
    const double angle = ring_radius(r, std::acos(0.9), 0.75);
    ring = V(std::sin(angle) * c, -std::cos(angle), std::sin(angle) * s);
  }
  return ((1 - blend(r)) * ring + blend(r) * plain).normalized();
}
inline V ellipsoid_position(const V& c, double patch) {
  const double rho = c.cwiseAbs().maxCoeff();
  if (rho == 0) return V::Zero();
  return V(0.06, 0.04, 0.04).cwiseProduct(ellipsoid_direction(c / rho, patch)) *
         (1 - std::pow(1 - rho, thin));
}
inline V cube_position(const V& c, double patch) {
  const double r = (std::max)(std::abs(c.x()), std::abs(c.z())), b = blend(r);
  const auto [cosine, sine] = on_circle(c.x(), c.z());
  const double ring = ring_radius(r, patch, 0.045), depth = (1 - c.y()) / 2;
  return {(1 - b) * ring * cosine + b * 0.05 * c.x(), 0.1 * (1 - std::pow(depth, thin)),
          (1 - b) * ring * sine + b * 0.05 * c.z()};
}

}  // namespace detail

/// `cells`: 2n, a multiple of 8.
inline Tetrahedra make_tetrahedra(const Truth& t, int cells, int order) {
  Tetrahedra mesh;
  mesh.order = order;
  const int n = cells / 2, points = order * cells + 1;
  const auto index = [&](int i, int j, int k) {  // of lattice coordinates in [-order n, order n]
    const int o = order * n;
    return static_cast<std::uint32_t>(((i + o) * points + (j + o)) * points + (k + o));
  };
  std::vector<char> outside;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j)
      for (int k = 0; k < points; ++k) {
        const V c = V(i, j, k) * 2 / (points - 1) - V::Ones();
        const V x = t.is_cube() ? detail::cube_position(c, t.patch) : detail::ellipsoid_position(c, t.patch);
        const bool surface = c.cwiseAbs().maxCoeff() == 1;
        outside.push_back(surface);
        mesh.node.push_back(x);
        mesh.fixed.push_back(t.is_cube() ? c.y() == -1 : surface && x.y() <= -0.036 + 1e-9);
        mesh.patch.push_back(surface && (x - t.top).norm() <= t.patch * (1 + 1e-9));
      }
  constexpr std::array<std::array<int, 3>, 6> paths{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (int i = -n; i < n; ++i)
    for (int j = -n; j < n; ++j)
      for (int k = -n; k < n; ++k) {
        const std::array<int, 3> low{i, j, k};
        std::array<int, 3> inner{}, step{};
        for (std::size_t a = 0; a < 3; ++a) {
          const bool mirrored = low[a] < 0 && !(t.is_cube() && a == 1);
          inner[a] = mirrored ? low[a] + 1 : low[a];
          step[a] = mirrored ? -1 : 1;
        }
        const bool outer = std::abs(2 * i + 1) == cells - 1 || std::abs(2 * j + 1) == cells - 1 ||
                           std::abs(2 * k + 1) == cells - 1;
        for (std::size_t p = 0; p < 6; ++p) {
          std::array<std::array<int, 3>, 4> at;
          at[0] = inner;
          for (std::size_t s = 0; s < 3; ++s) {
            at[s + 1] = at[s];
            const auto axis = static_cast<std::size_t>(paths[p][s]);
            at[s + 1][axis] += step[axis];
          }
          if ((p < 3) != (step[0] * step[1] * step[2] > 0)) std::swap(at[1], at[2]);
          std::array<std::uint32_t, 10> e{};
          for (std::size_t c = 0; c < 4; ++c)
            e[c] = index(order * at[c][0], order * at[c][1], order * at[c][2]);
          if (order == 2)
            for (std::size_t m = 0; m < 6; ++m) {
              const std::array<int, 3>&a = at[edges[m][0]], &b = at[edges[m][1]];
              const std::uint32_t middle = e[4 + m] = index(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
              // Edges inside are straight; those of the surface follow it.
              if (!outside[middle])
                mesh.node[middle] = 0.5 * (mesh.node[e[edges[m][0]]] + mesh.node[e[edges[m][1]]]);
            }
          if (outer) mesh.outer.push_back(static_cast<std::uint32_t>(mesh.element.size()));
          mesh.element.push_back(e);
        }
      }
  return mesh;
}

/// Shape functions of a tetrahedron at barycentric coordinates b, and their derivatives by b1, b2, b3.
inline void shape(int order, const std::array<double, 4>& b, std::array<double, 10>& N,
                  std::array<V, 10>& dN) {
  const std::array<V, 4> db{-V::Ones(), V::UnitX(), V::UnitY(), V::UnitZ()};
  if (order == 1) {
    for (std::size_t i = 0; i < 4; ++i) N[i] = b[i], dN[i] = db[i];
    return;
  }
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (std::size_t i = 0; i < 4; ++i) N[i] = b[i] * (2 * b[i] - 1), dN[i] = (4 * b[i] - 1) * db[i];
  for (std::size_t m = 0; m < 6; ++m) {
    const auto [p, q] = edges[m];
    N[4 + m] = 4 * b[p] * b[q];
    dN[4 + m] = 4 * (b[p] * db[q] + b[q] * db[p]);
  }
}

/// Display vertices bound to the tetrahedra: nodes and weights of the element that contains or is nearest to
/// each.
class Embedding {
 public:
  Embedding(const Tetrahedra& mesh, const Truth& truth)
      : corners_(std::size_t(mesh.corners())), truth_(&truth) {
    std::array<double, 10> N{};
    std::array<V, 10> dN;
    for (std::size_t v = 0; v < truth.rest.size(); ++v) {
      double best = -1e300;
      std::array<double, 4> at{};
      std::uint32_t element = 0;
      for (const std::uint32_t e : mesh.outer) {
        const auto& c = mesh.element[e];
        Eigen::Matrix3d edges;
        for (int i = 0; i < 3; ++i) edges.col(i) = mesh.node[c[std::size_t(i) + 1]] - mesh.node[c[0]];
        if ((truth.rest[v] - mesh.node[c[0]]).squaredNorm() > 9 * edges.colwise().squaredNorm().maxCoeff())
          continue;
        const V b = edges.inverse() * (truth.rest[v] - mesh.node[c[0]]);
        const std::array<double, 4> all{1 - b.sum(), b.x(), b.y(), b.z()};
        const double least = *std::min_element(all.begin(), all.end());
        if (least > best) best = least, at = all, element = e;
      }
      shape(mesh.order, at, N, dN);
      for (std::size_t i = 0; i < corners_; ++i) {
        node_.push_back(mesh.element[element][i]);
        weight_.push_back(N[i]);
      }
    }
  }
  /// Displacements at the display vertices; those of the patch move with the tool, by `tool`.
  void write(const std::vector<V>& u, const V& tool, std::vector<V>& out) const {
    for (std::size_t v = 0; v < out.size(); ++v) {
      if (truth_->in_patch(v)) {
        out[v] = tool;
        continue;
      }
      V sum = V::Zero();
      for (std::size_t i = v * corners_; i < (v + 1) * corners_; ++i) sum += weight_[i] * u[node_[i]];
      out[v] = sum;
    }
  }

 private:
  std::size_t corners_;
  const Truth* truth_;
  std::vector<std::uint32_t> node_;
  std::vector<double> weight_;
};

}  // namespace bench
