// SPDX-License-Identifier: MIT
#pragma once

/// @file Where a response field can be touched: the boundary element mesh's surface, cut into triangles
/// between positions of loads. Made by load_positions.hpp.

#include <palpate/config.hpp>
#include <palpate/geometry/bvh.hpp>

#include <optional>
#include <span>

namespace palpate {

/// A position among the nodes: weights >= 0 that sum to 1. Continuous in the point it was found from, near
/// the surface.
struct LoadPosition {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 3> node{};
  Vec3<double> weight = Vec3<double>::UnitX();
  double distance2 = 0;  ///< squared, from the point to the position [m^2]
};

/// A position where a load acts, on the surface of the boundary element mesh.
struct LoadNode {
  Vec3<double> normal;                      ///< outward, unit
  Vec3<double> source;                      ///< the position [m]
  double size = 0;                          ///< mean length of the boundary element mesh's edges around [m]
  double spacing = 0;                       ///< mean distance to the nodes around [m]
  std::uint32_t triangle = 0;               ///< of the boundary element mesh, that contains the position
  Vec3<float> part = Vec3<float>::UnitX();  ///< weights of its corners
  bool crease = false;                      ///< on a crease, or drawn inwards from one
};

/// The whole surface of the boundary element mesh, fixed region included: closed, so that the position of a
/// point of the surface never jumps, at a rim or across a thin part. Its nodes, in this order:
///
/// | nodes  | where                                              | field of a load                          |
/// |--------|----------------------------------------------------|------------------------------------------|
/// | solved | element nodes with a free triangle; edges' middles | boundary equation                        |
/// | fixed  | the other nodes                                    | none: w = -u_near                        |
/// | edge   | element vertices where smooth parts meet           | mean of the loads of the nodes that meet |
///
/// Only solved nodes have influence functions; the others' loads are shared among them (`shares`), and what
/// is left acts on the fixed region and moves nothing. At most three parts of an edge node count.
///
/// The loads of a crease's nodes lie inside their own parts; a contact that crosses a crease goes over
/// gradually from one part's nodes to the edge's and on to the other part's.
class LoadMesh {
 public:
  /// Part of a node's load.
  struct Share {
    std::uint32_t node;  ///< solved
    float weight;
  };
  static constexpr std::size_t most_parts = 3;
  /// A solved node beneath a triangle, and its parts of the loads at the triangle's corners.
  struct Beneath {
    std::uint32_t node;
    Vec3<float> part;
  };
  static constexpr std::size_t most_beneath = 3 * most_parts;

  LoadMesh() = default;

  LoadMesh(std::vector<LoadNode> nodes, std::vector<std::array<std::uint32_t, 3>> triangles,
           std::vector<std::uint32_t> share_begin, std::vector<Share> shares)
      : nodes_(std::move(nodes)),
        triangles_(std::move(triangles)),
        solved_(nodes_.size() + 1 - share_begin.size()),
        share_begin_(std::move(share_begin)),
        shares_(std::move(shares)) {
    index();
  }

  /// Number of solved nodes.
  [[nodiscard]] std::size_t solved() const noexcept { return solved_; }
  /// Solved nodes that share the load of a node that is not solved.
  [[nodiscard]] std::span<const Share> shares(std::size_t k) const noexcept {
    const std::uint32_t first = share_begin_[k - solved_];
    return {shares_.data() + first, share_begin_[k - solved_ + 1] - first};
  }
  [[nodiscard]] std::span<const Beneath> beneath(std::uint32_t triangle) const noexcept {
    const std::uint32_t first = beneath_begin_[triangle];
    return {beneath_.data() + first, beneath_begin_[triangle + 1] - first};
  }
  /// By node that is not solved, the first of its shares, and one more; the shares.
  [[nodiscard]] const std::vector<std::uint32_t>& share_begin() const noexcept { return share_begin_; }
  [[nodiscard]] const std::vector<Share>& all_shares() const noexcept { return shares_; }
  [[nodiscard]] const std::vector<LoadNode>& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const std::vector<std::array<std::uint32_t, 3>>& triangles() const noexcept {
    return triangles_;
  }

  /// The position x = sum weight (source + d normal) with d the distance along the interpolated normal; the
  /// nearest position where there is none close by. The nearest position of a point over a reflex edge jumps,
  /// this one does not. The start of the search depends on x alone, so the result does not depend on earlier
  /// calls.
  [[nodiscard]] LoadPosition locate(const Vec3<double>& x) const noexcept {
    const auto at = bvh_->closest(x, start_[cell(x)]);
    LoadPosition position{at.triangle, triangles_[at.triangle], at.weight, at.distance2};
    if (at.distance2 > 0) follow_normals(x, at.position, position);
    return position;
  }
  /// The same, begun at a triangle close by: a tenth of the time, and equal to rounding near the surface.
  [[nodiscard]] LoadPosition locate(const Vec3<double>& x, std::uint32_t triangle) const noexcept {
    const auto& t = triangles_[triangle];
    LoadPosition position{triangle, t, Vec3<double>::Constant(1. / 3), 0};
    if (!follow_normals(x, position_of(position), position)) return locate(x);
    position.distance2 = (x - position_of(position)).squaredNorm();
    return position;
  }

 private:
  static constexpr int cells = 16;  // along each axis

  [[nodiscard]] Vec3<double> position_of(const LoadPosition& p) const noexcept {
    Vec3<double> x = Vec3<double>::Zero();
    for (std::size_t c = 0; c < 3; ++c) x += p.weight[Eigen::Index(c)] * nodes_[p.node[c]].source;
    return x;
  }
  // From a position nearby over the triangles' prisms, which share their sides. Leaves `position` alone and
  // returns false if none contains x.
  bool follow_normals(const Vec3<double>& x, const Vec3<double>& nearest,
                      LoadPosition& position) const noexcept {
    std::uint32_t t = position.triangle;
    Vec3<double> n = Vec3<double>::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      n += position.weight[Eigen::Index(c)] * nodes_[position.node[c]].normal;
    double d = (x - nearest).dot(n);
    for (int step = 0; step < 12; ++step) {
      const LoadNode &p = nodes_[triangles_[t][0]], &q = nodes_[triangles_[t][1]],
                     &r = nodes_[triangles_[t][2]];
      const Vec3<double> dq = q.normal - p.normal, dr = r.normal - p.normal;
      Vec3<double> eq, er, to, area;
      const auto offset = [&] {
        eq = q.source - p.source + d * dq;
        er = r.source - p.source + d * dr;
        to = x - p.source - d * p.normal;
        area = eq.cross(er);
      };
      offset();
      for (int newton = 0; newton < 4; ++newton) {  // d for which the offset triangle's plane contains x
        const double slope = (dq.cross(er) + eq.cross(dr)).dot(to) - area.dot(p.normal),
                     height = area.dot(to);
        if (!(slope < 0)) return false;
        d -= height / slope;
        offset();
        // Newton's method leaves an error of the square of its last step.
        if (height * height < 1e-10 * slope * slope * eq.squaredNorm()) break;
      }
      const double a2 = area.squaredNorm();
      if (!(a2 > 0)) return false;
      Vec3<double> l(0, to.cross(er).dot(area) / a2, eq.cross(to).dot(area) / a2);
      l[0] = 1 - l[1] - l[2];
      Eigen::Index least = 0;
      if (l.minCoeff(&least) > -1e-9) {
        l = l.cwiseMax(0.0);
        position = {t, triangles_[t], l / l.sum(), position.distance2};
        return true;
      }
      t = across_[t][static_cast<std::size_t>(least)];
    }
    return false;
  }

  // Everything that follows from nodes and triangles.
  void index();
  void find_neighbours();
  void find_beneath();
  [[nodiscard]] std::size_t cell(const Vec3<double>& x) const noexcept {
    std::size_t at = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double s = (x[axis] - low_[axis]) * per_size_[axis];
      at = at * cells + (s > 0 ? static_cast<std::size_t>((std::min)(s, cells - 0.5)) : 0);
    }
    return at;
  }

  std::vector<LoadNode> nodes_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::size_t solved_ = 0;
  std::vector<std::uint32_t> share_begin_{0};
  std::vector<Share> shares_;
  std::optional<TriangleBvh<double>> bvh_;
  std::vector<std::array<std::uint32_t, 3>> across_;
  std::vector<std::uint32_t> beneath_begin_;  // by triangle, and one more
  std::vector<Beneath> beneath_;
  std::vector<std::uint32_t> start_;  // per cell, a triangle near it
  Vec3<double> low_ = Vec3<double>::Zero(), per_size_ = Vec3<double>::Ones();
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/load_mesh_impl.hpp>
#endif
