// SPDX-License-Identifier: MIT
#pragma once

/// @file The fixed region of a body seen from afar: the half-space's field of its reaction, and the rigid
/// motion that keeps it at rest. Set-up, and at a few positions per tick.

#include <palpate/core/cholesky.hpp>
#include <palpate/core/error.hpp>
#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace palpate::detail {

/// Force and moment about the base's middle, or displacement and turn of a rigid body about it.
using Screw = Eigen::Matrix<double, 6, 1>;

/// Displacement at y from the middle.
[[nodiscard]] inline Vec3<double> rigid_motion(const Screw& w, const Vec3<double>& y) noexcept {
  return w.head<3>() + Vec3<double>(w.tail<3>()).cross(y);
}

/// A disc of the fixed region's area and middle, loaded as a rigid punch is. Fields are over the shear
/// modulus.
class FixedBase {
 public:
  using V = Vec3<double>;

  /// Reports, as `name`, vertices that are not finite or do not exist, and a region without area or within a
  /// line.
  template <Real S, class Fixed>
  FixedBase(const MeshData<S>& mesh, const Fixed& fixed, double nu, const char* name) : nu_(nu) {
    std::vector<V> position;
    std::vector<double> area;
    V outward = V::Zero();
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (!is_finite(mesh.vertices[v])) fail_at(name, "position must be finite", "mesh vertex", v);
      fixed_.push_back(fixed(mesh.vertices[v]) ? 1 : 0);
      position.push_back(mesh.vertices[v].template cast<double>());
      area.push_back(0);
    }
    double total = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      int count = 0;
      for (const std::uint32_t v : mesh.triangles[t]) {
        if (v >= fixed_.size()) fail_at(name, "vertex does not exist", "triangle", t, static_cast<double>(v));
        count += fixed_[v];
      }
      if (count < 3) continue;
      const V &a = position[mesh.triangles[t][0]], &b = position[mesh.triangles[t][1]],
              &c = position[mesh.triangles[t][2]];
      const V n = 0.5 * (b - a).cross(c - a);
      for (const std::uint32_t v : mesh.triangles[t]) area[v] += n.norm() / 3;
      total += n.norm();
      outward += n;
      middle_ += n.norm() / 3 * (a + b + c);
    }
    if (!(total > 0)) fail(name, "the fixed region must hold at least one triangle");
    middle_ /= total;
    radius_ = std::sqrt(total / std::numbers::pi);
    inward_ = unit_or<double>(-outward, V::UnitY());
    sample(position, area);
    set_up_fit(name);
  }

  [[nodiscard]] const std::vector<std::uint8_t>& fixed() const noexcept { return fixed_; }  ///< per vertex
  [[nodiscard]] const V& middle() const noexcept { return middle_; }                        ///< [m]
  [[nodiscard]] const V& inward() const noexcept { return inward_; }  ///< unit normal into the body

  /// The reaction to a force f at x.
  [[nodiscard]] Screw reaction(const V& x, const V& f) const noexcept {
    Screw q;
    q.head<3>() = -f;  // by halves: `<<` makes gcc 12 warn of bounds with -O3 -march=native
    q.tail<3>() = -(x - middle_).cross(f);
    return q;
  }
  /// The disc as y, from its middle, sees it.
  [[nodiscard]] Disc<double> disc(const V& y) const noexcept {
    const double z = y.dot(inward_);
    return Disc<double>((y - z * inward_).squaredNorm(), (std::max)(z, 0.0), radius_);
  }
  /// Field of a load at y from the middle.
  [[nodiscard]] V field(const V& y, const Screw& load) const noexcept {
    const V f = load.head<3>(), moment = load.tail<3>(), p = tangential<double>(y, inward_);
    const double fn = f.dot(inward_);
    const V along = f - fn * inward_, couple = inward_.cross(moment);
    const Disc<double> from = disc(y);
    const auto u = from.flat_punch(fn, along.dot(p), nu_), w = from.bending_couple(couple.dot(p), nu_);
    return ((u.in_plane + w.in_plane) * p + (u.normal + w.normal) * inward_ + u.along * along +
            w.along * couple + from.torsional_couple() * moment.dot(inward_) * inward_.cross(p)) /
           (4 * std::numbers::pi);
  }
  /// The rigid motion nearest to a field over the region; `at(y)` with y from the middle.
  template <class Field>
  [[nodiscard]] Screw fit(const Field& at) const noexcept {
    Screw sum = Screw::Zero();
    for (std::size_t s = 0; s < sample_.size(); ++s) {
      const V u = weight_[s] * at(sample_[s]);
      sum.head<3>() += u;
      sum.tail<3>() += sample_[s].cross(u) / radius_;
    }
    Screw w = least_squares_ * sum;
    w.tail<3>() /= radius_;
    return w;
  }
  /// The same of the field of a load.
  [[nodiscard]] Screw fit(const Screw& load) const noexcept { return own_fit_ * load; }

 private:
  using Square = Eigen::Matrix<double, 6, 6>;

  // Up to 48 points that stand for the region, far from each other, with the areas nearest to them. Regular
  // meshes have many that are as far to 1e-9 (chosen: above rounding): the first one counts, and a rounding
  // decides nothing, so that a turned body has the same.
  void sample(const std::vector<V>& vertex, const std::vector<double>& area) {
    std::vector<V> position;
    std::vector<double> share;
    for (std::size_t v = 0; v < area.size(); ++v) {
      if (!(area[v] > 0)) continue;
      position.push_back(vertex[v] - middle_);
      share.push_back(area[v]);
    }
    std::vector<double> gap(position.size(), (std::numeric_limits<double>::max)());
    std::vector<std::size_t> nearest(position.size(), 0);
    const std::size_t most = (std::min)(position.size(), std::size_t(48));
    constexpr double alike = 1 - 1e-9;
    for (std::size_t next = 0; sample_.size() < most;) {
      sample_.push_back(position[next]);
      for (std::size_t i = 0; i < position.size(); ++i) {
        const double square = (position[i] - position[next]).squaredNorm();
        if (square < alike * gap[i]) gap[i] = square, nearest[i] = sample_.size() - 1;
      }
      const double farthest = alike * *std::max_element(gap.begin(), gap.end());
      next = static_cast<std::size_t>(
          std::find_if(gap.begin(), gap.end(), [&](double g) { return g >= farthest; }) - gap.begin());
    }
    weight_.assign(sample_.size(), 0.0);
    for (std::size_t i = 0; i < position.size(); ++i) weight_[nearest[i]] += share[i];
  }

  void set_up_fit(const char* name) {
    Square normal = Square::Zero();
    for (std::size_t s = 0; s < sample_.size(); ++s) {
      Eigen::Matrix<double, 3, 6> J;
      for (int k = 0; k < 6; ++k) J.col(k) = rigid_motion(Screw::Unit(k), sample_[s] / radius_);
      normal += weight_[s] * J.transpose() * J;
    }
    SpdSystem<6> system;
    system.set(normal);
    // Of a disc the smallest pivot is a quarter of the largest; of a line rounding leaves less than 1e-9.
    if (!system.factor(6) || !(system.pivot_ratio() > 1e-9))
      fail(name, "the fixed region must not lie within a line");
    system.invert(least_squares_);
    for (int k = 0; k < 6; ++k) own_fit_.col(k) = fit([&](const V& y) { return field(y, Screw::Unit(k)); });
  }

  double nu_;
  std::vector<std::uint8_t> fixed_;
  V middle_ = V::Zero(), inward_ = V::UnitY();
  double radius_ = 0;
  std::vector<V> sample_;  // from the middle
  std::vector<double> weight_;
  Square least_squares_, own_fit_;
};

}  // namespace palpate::detail
