// SPDX-License-Identifier: MIT
// The estimate of a resolved contact's error by its number of points, against closed forms.
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/resolution.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <reference/rigid_sphere.hpp>
#include <support/check.hpp>
#include <support/on_half_space.hpp>
#include <support/paths.hpp>

#include <random>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
constexpr double E = half_space_E, nu = half_space_nu, R = 0.015;

}  // namespace

TEST_CASE(
    "the estimated error of a ball's force is above the error in all of 400 poses, and near the largest") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const MeshData<double> ball = Sphere<double>({.radius = R}).mesh(4000);
  auto solver = on_half_space(ball, 0.002);
  double largest = 0, estimated = 0, least = 1;
  int poses = 0;
  while (poses < 400) {
    Pose<double> X;
    X.rotation = Eigen::AngleAxisd(3 * unit(random), V(unit(random), unit(random), unit(random)).normalized())
                     .toRotationMatrix();
    const double d = 0.0002 * std::pow(10, unit(random) + 1);  // up to 20 mm: 7 to 60 points
    X.translation = V(0, R - std::min(d, 0.004), 0);
    solver.reset();
    const double force = solver.tick(X).wrench.force.y();
    const auto points = solver.state().points();
    if (points.size() < 7) continue;
    const double error = std::abs(force / rigid_sphere_force(R, std::min(d, 0.004), E / (1 - nu * nu)) - 1),
                 estimate = resolution_error(points);
    // 0.4 %: the ball is a mesh of 4,000 vertices, and the references' own fit.
    CHECK(error <= estimate + 0.004);
    largest = (std::max)(largest, error), estimated = (std::max)(estimated, estimate);
    least = (std::min)(least, estimate);
    ++poses;
  }
  CHECK(estimated < 4 * largest);
  CHECK(least < 0.01);
}

TEST_CASE("a narrow contact counts by the points across it, turned either way") {
  // 4:1 with two rows, against a square with as many points.
  const auto estimate = [](double length, double width, double spacing) {
    auto solver = on_half_space(Box<double>({.half = V(length / 2, 0.004, width / 2)}).mesh(24), spacing);
    Pose<double> X;
    X.translation = V(0, 0.004 - 1e-5, 0);
    X.rotation = rotation_about<double>(V::UnitY(), 0.4);
    (void)solver.tick(X);
    const auto points = solver.state().points();
    return std::pair(resolution_error(points), points.size());
  };
  const auto [narrow, n] = estimate(0.016, 0.004, 0.0019);
  const auto [square, m] = estimate(0.008, 0.008, 0.0019);
  CHECK(std::abs(double(n) - double(m)) <= 0.35 * double(m));
  CHECK(narrow > 1.8 * square);
}

TEST_CASE("the spacing for an error: a ball then has that error or less") {
  const double d = 0.0015, a = rigid_sphere_radius(R, d), error = 0.01;
  const double spacing = spacing_for(std::numbers::pi * a * a, error);
  auto solver = on_half_space(Sphere<double>({.radius = R}).mesh(4000), spacing);
  Pose<double> X;
  X.translation = V(0, R - d, 0);
  CHECK_RELATIVE(solver.tick(X).wrench.force.y(), rigid_sphere_force(R, d, E / (1 - nu * nu)), error);
  CHECK_RELATIVE(resolution_error(solver.state().points()), error, 0.3);  // whole points
  CHECK(resolution_error(std::span<const PointContact<double>>()) == 0);
  CHECK_THROWS_AS((void)spacing_for(0, 0.01), SetupError);
  CHECK_THROWS_AS((void)spacing_for(1e-4, 0), SetupError);
}
