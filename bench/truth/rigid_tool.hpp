// SPDX-License-Identifier: MIT
#pragma once

/// @file Rigid tools: exact signed distance, its gradient and curvature, and the tool's pose.
///
/// Lengths in mm, in the tool's own frame; the distance is negative inside.

#include "truth/case.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace bench {

/// Where a tool's origin is, and how the tool is rotated about it.
struct Pose {
  V origin = V::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
/// The pose a share of the way from `a` to `b`: the origin along a line, the rotation about a fixed axis.
inline Pose between(const Pose& a, const Pose& b, double share) {
  return {a.origin + share * (b.origin - a.origin), a.rotation.slerp(share, b.rotation)};
}

/// Signed distance and its gradient, a unit vector.
struct Distance {
  double value;
  V gradient;
};

struct RigidTool {
  enum Kind {
    ball,       ///< size.x: radius
    capsule,    ///< size.x: radius, size.y: length of its axis, which lies along x
    box,        ///< size: edges, rounding included
    cylinder,   ///< size.x: radius, size.y: height along y, rounding included
    ellipsoid,  ///< size: semi-axes
    mesh        ///< triangles, and what is nearer to them than the rounding
  } kind = ball;
  V size = V::Zero();
  double rounding = 0;  ///< radius of the edges of box, cylinder, mesh
  palpate::MeshData<double> triangles;

  Distance distance(const V& y) const {
    switch (kind) {
      case ball:
        return off(y, size.x());
      case capsule:
        return off(y - std::clamp(y.x(), -size.y() / 2, size.y() / 2) * V::UnitX(), size.x());
      case box:
        return around_core<3>(y, size / 2);
      case cylinder: {
        const double r = std::hypot(y.x(), y.z());
        const V out = r > 0 ? V(y.x() / r, 0, y.z() / r) : V::UnitX();
        const auto [value, g] = around_core<2>(V(r, y.y(), 0), V(size.x(), size.y() / 2, 0));
        return {value, g.x() * out + g.y() * V::UnitY()};
      }
      case ellipsoid:
        return of_ellipsoid(y);
      case mesh:
        return of_mesh(y);
    }
    return {};
  }
  /// Second derivatives of the distance, by central differences.
  Eigen::Matrix3d curvature(const V& y) const {
    constexpr double h = 1e-5;
    Eigen::Matrix3d H;
    for (int k = 0; k < 3; ++k)
      H.col(k) = (distance(y + h * V::Unit(k)).gradient - distance(y - h * V::Unit(k)).gradient) / (2 * h);
    return (H + H.transpose()) / 2;
  }
  /// The largest extent from the origin.
  double extent() const {
    double most = size.norm();
    for (const V& p : triangles.vertices) most = (std::max)(most, p.norm() + rounding);
    return most;
  }

 private:
  static Distance off(const V& y, double radius) {
    const double r = y.norm();
    return {r - radius, r > 0 ? V(y / r) : V::UnitY()};
  }
  // What is nearer than the rounding to a box of as many axes, whose edges are shorter by it.
  template <int Axes>
  Distance around_core(const V& y, const V& half) const {
    V out = V::Zero();
    int nearest = 0;
    double inside = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < Axes; ++k) {
      const double beyond = std::abs(y[k]) - (half[k] - rounding);
      out[k] = std::copysign((std::max)(beyond, 0.0), y[k]);
      if (beyond > inside) inside = beyond, nearest = k;
    }
    if (inside > 0) return off(out, rounding);
    return {inside - rounding, std::copysign(1.0, y[nearest]) * V::Unit(nearest)};
  }
  // The nearest point a_k^2 y_k / (t + a_k^2) has sum (a_k y_k / (t + a_k^2))^2 = 1: convex and falling in t.
  Distance of_ellipsoid(const V& y) const {
    const V square = size.cwiseProduct(size);
    double t = (size.cwiseProduct(y.cwiseAbs()) - square).maxCoeff();
    for (int i = 0; i < 100; ++i) {
      double sum = -1, slope = 0;
      for (int k = 0; k < 3; ++k) {
        const double below = t + square[k], share = below != 0 ? size[k] * y[k] / below : 1;
        sum += share * share;
        if (below != 0) slope -= 2 * share * share / below;
      }
      if (!(sum > 1e-15) || !(slope < 0)) break;
      t -= sum / slope;
    }
    V nearest, normal;
    for (int k = 0; k < 3; ++k) {
      nearest[k] = square[k] * y[k] / (t + square[k]);
      normal[k] = y[k] / (t + square[k]);
    }
    normal.normalize();
    return {normal.dot(y - nearest), normal};
  }
  Distance of_mesh(const V& y) const {
    V nearest = V::Constant(1e300);
    for (const auto& t : triangles.triangles) {
      const V p = nearest_on_triangle(y, triangles.vertices[t[0]], triangles.vertices[t[1]],
                                      triangles.vertices[t[2]]);
      if ((p - y).squaredNorm() < (nearest - y).squaredNorm()) nearest = p;
    }
    return off(y - nearest, rounding);
  }
  static V nearest_on_triangle(const V& y, const V& a, const V& b, const V& c) {
    const V n = (b - a).cross(c - a);
    const V p = y - n * (n.dot(y - a) / n.squaredNorm());
    const std::array<std::pair<V, V>, 3> edges{{{a, b}, {b, c}, {c, a}}};
    V best = p;
    bool inside = true;
    for (const auto& [from, to] : edges)
      if (n.cross(to - from).dot(p - from) < 0) {
        const V along = to - from;
        const V q = from + std::clamp((y - from).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
        if (inside || (q - y).squaredNorm() < (best - y).squaredNorm()) best = q;
        inside = false;
      }
    return best;
  }
};

}  // namespace bench
