// SPDX-License-Identifier: MIT
#pragma once

/// @file Partition of the surface into faces between its extremal points, and the weights of every display
/// vertex (V.A.2).

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/luo_xiao/interpolation/detail/block.hpp>
#include <palpate/luo_xiao/interpolation/detail/hull.hpp>
#include <palpate/luo_xiao/interpolation/face.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// Faces and generalized barycentric weights over a surface that is star-shaped about a centre. No equation:
/// V.A.2 leaves the partition open; docs/shape.md gives the reading and what it rules out.
///
/// Faces: facets of the convex hull of the extremal points' directions from the centre. A flat facet of 4 to
/// 8 corners stays a polygon (a box has 6 quadrilaterals); one that is not flat in space, or of more corners,
/// is cut into triangles fanning from its lowest corner. Weights of a vertex: it is projected along its ray
/// from the centre into the plane of its face; there they are barycentric coordinates in a triangle,
/// Wachspress coordinates in a polygon. They are >= 0, sum to 1, are linear along edges (so continuous across
/// faces) and 1 at their corner, and reproduce affine functions of the point in that plane.
///
/// The contact point p with weights P splits its face: vertex v with weights L gets, for the contact,
///
///     mu(v) = min(1, min_i (L_i + max(0, h - P_i)) / max(P_i, h))
///
/// over all extremal points i; corner i gets max(0, L_i - mu P_i), scaled so that the sum is 1. With every
/// P_i either 0 or >= h this is exactly the split of p's face (of both faces where p is on an edge, of all
/// where it is on a corner). In the band 0 < P_i < h the split of the neighbours fades in, so that the
/// weights are continuous in p as well as in v, with slope O(1/h).
///
/// | symbol | name             | unit | range                                        |
/// |--------|------------------|------|----------------------------------------------|
/// | h      | `fade`           | -    | (0, 1/8), so that some P_i >= h; default 0.1 |
/// |        | extremal points  | m    | 4 .. 64, distinct, on all sides of the centre |
/// |        | centre           | m    | inside; default: mean of the extremal points |
///
/// Reports: lists of the wrong length, non-finite entries, a vertex at the centre, points that do not
/// surround the centre. Source: [wachspress1975].
template <Real S>
class FacePartition {
 public:
  using Scalar = S;

  struct Params {
    S fade{S(0.1)};  ///< h [-]; chosen: a little below the limit of 1/8
  };

  /// `normals` are the undeformed surface's at the mesh's vertices, unit.
  FacePartition(const MeshData<S>& mesh, std::span<const Vec3<S>> normals,
                std::span<const ExtremalPoint<S>> points, const Vec3<S>& centre, const Params& params = {})
      : p_(params), points_(points.begin(), points.end()), centre_(centre.template cast<double>()) {
    check(mesh, normals);
    build_faces();
    sort_vertices(mesh, normals);
  }
  FacePartition(const MeshData<S>& mesh, std::span<const Vec3<S>> normals,
                std::span<const ExtremalPoint<S>> points, const Params& params = {})
      : FacePartition(mesh, normals, points, mean(points), params) {}

  [[nodiscard]] std::span<const Face<S>> faces() const noexcept { return faces_; }
  [[nodiscard]] std::span<const ExtremalPoint<S>> points() const noexcept { return points_; }
  /// Number of display vertices, sorted by face into slots.
  [[nodiscard]] std::size_t size() const noexcept { return order_.size(); }
  /// The mesh vertex in each slot.
  [[nodiscard]] std::span<const std::uint32_t> order() const noexcept { return order_; }
  /// Of each slot, how many from it on are consecutive vertices of the mesh and of its face, itself included;
  /// at most 255.
  [[nodiscard]] std::span<const std::uint8_t> runs() const noexcept { return runs_; }
  /// Undeformed coordinate `axis` of the face's slots [m]. The list begins on a cache line and repeats the
  /// last slot up to `Face::length`.
  [[nodiscard]] const S* rest(const Face<S>& face, int axis) const noexcept {
    return rest_[static_cast<std::size_t>(axis)].data() + face.row;
  }
  /// The same from the face's slot number `from` on, all axes.
  [[nodiscard]] PALPATE_INLINE Lists<const S> rest_from(const Face<S>& face,
                                                        std::size_t from) const noexcept {
    return {rest(face, 0) + from, rest(face, 1) + from, rest(face, 2) + from};
  }
  /// Component `axis` of the undeformed unit normal of the face's slots, laid out alike.
  [[nodiscard]] const S* normal(const Face<S>& face, int axis) const noexcept {
    return normal_[static_cast<std::size_t>(axis)].data() + face.row;
  }
  /// Weights L of the face's slots at its corner number k, laid out alike. Those of the next corner begin
  /// `Face::length` further.
  [[nodiscard]] const S* weights(const Face<S>& face, std::size_t k = 0) const noexcept {
    return weights_.data() + face.weights + k * face.length;
  }
  /// Length of an AlignedList with an entry for each slot.
  [[nodiscard]] std::size_t list_length() const noexcept { return faces_.back().row + faces_.back().length; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

  /// Face and weights of the surface point in the direction of `position` from the centre.
  [[nodiscard]] PointWeights<S> locate(const Vec3<S>& position) const noexcept {
    PointWeights<S> at;
    if (!is_finite(position)) return at;
    const Vec3<double> ray = position.template cast<double>() - centre_;
    const double length = stable_norm(ray);
    if (!(length > 0)) return at;
    const Vec3<double> direction = ray / length;
    at.face = face_of(direction);
    const Face<S>& face = faces_[at.face];
    std::array<double, max_face_corners> weight{};
    at.valid = corner_weights(at.face, direction, weight);
    for (std::size_t k = 0; k < face.corners && at.valid; ++k)
      at.weight[face.corner[k]] = static_cast<S>(weight[k]);
    return at;
  }

  /// Max weight of the contact at `at` over `face`: 1 in its own face, 0 in faces that it does not split.
  [[nodiscard]] S share(const PointWeights<S>& at, std::size_t face) const noexcept {
    if (!at.valid) return S(0);
    const Face<S>& own = faces_[at.face];
    S share = S(1);
    for (std::size_t k = 0; k < own.corners; ++k) {
      if ((faces_[face].members >> own.corner[k] & 1u) != 0) continue;
      share = (std::min)(share, (std::max)(p_.fade - at.weight[own.corner[k]], S(0)) / p_.fade);
    }
    return share;
  }

  /// How the contact at `at` splits `face`.
  [[nodiscard]] FaceSplit<S> split(const PointWeights<S>& at, std::size_t face) const noexcept {
    const Face<S>& f = faces_[face];
    FaceSplit<S> split{};
    split.corners = f.corners;
    split.share = share(at, face);
    if (!(split.share > S(0))) return split;
    for (std::size_t k = 0; k < f.corners; ++k) {
      split.P[k] = at.weight[f.corner[k]];
      split.per_P[k] = S(1) / (std::max)(split.P[k], p_.fade);
      split.lift[k] = (std::max)(p_.fade - split.P[k], S(0)) * split.per_P[k];
    }
    return split;
  }

 private:
  static Vec3<S> mean(std::span<const ExtremalPoint<S>> points) {
    Vec3<S> sum = Vec3<S>::Zero();
    for (const ExtremalPoint<S>& point : points) sum += point.position;
    return points.empty() ? sum : Vec3<S>(sum / static_cast<S>(points.size()));
  }

  void check(const MeshData<S>& mesh, std::span<const Vec3<S>> normals) const {
    const auto count = [](std::size_t n) { return static_cast<double>(n); };
    if (points_.size() < 4) fail(name, "needs at least 4 extremal points", count(points_.size()));
    if (points_.size() > max_extremal_points)
      fail(name, "takes at most 64 extremal points", count(points_.size()));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!is_finite(points_[i].position) || !is_finite(points_[i].normal))
        fail_at(name, "position and normal must be finite", "extremal point", i);
    }
    if (!palpate::is_finite(Vec3<double>(centre_))) fail(name, "centre must be finite");
    if (!(p_.fade > S(0) && p_.fade < S(0.125)))
      fail(name, "fade must be in (0, 1/8)", static_cast<double>(p_.fade));
    if (mesh.vertices.empty()) fail(name, "mesh has no vertices");
    if (normals.size() != mesh.vertices.size())
      fail(name, "one normal per mesh vertex is needed", static_cast<double>(normals.size()));
    for (std::size_t i = 0; i < normals.size(); ++i) {
      if (!is_finite(mesh.vertices[i]) || !is_finite(normals[i]))
        fail_at(name, "position and normal must be finite", "mesh vertex", i);
    }
  }

  void build_faces() {
    std::vector<Vec3<double>> ray, direction;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      ray.push_back(points_[i].position.template cast<double>() - centre_);
      if (!(ray[i].norm() > 0)) fail_at(name, "must not be the centre", "extremal point", i);
      direction.push_back(ray[i].normalized());
    }
    double size = 0;
    for (const Vec3<double>& r : ray) size = (std::max)(size, r.norm());
    for (Vec3<double>& r : ray) r /= size;
    // Flat to 64 units in the last place of positions in S, and at least to 1e-9 of the size, so that
    // coordinates written with ten digits count as flat.
    const double flat = (std::max)(1e-9, 64.0 * static_cast<double>(std::numeric_limits<S>::epsilon()));
    for (const detail::Polygon& facet : detail::hull_facets(direction, flat, name)) {
      const Vec3<double> normal =
          (ray[facet[1]] - ray[facet[0]]).cross(ray[facet[2]] - ray[facet[0]]).normalized();
      bool whole = facet.size() <= max_face_corners;
      for (const std::uint32_t i : facet)
        whole = whole && std::abs(normal.dot(ray[i] - ray[facet[0]])) <= flat;
      if (whole) {
        add_face(facet, ray);
      } else {
        for (std::size_t k = 1; k + 1 < facet.size(); ++k) add_face({facet[0], facet[k], facet[k + 1]}, ray);
      }
    }
  }

  void add_face(const detail::Polygon& polygon, const std::vector<Vec3<double>>& ray) {
    Face<S> face;
    Cone cone;
    face.corners = polygon.size();
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::size_t before = polygon[(k + polygon.size() - 1) % polygon.size()], here = polygon[k],
                        after = polygon[(k + 1) % polygon.size()];
      face.corner[k] = polygon[k];
      face.members |= std::uint64_t{1} << polygon[k];
      cone.edge[k] = ray[here].cross(ray[after]);
      cone.corner[k] = ray[before].dot(cone.edge[k]);
    }
    faces_.push_back(face);
    cones_.push_back(cone);
  }

  // The face with the max distance to its nearest side plane, inside; on an edge the first, with the same
  // weights.
  [[nodiscard]] std::uint32_t face_of(const Vec3<double>& direction) const noexcept {
    std::uint32_t best = 0;
    double inside = -std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < faces_[f].corners; ++k)
        nearest = (std::min)(nearest, direction.dot(cones_[f].edge[k]));
      if (nearest > inside) inside = nearest, best = f;
    }
    return best;
  }

  // Wachspress coordinates in the form without division: weight k is the product of the distances to the
  // sides that do not end in corner k. For a triangle these are its barycentric coordinates.
  [[nodiscard]] bool corner_weights(std::size_t f, const Vec3<double>& direction,
                                    std::array<double, max_face_corners>& weight) const noexcept {
    const std::size_t n = faces_[f].corners;
    std::array<double, max_face_corners> side{};
    for (std::size_t k = 0; k < n; ++k) side[k] = (std::max)(direction.dot(cones_[f].edge[k]), 0.0);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      weight[k] = cones_[f].corner[k];
      for (std::size_t j = 0; j < n; ++j) {
        if (j != k && (j + 1) % n != k) weight[k] *= side[j];
      }
      sum += weight[k];
    }
    for (std::size_t k = 0; k < n; ++k) weight[k] /= sum;
    return sum > 0;
  }

  void sort_vertices(const MeshData<S>& mesh, std::span<const Vec3<S>> normals) {
    const std::size_t n = mesh.vertices.size();
    std::vector<std::vector<std::uint32_t>> members(faces_.size());
    for (std::size_t i = 0; i < n; ++i) {
      const PointWeights<S> at = locate(mesh.vertices[i]);
      if (!at.valid) fail_at(name, "must not be the centre", "mesh vertex", i);
      members[at.face].push_back(static_cast<std::uint32_t>(i));
    }
    std::size_t slots = 0, row = 0, weights = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      Face<S>& face = faces_[f];
      face.first = slots, face.row = row, face.weights = weights;
      face.count = members[f].size();
      face.length = AlignedList<S>::padded(face.count);
      slots += face.count, row += face.length, weights += face.corners * face.length;
    }
    weights_.resize(weights);
    for (auto* lists : {&rest_, &normal_}) {
      for (AlignedList<S>& list : *lists) list.resize(list_length());
    }
    order_.reserve(n);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      Face<S>& face = faces_[f];
      order_.insert(order_.end(), members[f].begin(), members[f].end());
      for (std::size_t j = 0; j < (face.count > 0 ? face.length : 0); ++j) {
        const std::uint32_t i = members[f][(std::min)(j, face.count - 1)];
        const PointWeights<S> at = locate(mesh.vertices[i]);
        for (std::size_t k = 0; k < face.corners; ++k)
          weights_[face.weights + k * face.length + j] = at.weight[face.corner[k]];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          rest_[axis][face.row + j] = mesh.vertices[i][static_cast<int>(axis)];
          normal_[axis][face.row + j] = normals[i][static_cast<int>(axis)];
        }
      }
      for (const std::uint32_t i : members[f]) face.centre += mesh.vertices[i] / static_cast<S>(face.count);
      for (const std::uint32_t i : members[f])
        face.radius = (std::max)(face.radius, (mesh.vertices[i] - face.centre).norm());
    }
    runs_.assign(n, 1);
    for (const Face<S>& face : faces_) {
      for (std::size_t j = face.count; j-- > 1;) {
        const std::size_t slot = face.first + j - 1;
        if (order_[slot + 1] == order_[slot] + 1)
          runs_[slot] = static_cast<std::uint8_t>((std::min)(runs_[slot + 1] + 1, 255));
      }
    }
  }

  static constexpr const char* name = "FacePartition";

  struct Cone {  // of a face, seen from the centre, in units of the max distance
    std::array<Vec3<double>, max_face_corners> edge;  // normal of the plane through the centre and side k
    std::array<double, max_face_corners> corner;      // volume spanned by corners k - 1, k, k + 1
  };

  Params p_;
  std::vector<ExtremalPoint<S>> points_;
  Vec3<double> centre_;
  std::vector<Face<S>> faces_;
  std::vector<Cone> cones_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint8_t> runs_;
  AlignedList<S> weights_;
  std::array<AlignedList<S>, 3> rest_, normal_;
};

/// The same mesh with its vertices in the partition's order. A partition made from it has order()[i] = i, so
/// that vertices are written one after the other instead of all over the buffer. That pays mostly with
/// normals.
template <Real S>
[[nodiscard]] MeshData<S> sorted_by_face(const MeshData<S>& mesh, const FacePartition<S>& partition) {
  if (mesh.vertices.size() != partition.size())
    fail("sorted_by_face", "mesh must be the partition's", static_cast<double>(mesh.vertices.size()));
  MeshData<S> sorted{{}, mesh.triangles};
  std::vector<std::uint32_t> slot_of(partition.size());
  for (std::uint32_t slot = 0; slot < slot_of.size(); ++slot) {
    slot_of[partition.order()[slot]] = slot;
    sorted.vertices.push_back(mesh.vertices[partition.order()[slot]]);
  }
  for (auto& triangle : sorted.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = slot_of[vertex];
  }
  return sorted;
}

namespace detail {
/// The centre is the mean of all but the last `further` points, so that these do not shift it.
template <class B, class Points, Real S>
[[nodiscard]] FacePartition<S> partition_over(const B& body, const MeshData<S>& mesh, const Points& points,
                                              std::size_t further,
                                              const typename FacePartition<S>::Params& params) {
  std::vector<Vec3<S>> normals;
  normals.reserve(mesh.vertices.size());
  for (const auto& vertex : mesh.vertices) normals.push_back(shading_normal(body, vertex));
  Vec3<S> centre = Vec3<S>::Zero();
  const std::size_t count = points.size() - further;
  for (std::size_t i = 0; i < count; ++i) centre += points[i].position;
  if (count > 0) centre /= static_cast<S>(count);
  return FacePartition<S>(mesh, normals, points, centre, params);
}
}  // namespace detail

/// Partition of a surface's display mesh over its own extremal points.
template <HasClosest B>
  requires HasExtremalPoints<B>
[[nodiscard]] FacePartition<typename B::Scalar> make_partition(
    const B& body, const MeshData<typename B::Scalar>& mesh,
    const typename FacePartition<typename B::Scalar>::Params& params = {}) {
  return detail::partition_over(body, mesh, extremal_points(body), 0, params);
}

/// The same with the point that does not move, `fixed` [m] (II: the bottom centre o), as a further corner,
/// after the extremal points, if it lies on the surface (to a thousandth of the body's size) and is none of
/// them: between the corners around it, it would move with them.
template <HasClosest B>
  requires HasExtremalPoints<B>
[[nodiscard]] FacePartition<typename B::Scalar> make_partition(
    const B& body, const MeshData<typename B::Scalar>& mesh, const Vec3<typename B::Scalar>& fixed,
    const typename FacePartition<typename B::Scalar>::Params& params = {}) {
  using S = typename B::Scalar;
  auto points = extremal_points(body);
  const S near = S(1e-3) * (body.upper() - body.lower()).norm();
  const SurfacePoint<S> at = body.closest(fixed);
  bool is_corner = is_finite(fixed) && std::abs(at.distance) <= near;
  for (const ExtremalPoint<S>& point : points)
    is_corner = is_corner && (point.position - fixed).norm() > near;
  if (is_corner) points.push_back({fixed, shading_normal(body, at.position)});
  return detail::partition_over(body, mesh, points, is_corner ? 1 : 0, params);
}

}  // namespace palpate
