// SPDX-License-Identifier: MIT
#pragma once

/// @file Curvature of a triangle mesh, and the extremal points of a skeleton chosen from it (V.A). Set-up
/// only.

#include <palpate/geometry/detail/half_edges.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/geometry/mesh_surface.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace palpate {

/// Which extremal points a mesh gets.
template <Real S>
struct MeshExtremalParams {
  std::size_t at_most = 16;  ///< 6 .. max_extremal_points
  S radius = S(0.1L);  ///< rho of the curvature's average, part of the box's diagonal: [0.01, 0.5]; chosen
  S prominence = S(0.15L);  ///< least prominence, as a part of the range of curvature: (0, 1]; chosen
};

namespace detail {

/// Space in cubes of the given side; what falls into one cube is added up. For the averages of
/// mean_curvature().
class CurvatureCells {
 public:
  struct Cell {
    std::uint64_t key = 0;
    Vec3<double> position = Vec3<double>::Zero(), normal = Vec3<double>::Zero();  // integrals over area
    double area = 0, curvature = 0;  // integrals; curvature: of H
  };

  CurvatureCells(const Vec3<double>& low, double side) : low_(low), side_(side) {}

  void add(const Vec3<double>& x, const Vec3<double>& area_vector, double curvature) {
    const double area = area_vector.norm();
    cells_.push_back({key(cube(x)), area * x, area_vector, area, curvature});
  }
  void finish() {
    std::stable_sort(cells_.begin(), cells_.end(),
                     [](const Cell& a, const Cell& b) { return a.key < b.key; });
    std::size_t last = 0;
    for (std::size_t i = 1; i < cells_.size(); ++i) {
      if (cells_[i].key != cells_[last].key) {
        cells_[++last] = cells_[i];
        continue;
      }
      cells_[last].position += cells_[i].position;
      cells_[last].normal += cells_[i].normal;
      cells_[last].area += cells_[i].area;
      cells_[last].curvature += cells_[i].curvature;
    }
    cells_.resize((std::min)(cells_.size(), last + 1));
  }
  /// Calls visit(cell) for the cells within `reach` cubes of x along each axis.
  template <class Visit>
  void near(const Vec3<double>& x, std::int64_t reach, const Visit& visit) const {
    const auto c = cube(x);
    for (std::int64_t k = c[2] - reach; k <= c[2] + reach; ++k) {
      for (std::int64_t j = c[1] - reach; j <= c[1] + reach; ++j) {
        auto at = std::lower_bound(cells_.begin(), cells_.end(), key({c[0] - reach, j, k}),
                                   [](const Cell& cell, std::uint64_t value) { return cell.key < value; });
        for (const std::uint64_t end = key({c[0] + reach, j, k}); at != cells_.end() && at->key <= end; ++at)
          visit(*at);
      }
    }
  }

 private:
  using Cube = std::array<std::int64_t, 3>;
  // Far from 0, so that neighbours of the box are numbered as well; the box is below 2^20 cubes long.
  [[nodiscard]] Cube cube(const Vec3<double>& x) const {
    const Vec3<double> c = (x - low_) / side_;
    return {static_cast<std::int64_t>(c.x()) + 1000, static_cast<std::int64_t>(c.y()) + 1000,
            static_cast<std::int64_t>(c.z()) + 1000};
  }
  [[nodiscard]] static std::uint64_t key(const Cube& c) {
    return static_cast<std::uint64_t>(c[2]) << 42 | static_cast<std::uint64_t>(c[1]) << 21 |
           static_cast<std::uint64_t>(c[0]);
  }

  Vec3<double> low_;
  double side_;
  std::vector<Cell> cells_;
};

/// Prominence of every local maximum of `height` on the graph of the mesh's edges; -1 elsewhere. How far one
/// must go down from it to reach something higher; for the highest one, down to the lowest.
[[nodiscard]] inline std::vector<double> prominences(const std::vector<double>& height,
                                                     const std::vector<HalfEdge>& edges) {
  const std::size_t count = height.size();
  std::vector<std::uint32_t> start(count + 1, 0), to(2 * edges.size()), order(count), root(count);
  for (const HalfEdge& e : edges) ++start[e.low() + 1], ++start[e.high() + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
  for (const HalfEdge& e : edges) to[next[e.low()]++] = e.high(), to[next[e.high()]++] = e.low();
  std::iota(order.begin(), order.end(), 0u);
  const auto higher = [&](std::uint32_t a, std::uint32_t b) {
    return height[a] > height[b] || (height[a] == height[b] && a < b);
  };
  std::sort(order.begin(), order.end(), higher);
  constexpr std::uint32_t unseen = no_twin;
  std::fill(root.begin(), root.end(), unseen);
  const auto peak_of = [&](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::vector<double> result(count, -1);
  for (const std::uint32_t v : order) {
    root[v] = v;
    for (std::uint32_t i = start[v]; i < start[v + 1]; ++i) {
      if (root[to[i]] == unseen) continue;
      std::uint32_t a = peak_of(v), b = peak_of(to[i]);
      if (a == b) continue;
      if (higher(b, a)) std::swap(a, b);
      if (b != v) result[b] = height[b] - height[v];  // the lower peak ends here
      root[b] = a;
    }
  }
  for (std::uint32_t v = 0; v < count; ++v)
    if (root[v] == v) result[v] = height[v] - height[order.back()];  // the highest of each part
  return result;
}

}  // namespace detail

/// Mean curvature [1/m] at every vertex, averaged over a ball of radius rho [m]; positive where convex.
///
///     H(v) = sum_c K_c h_c / sum_c K_c a_c,   h = 1/2 sum_e |e| beta_e,   K = (1 - |x - v|^2 / rho^2)_+^2
///
/// h is the exact integral of mean curvature over a polyhedron: its edges' lengths times the angles that they
/// turn by, half to the triangle on each side; a is area [cohensteiner2003]. Sources are gathered in cubes c
/// of side rho / 4, and count where their normal is within a right angle of the vertex's, so that the other
/// side of a thin part is left out. An integral, and so indifferent to how the surface is cut into triangles
/// and, for rho well above the edges, to noise. Reports a radius that is not positive.
template <Real S>
[[nodiscard]] inline std::vector<S> mean_curvature(const TriangleMesh<S>& mesh, S radius) {
  require_positive(radius, "mean_curvature", "radius [m] must be > 0");
  const Vec3<double> low = mesh.lower().template cast<double>(),
                     extent = mesh.upper().template cast<double>() - low;
  // Cells are numbered with 21 bits along each axis.
  const double rho = (std::max)(static_cast<double>(radius), extent.maxCoeff() / 200000);
  const auto& t = mesh.triangles();
  const auto at = [&](std::uint32_t v) { return Vec3<double>(mesh.vertices()[v].template cast<double>()); };
  std::vector<Vec3<double>> area(t.size());
  detail::CurvatureCells cells(low, rho / 4);
  for (std::size_t i = 0; i < t.size(); ++i)
    area[i] = (at(t[i][1]) - at(t[i][0])).cross(at(t[i][2]) - at(t[i][0])) / 2;
  std::vector<double> turned(t.size(), 0);
  const std::vector<detail::HalfEdge> edges = detail::sorted_half_edges(t);
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {  // a checked mesh: two half-edges each
    const auto here = edges[i].id, there = edges[i + 1].id;
    const Vec3<double> e = at(t[here / 3][(here + 1) % 3]) - at(t[here / 3][here % 3]);
    const Vec3<double>&m = area[here / 3], &n = area[there / 3];
    const double length = e.norm(), turn = std::atan2(m.cross(n).dot(e) / length, m.dot(n));
    turned[here / 3] += length * turn / 4;
    turned[there / 3] += length * turn / 4;
  }
  for (std::size_t i = 0; i < t.size(); ++i)
    cells.add((at(t[i][0]) + at(t[i][1]) + at(t[i][2])) / 3, area[i], turned[i]);
  cells.finish();
  std::vector<S> result;
  result.reserve(mesh.vertices().size());
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    const Vec3<double> x = mesh.vertices()[v].template cast<double>(),
                       n = mesh.vertex_normals()[v].template cast<double>();
    double sum = 0, total = 0;
    cells.near(x, 5, [&](const detail::CurvatureCells::Cell& cell) {
      if (!(cell.area > 0) || !(cell.normal.dot(n) > 0)) return;
      const double left = 1 - (cell.position / cell.area - x).squaredNorm() / (rho * rho);
      if (!(left > 0)) return;
      sum += left * left * cell.curvature;
      total += left * left * cell.area;
    });
    result.push_back(total > 0 ? static_cast<S>(sum / total) : S(0));
  }
  return result;
}

/// Extremal points of a mesh's curvature, few and spread over it.
///
/// First the local maxima of mean_curvature(): vertices, rims, tips. They are ranked by prominence, which is
/// what changes least under noise [cohensteiner2007], and those below `prominence` of the range are dropped.
/// Then the ends of the principal axes of the surface, seen from its centroid: on an ellipsoid they are the
/// ends of the axes, among them the saddles of curvature, and with them the points lie on all sides, as a
/// partition needs. Then the local minima, dents and flats, likewise. A point beside an earlier one is left
/// out: nearer than 2 rho with normals less than 60 degrees apart, or nearer than rho / 2 and not on the
/// other side of a thin part. So is a minimum that is flat over 2 rho, as a box's face: it has no position.
/// Six of `at_most` are kept for the axes.
///
/// A body whose curvature varies by less than a tenth of its mean, as a sphere's, has the axes' ends only;
/// where its axes are equal as well, those of the coordinate axes.
///
/// Reports parameters out of range. Not all 64 points make a partition: see FacePartition on star-shaped
/// bodies.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const TriangleMesh<S>& mesh,
                                                                   const MeshExtremalParams<S>& params = {}) {
  constexpr const char* where = "extremal_points";
  if (params.at_most < 6 || params.at_most > max_extremal_points)
    fail(where, "at_most must be in 6 .. 64", static_cast<double>(params.at_most));
  if (!is_finite(params.radius) || !(params.radius >= S(0.01L) && params.radius <= S(0.5L)))
    fail(where, "radius must be in [0.01, 0.5] of the box's diagonal", static_cast<double>(params.radius));
  if (!is_finite(params.prominence) || !(params.prominence > S(0) && params.prominence <= S(1)))
    fail(where, "prominence must be in (0, 1]", static_cast<double>(params.prominence));
  const S rho = params.radius * (mesh.upper() - mesh.lower()).norm();
  const std::vector<S> curvature = mean_curvature(mesh, rho);
  std::vector<double> up(curvature.begin(), curvature.end()), down;
  double mean = 0;
  for (std::size_t v = 0; v < up.size(); ++v)
    mean += up[v] * static_cast<double>(mesh.vertex_areas()[v]) / static_cast<double>(mesh.area());
  for (const double h : up) down.push_back(-h);
  const double range = *std::max_element(up.begin(), up.end()) - *std::min_element(up.begin(), up.end());

  struct Peak {
    double prominence;
    std::uint32_t vertex;
    bool maximum;
  };
  std::vector<Peak> peaks;
  if (range > 0.1 * std::abs(mean)) {  // chosen: a body that varies by less is round
    const std::vector<detail::HalfEdge> edges = detail::sorted_half_edges(mesh.triangles());
    for (const auto* height : {&up, &down}) {
      const std::vector<double> all = detail::prominences(*height, edges);
      for (std::uint32_t v = 0; v < all.size(); ++v)
        if (all[v] >= static_cast<double>(params.prominence) * range)
          peaks.push_back({all[v], v, height == &up});
    }
    std::stable_sort(peaks.begin(), peaks.end(),
                     [](const Peak& a, const Peak& b) { return a.prominence > b.prominence; });
  }
  std::vector<ExtremalPoint<S>> points;
  const auto add = [&](const Vec3<S>& position, const Vec3<S>& normal, std::size_t most) {
    if (points.size() >= most) return;
    for (const ExtremalPoint<S>& p : points) {
      // Chosen, as the description says: 60 degrees, and 120 for the other side of a thin part.
      const S away = (p.position - position).norm(), along = p.normal.dot(normal);
      if ((away < S(2) * rho && along > S(0.5L)) || (away < rho / S(2) && along > S(-0.5L))) return;
    }
    points.push_back({position, normal});
  };
  const TriangleBvh<S> tree(mesh.data());
  const auto shading = [&](std::uint32_t triangle, const Vec3<S>& weight) {
    Vec3<S> n = Vec3<S>::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      n += weight[static_cast<int>(k)] * mesh.vertex_normals()[mesh.triangles()[triangle][k]];
    return n;
  };
  const auto add_peaks = [&](bool maxima, std::size_t most) {
    for (const Peak& peak : peaks) {
      if (peak.maximum != maxima) continue;
      // The middle of the peak's upper half: noise moves it less than the highest vertex.
      const Vec3<S>& top = mesh.vertices()[peak.vertex];
      const auto& height = maxima ? up : down;
      Vec3<S> sum = Vec3<S>::Zero();
      S total = S(0);
      bool flat = true;
      for (std::size_t v = 0; v < height.size(); ++v) {
        if (!((mesh.vertices()[v] - top).norm() < S(2) * rho)) continue;
        const double below = (height[peak.vertex] - height[v]) / peak.prominence;
        flat = flat && below < 0.05;  // chosen: a twentieth of the prominence
        if (!(below < 0.5)) continue;
        const S weight = static_cast<S>(0.5 - below) * mesh.vertex_areas()[v];
        sum += weight * (mesh.vertices()[v] - top);
        total += weight;
      }
      if (flat) continue;  // as a box's faces: no position is better than another
      const auto foot = tree.closest(top + sum / total);
      add(foot.position, unit_or<S>(shading(foot.triangle, foot.weight), mesh.vertex_normals()[peak.vertex]),
          most);
    }
  };
  add_peaks(true, params.at_most - 6);

  Mat3<double> spread = Mat3<double>::Zero();
  Vec3<double> middle = Vec3<double>::Zero();
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v)
    middle += static_cast<double>(mesh.vertex_areas()[v] / mesh.area()) *
              mesh.vertices()[v].template cast<double>();
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    const Vec3<double> e = mesh.vertices()[v].template cast<double>() - middle;
    spread += static_cast<double>(mesh.vertex_areas()[v] / mesh.area()) * e * e.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3<double>> axes(spread);
  // Axes within 5 % in their squares are equal (chosen): the eigenvectors of equal ones are arbitrary.
  const bool round = axes.eigenvalues()[2] < 1.05 * axes.eigenvalues()[0];
  for (int axis = 2; axis >= 0; --axis) {
    Vec3<double> d =
        round ? Vec3<double>(Vec3<double>::Unit(axis)) : Vec3<double>(axes.eigenvectors().col(axis));
    int greatest = 0;  // the same sign whatever the eigen solver gives
    d.cwiseAbs().maxCoeff(&greatest);
    if (d[greatest] < 0) d = -d;
    for (const double side : {-1.0, 1.0}) {
      const Vec3<S> towards = (-side * d).template cast<S>();
      const S away = S(2) * (mesh.upper() - mesh.lower()).norm();
      const auto hit = tree.raycast(mesh.centroid() - away * towards, towards);
      if (hit.triangle == tree.none) continue;
      add(mesh.centroid() + (hit.t - away) * towards, unit_or<S>(shading(hit.triangle, hit.weight), -towards),
          params.at_most);
    }
  }
  add_peaks(false, params.at_most);
  return points;
}

/// With the default parameters.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const MeshSurface<S>& body) {
  const auto vertices = body.bvh().vertices();
  const auto triangles = body.bvh().triangles();
  return extremal_points(
      TriangleMesh<S>(MeshData<S>{{vertices.begin(), vertices.end()}, {triangles.begin(), triangles.end()}}));
}

}  // namespace palpate
