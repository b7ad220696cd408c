// SPDX-License-Identifier: MIT
#pragma once

/// @file Contact of a body's faces with rigid tools: a penalty normally, Coulomb's friction tangentially, at
/// seven points per six-node face.
///
/// Per undeformed area: pressure p = penalty * overlap; traction by return mapping, stiffness the penalty's,
/// limit mu p, from what it was at the last equilibrium, in the tool's frame. A point that comes into contact
/// slips from where it touched.

#include "truth/rigid_tool.hpp"

#include <Eigen/Dense>

#include <array>
#include <vector>

namespace bench {

/// A face's seven points, exact to the fifth degree.
struct FacePoint {
  std::array<double, 6> shape, by1, by2;
  double weight;
};
inline std::array<FacePoint, 7> face_points() {
  constexpr double r15 = 3.872983346207417, a[2] = {(6 - r15) / 21, (6 + r15) / 21},
                   w[2] = {(155 - r15) / 1200, (155 + r15) / 1200};
  std::array<FacePoint, 7> points;
  for (int q = 0; q < 7; ++q) {
    std::array<double, 3> l{1. / 3, 1. / 3, 1. / 3};
    if (q > 0) {
      l.fill(a[(q - 1) / 3]);
      l[(q - 1) % 3] = 1 - 2 * a[(q - 1) / 3];
    }
    const auto [l0, l1, l2] = l;
    points[q] = {
        {l0 * (2 * l0 - 1), l1 * (2 * l1 - 1), l2 * (2 * l2 - 1), 4 * l0 * l1, 4 * l1 * l2, 4 * l2 * l0},
        {1 - 4 * l0, 4 * l1 - 1, 0, 4 * (l0 - l1), 4 * l2, -4 * l2},
        {1 - 4 * l0, 0, 4 * l2 - 1, -4 * l1, 4 * l1, 4 * (l0 - l2)},
        q == 0 ? 0.225 : w[(q - 1) / 3]};
  }
  return points;
}

/// What a tool does to the body.
struct ToolLoad {
  V force = V::Zero(), torque = V::Zero();  ///< [N], about the tool's origin [N mm]
  double area = 0, stuck = 0;               ///< deformed area that touches, and of it what sticks [mm^2]
};

class Contact {
 public:
  std::vector<RigidTool> tools;
  std::vector<Pose> poses;
  double penalty = 0, friction = 0;  ///< [MPa/mm], -
  double share = 1;                  ///< of the penalty, for a softer start
  bool holds = false;                ///< friction without its limit where nothing slid before

  /// `faces`: the body's that may touch, by node.
  Contact(std::vector<RigidTool> rigid, std::vector<std::array<int, 6>> faces)
      : tools(std::move(rigid)), poses(tools.size()), faces_(std::move(faces)) {}

  /// Residual and tangent of each face, as add(unknowns, r, k).
  template <class Add>
  void assemble(const std::vector<V>& nodes, const Eigen::VectorXd& x, Add add) {
    points_.resize(faces_.size() * 7 * tools.size());
    loads_.assign(tools.size(), {});
    Point* point = points_.data();
    for (const auto& face : faces_) {
      Eigen::Matrix<double, 18, 18> k = Eigen::Matrix<double, 18, 18>::Zero();
      Eigen::Matrix<double, 18, 1> r = Eigen::Matrix<double, 18, 1>::Zero();
      for (const FacePoint& at : quadrature_) {
        V position = V::Zero(), t1 = V::Zero(), t2 = V::Zero(), d1 = V::Zero(), d2 = V::Zero();
        for (int i = 0; i < 6; ++i) {
          const V &rest = nodes[face[i]], now = rest + x.segment<3>(3 * face[i]);
          position += at.shape[i] * now;
          t1 += at.by1[i] * rest;
          t2 += at.by2[i] * rest;
          d1 += at.by1[i] * now;
          d2 += at.by2[i] * now;
        }
        const double w = 0.5 * at.weight * t1.cross(t2).norm(), now = 0.5 * at.weight * d1.cross(d2).norm();
        for (std::size_t t = 0; t < tools.size(); ++t, ++point) {
          point->stretch = now / w;
          V traction;  // on the body
          Eigen::Matrix3d stiffness;
          if (!touch(t, position, *point, traction, stiffness)) continue;
          ToolLoad& load = loads_[t];
          load.force += w * traction;
          load.torque += w * (position - poses[t].origin).cross(traction);
          load.area += now;
          load.stuck += point->sticks ? now : 0;
          for (int i = 0; i < 6; ++i) {
            r.segment<3>(3 * i) -= w * at.shape[i] * traction;
            for (int j = 0; j < 6; ++j)
              k.block<3, 3>(3 * i, 3 * j) += w * at.shape[i] * at.shape[j] * stiffness;
          }
        }
      }
      std::array<int, 18> unknowns;
      for (int i = 0; i < 18; ++i) unknowns[i] = 3 * face[i / 3] + i % 3;
      add(unknowns, r, k);
    }
  }
  /// What was assembled last is the equilibrium from which points slip next; called before the first, too.
  void commit() {
    for (Point& p : points_) {
      p.anchor = p.position;
      p.gap_before = p.gap;
      p.traction_before = p.traction;
      p.slid_before = p.pressure > 0 && !p.sticks;
    }
  }
  /// Was there friction at the last equilibrium?
  bool rubs() const {
    return std::any_of(points_.begin(), points_.end(),
                       [](const Point& p) { return !p.traction_before.isZero(0); });
  }
  /// As of what was assembled last.
  const std::vector<ToolLoad>& loads() const { return loads_; }
  /// Traction of a tool on the body and pressure, per deformed area [MPa], as of what was assembled last:
  /// means over the faces' points around a node. f(node, traction, pressure) for nodes where there is any.
  template <class F>
  void tractions(std::size_t tool, const std::vector<V>& nodes, F f) const {
    struct Sum {
      V traction = V::Zero();
      double pressure = 0, weight = 0;
    };
    std::vector<Sum> sums(nodes.size());
    for (std::size_t k = 0; k < 7 * faces_.size(); ++k) {
      const Point& point = points_[k * tools.size() + tool];
      const V traction = poses[tool].rotation * (point.pressure * point.normal - point.traction);
      for (int i = 0; i < 6; ++i) {
        const FacePoint& at = quadrature_[k % 7];
        const double part = at.weight * at.shape[i] * at.shape[i] / point.stretch;
        Sum& s = sums[faces_[k / 7][i]];
        s.traction += part * traction;
        s.pressure += part * point.pressure;
        s.weight += part * point.stretch;
      }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (const Sum& s = sums[n]; s.pressure > 0) f(n, V(s.traction / s.weight), s.pressure / s.weight);
  }

 private:
  // A face's point and a tool, in the tool's frame. Traction: of friction, on the tool.
  struct Point {
    V anchor = V::Zero(), traction_before = V::Zero();
    double gap_before = 0;
    V position = V::Zero(), normal = V::Zero(), traction = V::Zero();
    double gap = 0, pressure = 0, stretch = 1;  // stretch: deformed area by undeformed
    bool sticks = false, slid_before = false;
  };

  // Traction of a tool on the body at a position, and minus its derivative there. False where it does not
  // touch.
  bool touch(std::size_t t, const V& position, Point& p, V& traction, Eigen::Matrix3d& stiffness) const {
    const Eigen::Matrix3d R = poses[t].rotation.toRotationMatrix();
    p.position = R.transpose() * (position - poses[t].origin);
    const auto [gap, n] = tools[t].distance(p.position);
    p.gap = gap;
    p.normal = n;
    p.pressure = 0;
    p.traction.setZero();
    if (!(gap < 0)) return false;
    const double stiff = share * penalty;
    p.pressure = -stiff * gap;
    const Eigen::Matrix3d H = tools[t].curvature(p.position);
    Eigen::Matrix3d k = stiff * n * n.transpose() - p.pressure * H;
    if (friction > 0) k += rub(p, H);
    traction = R * (p.pressure * n - p.traction);
    stiffness = R * k * R.transpose();
    return true;
  }
  // Sets a point's traction by return mapping. Its derivative but for what is not symmetric, foremost the
  // limit's: that couples to the tangential motion by curvature and 1 - 2 nu only, so it is hardly missed.
  Eigen::Matrix3d rub(Point& p, const Eigen::Matrix3d& H) const {
    const double stiff = share * penalty;
    const V& n = p.normal;
    // Of its way, what it went since it touched.
    const double part = p.gap_before > 0 ? p.gap / (p.gap - p.gap_before) : 1;
    const V v = p.traction_before + part * stiff * (p.position - p.anchor);
    const Eigen::Matrix3d T = Eigen::Matrix3d::Identity() - n * n.transpose();
    const V trial = T * v;
    const double size = trial.norm(), limit = friction * p.pressure;
    p.sticks = (holds && !p.slid_before) || size <= limit;
    p.traction = p.sticks ? trial : V(limit / size * trial);
    if (p.sticks) return part * stiff * T - n.dot(v) * H;
    return part * stiff * limit / size * (T - trial * trial.transpose() / (size * size));
  }

  std::vector<std::array<int, 6>> faces_;
  std::array<FacePoint, 7> quadrature_ = face_points();
  std::vector<Point> points_;
  std::vector<ToolLoad> loads_;
};

}  // namespace bench
