// SPDX-License-Identifier: MIT
#pragma once

/// @file Run time against error of a rigid tool's force on an elastic half-space: the library's laws and its
/// resolved contact, beside springs under each point and a dense solve for the pressures, which it does not
/// ship.

#include "scenes.hpp"
#include "work_precision_force/table.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <reference/rigid_sphere.hpp>

#include <Eigen/Cholesky>

namespace bench {

/// Pressures at points on a half-space as in textbooks: an even load on each point's disc [johnson1985]; the
/// dense matrix factored, points that pull left out, until none pulls or overlaps.
class DenseContact {
 public:
  DenseContact(const palpate::SurfaceSamples<double>& samples, double E_plane) : samples_(samples) {
    const auto n = static_cast<Eigen::Index>(samples.points.size());
    matrix_.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double size = std::sqrt(samples.areas[a] / std::numbers::pi);
        const double inverse =
            i == j ? 16 / (3 * std::numbers::pi * size) : 1 / (samples.points[a] - samples.points[b]).norm();
        matrix_(i, j) = inverse / (std::numbers::pi * E_plane);
      }
  }
  /// Force and torque about the origin of the tool at X, the body below y = 0.
  [[nodiscard]] palpate::Wrench<double> operator()(const palpate::Pose<double>& X) const {
    std::vector<Eigen::Index> in;
    Eigen::VectorXd depth(matrix_.rows()), load = Eigen::VectorXd::Zero(matrix_.rows());
    for (Eigen::Index i = 0; i < depth.size(); ++i) {
      depth[i] = -(X * samples_.points[static_cast<std::size_t>(i)]).y();
      if (depth[i] > 0) in.push_back(i);
    }
    for (int round = 0; round < 50 && !in.empty(); ++round) {
      const Eigen::VectorXd q = matrix_(in, in).llt().solve(Eigen::VectorXd(depth(in)));
      load.setZero();
      load(in) = q;
      const Eigen::VectorXd lacks = matrix_ * load - depth;
      std::vector<Eigen::Index> next;
      for (Eigen::Index i = 0; i < depth.size(); ++i)
        if (depth[i] > 0 && (load[i] > 0 || (load[i] == 0 && lacks[i] < 0))) next.push_back(i);
      if (next == in) break;
      in = std::move(next);
    }
    palpate::Wrench<double> sum;
    for (const Eigen::Index i : in) {
      const palpate::Vec3<double> force(0, load[i], 0);
      sum.force += force;
      sum.torque += (X * samples_.points[static_cast<std::size_t>(i)] - X.translation).cross(force);
    }
    return sum;
  }

 private:
  palpate::SurfaceSamples<double> samples_;
  Eigen::MatrixXd matrix_;
};

/// A path over which methods are compared: poses, and what is right there. torque: about z, or 0.
struct ElasticPath {
  const char* name;
  const char* reference;
  std::vector<palpate::Pose<double>> poses;
  std::vector<double> force, torque;
};

/// Root mean square of the relative errors, and the time of an evaluation.
template <class Tick>
void measure_path(const Table& table, const ElasticPath& path, const std::string& method,
                  const std::string& setting, const Tick& tick, double bound = 0) {
  double square = 0, count = 0;
  const auto add = [&](double value, double right) {
    square += (value / right - 1) * (value / right - 1);
    ++count;
  };
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    const palpate::Wrench<double> wrench = tick(path.poses[i]);
    add(wrench.force.y(), path.force[i]);
    if (path.torque[i] != 0) add(wrench.torque.z(), path.torque[i]);
  }
  const double ns = least_ns(table.repeats / 10 + 3, [&] {
    for (const auto& X : path.poses) use(tick(X));
  });
  table.row(path.name, method, "double", setting, ns / static_cast<double>(path.poses.size()),
            std::sqrt(square / count), path.reference, bound);
}

inline void elastic_contact(const Table& table, bool quick) {
  using namespace palpate;
  using V = Vec3<double>;
  using Elastic = ElasticContact<double, HalfSpace>;
  constexpr double E = 1e6, nu = 0.5, E_plane = E / (1 - nu * nu), pi = std::numbers::pi;
  const Box<double> below({.half = V::Constant(0.5), .centre = V(0, -0.5, 0)});
  const auto resolved = [&](const ElasticPath& path, const SurfaceSamples<double>& samples, double bound) {
    ContactSolver<Box<double>, Elastic, Frictionless<double>, ContactPoints<512>> solver(
        {.object = below,
         .tool = ToolPoints<double>(samples, {.contact_area = 1e-4}),
         .force = Elastic({.compliance = HalfSpace({.E = E, .nu = nu})})});
    std::size_t most = 0;
    for (const auto& X : path.poses) {
      (void)solver.tick(X);
      most = (std::max)(most, solver.state().points().size());
    }
    const std::string setting = std::to_string(most) + " points";
    measure_path(
        table, path, "palpate resolved", setting,
        [&](const Pose<double>& X) { return solver.tick(X).wrench; }, bound);
    const DenseContact dense(samples, E_plane);
    measure_path(table, path, "dense Cholesky", setting, dense);
  };
  const auto springs = [&](const ElasticPath& path, const std::string& method,
                           const SurfaceSamples<double>& samples, double stiffness) {
    ContactSolver<Box<double>, LinearForce<double>, Frictionless<double>, SingleRegion<AreaSharing>> solver(
        {.object = below,
         .tool = ToolPoints<double>(samples.points, samples.areas, {.contact_area = 1e-4}),
         .force = LinearForce<double>({.k = stiffness * 1e-4})});
    measure_path(table, path, method, std::to_string(samples.points.size()) + " points",
                 [&](const Pose<double>& X) { return solver.tick(X).wrench; });
  };

  // A ball of 15 mm goes 0.3 to 1.5 mm in and out while it slides.
  constexpr double R = 0.015;
  ElasticPath ball{"ball on an elastic half-space", "exact sphere [sneddon1965]", {}, {}, {}};
  for (int i = 0; i < 256; ++i) {
    const double phi = 2 * pi * i / 256, d = 9e-4 - 6e-4 * std::cos(phi);
    Pose<double> X;
    X.translation = V(0.01 * std::sin(phi), R - d, 0);
    ball.poses.push_back(X);
    ball.force.push_back(test::rigid_sphere_force(R, d, E_plane));
    ball.torque.push_back(0);
  }
  const TriangleMesh<double> sphere(Sphere<double>({.radius = R}).mesh(4000));
  const auto pole = [&](double apart) { return points_up_to(-R + 2e-3, contact_samples(sphere, apart)); };
  {
    ContactSolver<Box<double>, HertzForce<double>> point(
        {.object = below, .tool = {}, .force = HertzForce<double>({.k = 4. / 3 * E_plane * std::sqrt(R)})});
    measure_path(table, ball, "palpate point with Hertz's law", "1 point", [&](const Pose<double>& X) {
      Pose<double> lowest = X;
      lowest.translation.y() -= R;
      return point.tick(lowest).wrench;
    });
  }
  // So stiff that the force is right 1 mm deep: pi R d^2 times the stiffness.
  springs(ball, "springs under each point", pole(5e-4),
          test::rigid_sphere_force(R, 1e-3, E_plane) / (pi * R * 1e-6));
  for (const double apart : {2.4e-3, 1.6e-3, 1.1e-3, 8e-4, 6e-4})
    if (!quick || apart > 1e-3) resolved(ball, pole(apart), apart < 1.5e-3 ? 0.01 : 0);

  // A blade's face, 30 x 3 mm, pressed and tilted as far as it stays in contact. Limits of fine lattices, as
  // in tests/unit/resolved/half_space_test.cpp.
  constexpr double length = 0.03, width = 0.003, area = length * width;
  ElasticPath blade{"blade 10 : 1 flat and tilted", "limit of 8 x 80 to 16 x 160 cells", {}, {}, {}};
  for (int i = 0; i < 64; ++i) {
    const double phi = 2 * pi * i / 64, d = 2e-5 + 1e-5 * std::sin(phi), tilt = 2e-4 * (1.2 + std::cos(phi));
    Pose<double> X;
    X.rotation = Eigen::AngleAxisd(tilt, V::UnitZ()).toRotationMatrix();
    X.translation = V(0, 0.004 - d, 0);
    blade.poses.push_back(X);
    blade.force.push_back(1.4916 * E_plane * std::sqrt(area) * d);
    blade.torque.push_back(-2.050 * E_plane * std::pow(area, 1.5) * tilt);
  }
  const TriangleMesh<double> box(Box<double>({.half = V(length / 2, 0.004, width / 2)}).mesh(24));
  const auto face = [&](double apart) { return points_up_to(-0.004 + 1e-6, contact_samples(box, apart)); };
  springs(blade, "palpate by area as a disc", face(1e-3), 2 * E_plane / std::sqrt(pi * area));
  springs(blade, "springs under each point", face(1e-3), 1.4916 * E_plane / std::sqrt(area));
  for (const double apart : {width, width / 1.6, width / 2.6, width / 3.6})
    if (!quick || apart > 1e-3) resolved(blade, face(apart), apart < width ? 0.05 : 0);
}

}  // namespace bench
