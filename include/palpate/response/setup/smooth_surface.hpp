// SPDX-License-Identifier: MIT
#pragma once

/// @file The smooth surface that a triangle mesh stands for: creases stay sharp, between them triangles bulge
/// to meet the vertices' tangent planes. Set-up only.
///
/// Point of a triangle with corners p_i, corner normals n_i, barycentric weights l_i, flat point p = sum l_i
/// p_i:
///     x = p - 1/2 sum l_i ((p - p_i) . n_i) n_i
/// The factor 1/2 makes it exact to third order for a quadric. Source: [boubekeur2008].

#include <palpate/geometry/bvh.hpp>

#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace palpate {

namespace detail {
using Vec3d = Vec3<double>;
using Triangle = std::array<std::uint32_t, 3>;

/// Key of an undirected edge.
[[nodiscard]] inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) noexcept {
  return a < b ? (std::uint64_t{a} << 32) | b : (std::uint64_t{b} << 32) | a;
}

/// An edge and the triangles on its two sides.
struct MeshEdge {
  std::uint64_t key;
  std::uint32_t triangle[2];
  std::uint8_t corner[2];  ///< the edge runs from corner c to corner (c + 1) % 3 of its triangle
  [[nodiscard]] std::uint32_t a() const noexcept { return static_cast<std::uint32_t>(key >> 32); }
  [[nodiscard]] std::uint32_t b() const noexcept { return static_cast<std::uint32_t>(key); }
};

/// The edges of a closed mesh, sorted by key. Reports where the mesh is not closed.
[[nodiscard]] inline std::vector<MeshEdge> mesh_edges(const std::vector<Triangle>& triangles,
                                                      const char* where) {
  struct Half {
    std::uint64_t key;
    std::uint32_t triangle;
    std::uint8_t corner;
  };
  std::vector<Half> half;
  half.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint8_t c = 0; c < 3; ++c)
      half.push_back({edge_key(triangles[t][c], triangles[t][(c + 1u) % 3]), t, c});
  std::sort(half.begin(), half.end(), [](const Half& l, const Half& r) {
    return l.key < r.key || (l.key == r.key && l.triangle < r.triangle);
  });
  std::vector<MeshEdge> edges;
  edges.reserve(half.size() / 2);
  for (std::size_t i = 0; i < half.size(); i += 2) {
    if (i + 1 >= half.size() || half[i].key != half[i + 1].key ||
        (i + 2 < half.size() && half[i + 2].key == half[i].key))
      fail_at(where, "mesh must be closed: each edge needs exactly two triangles", "triangle",
              half[i].triangle);
    const Half &l = half[i], &r = half[i + 1];
    if (triangles[l.triangle][l.corner] == triangles[r.triangle][r.corner])
      fail_at(where, "triangles must all be counter-clockwise seen from outside", "triangle", r.triangle);
    edges.push_back({l.key, {l.triangle, r.triangle}, {l.corner, r.corner}});
  }
  return edges;
}

[[nodiscard]] inline Vec3d area_vector(const Vec3d& a, const Vec3d& b, const Vec3d& c) noexcept {
  return 0.5 * (b - a).cross(c - a);
}

/// For each corner of each triangle the number of its fan: corners of one vertex that are joined across edges
/// that are not creases. Returns the fan of corner 3 t + c; `count` receives the number of fans.
[[nodiscard]] inline std::vector<std::uint32_t> corner_fans(const std::vector<Triangle>& triangles,
                                                            const std::vector<MeshEdge>& edges,
                                                            const std::vector<std::uint8_t>& crease,
                                                            std::uint32_t& count) {
  std::vector<std::uint32_t> parent(3 * triangles.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (crease[e]) continue;
    const MeshEdge& edge = edges[e];
    const std::uint32_t t0 = edge.triangle[0], t1 = edge.triangle[1], c0 = edge.corner[0],
                        c1 = edge.corner[1];
    // Start of the edge in one triangle is its end in the other.
    const std::uint32_t pairs[2][2] = {{3 * t0 + c0, 3 * t1 + (c1 + 1) % 3},
                                       {3 * t0 + (c0 + 1) % 3, 3 * t1 + c1}};
    for (const auto& pair : pairs) {
      const std::uint32_t a = root(pair[0]), b = root(pair[1]);
      parent[(std::max)(a, b)] = (std::min)(a, b);
    }
  }
  std::vector<std::uint32_t> fan(parent.size()), number(parent.size(), ~0u);
  count = 0;
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    const std::uint32_t r = root(i);
    if (number[r] == ~0u) number[r] = count++;
    fan[i] = number[r];
  }
  return fan;
}

/// Way [m] through the inside of a closed mesh from a point of it, at most `most`; `most` where nothing is
/// met.
[[nodiscard]] inline double way_through(const TriangleBvh<double>& tree, const Vec3d& from,
                                        const Vec3d& inward, double most) noexcept {
  const double skip = 1e-4 * most;  // the triangles that the point lies on do not count
  const auto hit = tree.raycast(from + skip * inward, inward);
  return hit.triangle == TriangleBvh<double>::none ? most : (std::min)(skip + hit.t, most);
}
}  // namespace detail

/// A closed mesh with its creases, corner normals and closest-point tree.
class SmoothSurface {
 public:
  /// Edges that turn by more than this stay sharp.
  static constexpr double crease_cosine = 0.77;  // 40 degrees: between a 9-sided circle and a hexagonal prism

  SmoothSurface() = default;
  explicit SmoothSurface(MeshData<double> mesh) : mesh_(std::move(mesh)) {
    using namespace detail;
    static constexpr const char* where = "SmoothSurface";
    if (mesh_.triangles.size() < 4)
      fail(where, "mesh must be closed and have >= 4 triangles", double(mesh_.triangles.size()));
    for (std::size_t i = 0; i < mesh_.vertices.size(); ++i)
      if (!is_finite(mesh_.vertices[i])) fail_at(where, "vertices must be finite", "vertex", i);
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
      for (std::uint32_t v : mesh_.triangles[i])
        if (v >= mesh_.vertices.size()) fail_at(where, "triangle corners must be vertices", "triangle", i, v);
    edges_ = mesh_edges(mesh_.triangles, where);
    tree_.emplace(mesh_);
    const auto face = [&](std::uint32_t t) {
      const auto& c = mesh_.triangles[t];
      return area_vector(mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]);
    };
    double volume = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      volume += face(t).dot(mesh_.vertices[mesh_.triangles[t][0]] - mesh_.vertices[0]) / 3;
    if (!(volume > 0))
      fail(where, "triangles must be counter-clockwise seen from outside: volume [m^3] must be > 0", volume);
    crease_.resize(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const Vec3d l = face(edges_[e].triangle[0]), r = face(edges_[e].triangle[1]);
      crease_[e] = l.dot(r) < crease_cosine * l.norm() * r.norm();  // a triangle without area makes no crease
    }
    std::uint32_t fans = 0;
    const std::vector<std::uint32_t> fan = corner_fans(mesh_.triangles, edges_, crease_, fans);
    std::vector<Vec3d> normal(fans, Vec3d::Zero());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Vec3d n = unit_or(face(t), Vec3d(Vec3d::Zero()));
      for (std::uint32_t c = 0; c < 3; ++c) {
        const Vec3d& p = mesh_.vertices[mesh_.triangles[t][c]];
        const Vec3d u = mesh_.vertices[mesh_.triangles[t][(c + 1) % 3]] - p,
                    v = mesh_.vertices[mesh_.triangles[t][(c + 2) % 3]] - p;
        normal[fan[3 * t + c]] += n * std::atan2(u.cross(v).norm(), u.dot(v));
      }
    }
    corner_normal_.resize(fan.size());
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const Vec3d own = unit_or(face(static_cast<std::uint32_t>(i / 3)), Vec3d(Vec3d::UnitZ()));
      corner_normal_[i] = unit_or(normal[fan[i]], own);
    }
  }

  [[nodiscard]] const MeshData<double>& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const std::vector<detail::MeshEdge>& edges() const noexcept { return edges_; }
  [[nodiscard]] bool is_crease(std::size_t edge) const noexcept { return crease_[edge] != 0; }

  /// Position and unit normal of the smooth surface at a place of the mesh.
  void evaluate(const TriangleBvh<double>::Nearest& at, Vec3<double>& position,
                Vec3<double>& normal) const noexcept {
    const auto& t = mesh_.triangles[at.triangle];
    Vec3<double> bulge = Vec3<double>::Zero();
    normal.setZero();
    for (std::uint32_t c = 0; c < 3; ++c) {
      const Vec3<double>& n = corner_normal_[3 * at.triangle + c];
      bulge += at.weight[c] * (at.position - mesh_.vertices[t[c]]).dot(n) * n;
      normal += at.weight[c] * n;
    }
    normal = unit_or(normal, corner_normal_[3 * at.triangle]);
    position = at.position - 0.5 * bulge;
  }
  /// The smooth surface's point near x.
  [[nodiscard]] Vec3<double> project(const Vec3<double>& x) const noexcept {
    Vec3<double> p, n;
    evaluate(tree_->closest(x), p, n);
    return p;
  }
  [[nodiscard]] Vec3<double> normal_at(const Vec3<double>& x) const noexcept {
    Vec3<double> p, n;
    evaluate(tree_->closest(x), p, n);
    return n;
  }
  /// Thickness [m], along the normal, at the surface's point near x; at most `most` > 0.
  [[nodiscard]] double thickness_at(const Vec3<double>& x, double most) const noexcept {
    Vec3<double> p, n;
    const auto at = tree_->closest(x);
    evaluate(at, p, n);
    return detail::way_through(*tree_, at.position, -n, most);
  }

 private:
  MeshData<double> mesh_;
  std::vector<detail::MeshEdge> edges_;
  std::vector<std::uint8_t> crease_;
  std::vector<Vec3<double>> corner_normal_;  // 3 per triangle
  std::optional<TriangleBvh<double>> tree_;
};

}  // namespace palpate
