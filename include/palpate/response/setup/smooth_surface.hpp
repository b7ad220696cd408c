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
#include <palpate/geometry/detail/corner_weight.hpp>
#include <palpate/response/setup/constants.hpp>
#include <palpate/response/setup/mesh_edges.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace palpate {

namespace detail {
/// Distance [m] through the inside of a closed mesh from a point of it, at most `most`; `most` where nothing
/// is met.
[[nodiscard]] inline double way_through(const TriangleBvh<double>& tree, const Vec3d& from,
                                        const Vec3d& inward, double most) noexcept {
  const double skip = setup::ray_start * most;
  const auto hit = tree.raycast(from + skip * inward, inward);
  return hit.triangle == TriangleBvh<double>::none ? most : (std::min)(skip + hit.t, most);
}
}  // namespace detail

/// A closed mesh with its creases, corner normals and closest-point tree.
class SmoothSurface {
 public:
  /// Edges that turn by more than this stay sharp.
  static constexpr double crease_cosine = detail::setup::crease_cosine;

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
    std::vector<Vec3d> face;
    std::vector<double> area;
    for (const auto& c : mesh_.triangles) {
      face.push_back(area_vector(mesh_.vertices[c[0]], mesh_.vertices[c[1]], mesh_.vertices[c[2]]));
      area.push_back(face.back().norm());
    }
    double volume = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      volume += face[t].dot(mesh_.vertices[mesh_.triangles[t][0]] - mesh_.vertices[0]) / 3;
    if (!(volume > 0))
      fail(where, "triangles must be counter-clockwise seen from outside: volume [m^3] must be > 0", volume);
    crease_.resize(edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const std::uint32_t l = edges_[e].triangle[0], r = edges_[e].triangle[1];
      // A triangle without area makes no crease.
      crease_[e] = face[l].dot(face[r]) < crease_cosine * area[l] * area[r];
    }
    std::uint32_t fans = 0;
    const std::vector<std::uint32_t> fan = corner_fans(mesh_.triangles, edges_, crease_, fans);
    std::vector<double> largest(fans, 0);
    for (std::size_t i = 0; i < fan.size(); ++i) largest[fan[i]] = (std::max)(largest[fan[i]], area[i / 3]);
    std::vector<Vec3d> normal(fans, Vec3d::Zero());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Vec3d n = unit_or(face[t], Vec3d(Vec3d::Zero()));
      for (std::uint32_t c = 0; c < 3; ++c) {
        const Vec3d& p = mesh_.vertices[mesh_.triangles[t][c]];
        const Vec3d u = mesh_.vertices[mesh_.triangles[t][(c + 1) % 3]] - p,
                    v = mesh_.vertices[mesh_.triangles[t][(c + 2) % 3]] - p;
        const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
        normal[fan[3 * t + c]] += n * corner_weight(angle, area[t], largest[fan[3 * t + c]]);
      }
    }
    corner_normal_.resize(fan.size());
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const Vec3d own = unit_or(face[i / 3], Vec3d(Vec3d::UnitZ()));
      corner_normal_[i] = unit_or(normal[fan[i]], own);
    }
  }

  [[nodiscard]] const MeshData<double>& mesh() const noexcept { return mesh_; }
  [[nodiscard]] const std::vector<detail::MeshEdge>& edges() const noexcept { return edges_; }
  [[nodiscard]] bool is_crease(std::size_t edge) const noexcept { return crease_[edge] != 0; }

  /// Position and unit normal of the smooth surface at a position of the mesh.
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
  /// Perimeter [m] of the part that the normal at the surface's point near x crosses over a thickness t, if
  /// the part is slender: that of an ellipse as thick as this and as wide as the second shortest of four ways
  /// through the middle of the crossing, 45 degrees apart. Of these at least two go across a slender part, by
  /// 1.1 to 1.4 times its width; across a plate only one, at its corners.
  [[nodiscard]] double perimeter_at(const Vec3<double>& x, double thickness, double most) const noexcept {
    Vec3<double> p, n;
    const auto at = tree_->closest(x);
    evaluate(at, p, n);
    const Vec3<double> middle = at.position - 0.5 * thickness * n, u = n.unitOrthogonal(), v = n.cross(u);
    std::array<double, 4> width;
    for (std::size_t i = 0; i < 4; ++i) {
      const double angle = 0.25 * std::numbers::pi * double(i);
      const Vec3<double> along = std::cos(angle) * u + std::sin(angle) * v;
      width[i] = detail::way_through(*tree_, middle, along, most) +
                 detail::way_through(*tree_, middle, -along, most);
    }
    std::sort(width.begin(), width.end());
    return std::numbers::pi * std::hypot(thickness, width[1]) / std::numbers::sqrt2;
  }

 private:
  MeshData<double> mesh_;
  std::vector<detail::MeshEdge> edges_;
  std::vector<std::uint8_t> crease_;
  std::vector<Vec3<double>> corner_normal_;  // 3 per triangle
  std::optional<TriangleBvh<double>> tree_;
};

}  // namespace palpate
