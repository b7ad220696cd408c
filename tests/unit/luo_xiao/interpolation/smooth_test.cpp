// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/smooth.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::field_of;
using palpate::test::ulps;

namespace {

std::vector<Vec3<double>> random_sites(std::size_t count, double thickness) {
  std::mt19937_64 random(count);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3<double>> sites(count);
  for (auto& e : sites) e = Vec3<double>(unit(random), unit(random), thickness * unit(random));
  return sites;
}

}  // namespace

TEST_CASE_TEMPLATE("affine displacements are exact on the curved surface itself, contact and all", S, float,
                   double) {
  const Ellipsoid<S> body({.axes = {S(0.03), S(0.02), S(0.015)}});
  const auto mesh = body.mesh(500);
  const SmoothInterpolation<S> smooth(make_partition(body, mesh));
  Mat3<S> A;
  A << S(0.1), S(-0.2), S(0.05), S(0.3), S(0.15), S(-0.1), S(0.02), S(0.07), S(-0.25);
  std::vector<Vec3<S>> corners;
  for (const auto& point : smooth.partition().points()) corners.push_back(A * point.position);
  for (const Vec3<S>& d :
       {Vec3<S>(S(1), S(2), S(1)), Vec3<S>(S(1), S(1e-3), S(0)), Vec3<S>(S(0), S(0), S(-1))}) {
    ContactDisplacement<S> contact;
    contact.position = body.raycast(Vec3<S>::Zero(), d).position;
    contact.displacement = A * contact.position;
    const auto field = field_of(smooth, corners, contact);
    for (std::size_t slot = 0; slot < field.size(); ++slot) {
      const Vec3<S> exact = A * mesh.vertices[smooth.partition().order()[slot]];
      // Near a site the contact's own function is divided by its small peak; 200 ulp of the maximum, 0.01.
      CHECK((field[slot] - exact).norm() <= S(ulps<S>(200)) * S(0.01));
    }
  }
}

TEST_CASE("spline: passes through its values; the moving site's function is 1 at it and 0 at the others") {
  for (const std::size_t count : {4u, 6u, 14u, 64u}) {
    const TriharmonicSpline spline(random_sites(count, 1));
    std::vector<double> values(count), cardinal(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = std::sin(static_cast<double>(7 * i));
    TriharmonicSpline::Function f, own;
    spline.through(values.data(), f);
    const Vec3<double> none = Vec3<double>::Zero();
    for (std::size_t i = 0; i < count; ++i)
      CHECK_ABSOLUTE(spline.value(f, spline.sites()[i], none), values[i], 1e-10);
    const Vec3<double> p = spline.reduced(Vec3<double>(0.3, -0.4, 0.1));
    spline.cardinals(p, cardinal.data());
    spline.moving(p, cardinal.data(), own);
    CHECK_ABSOLUTE(spline.value(own, p, p), 1, 1e-10);
    for (std::size_t i = 0; i < count; ++i) {
      // Close to a site (0.1 is more than a quarter of any gap here) it fades into that site's own.
      if ((p - spline.sites()[i]).norm() <= 0.1) continue;
      CHECK_ABSOLUTE(spline.value(own, spline.sites()[i], p), 0, 1e-9);
    }
  }
}

TEST_CASE("rank test: sites in a plane, on a line, at one position") {
  const auto check = [](const std::vector<Vec3<double>>& sites, double across = 1e-10) {
    const TriharmonicSpline spline(sites);
    std::vector<double> values;
    for (const auto& e : sites) values.push_back(0.3 + 0.5 * e.x() - 0.2 * e.y());
    TriharmonicSpline::Function f;
    spline.through(values.data(), f);
    for (std::size_t i = 0; i < sites.size(); ++i)
      CHECK_ABSOLUTE(spline.value(f, spline.reduced(sites[i]), Vec3<double>::Zero()), values[i], 1e-10);
    // Nothing varies across the sites' plane.
    const Vec3<double> x(0.2, 0.3, 0), y(0.2, 0.3, 5);
    CHECK_ABSOLUTE(spline.value(f, spline.reduced(x), x), spline.value(f, spline.reduced(y), x), across);
    return spline.value(f, spline.reduced(x), Vec3<double>::Zero());
  };
  CHECK_ABSOLUTE(check(random_sites(8, 0)), 0.3 + 0.5 * 0.2 - 0.2 * 0.3, 1e-10);  // affine within the plane
  // Their plane may lean by 1e-9: what is 5 above it is 5e-9 along it.
  CHECK_ABSOLUTE(check(random_sites(8, 1e-9), 5e-9), 0.3 + 0.5 * 0.2 - 0.2 * 0.3, 1e-6);
  check({Vec3<double>(0, 0, 0), Vec3<double>(1, 0, 0), Vec3<double>(3, 0, 0)});
  CHECK(check({Vec3<double>(1, 0, 0)}) == 0.8);
}

TEST_CASE("set-up refuses coincident sites and empty lists") {
  std::vector<Vec3<double>> sites = random_sites(5, 1);
  sites.push_back(sites[2]);
  CHECK_THROWS_WITH(TriharmonicSpline{sites}, "TriharmonicSpline: must be distinct, at site 2");
  CHECK_THROWS_AS(TriharmonicSpline{std::vector<Vec3<double>>{}}, SetupError);
  CHECK_THROWS_AS(TriharmonicSpline{random_sites(65, 1)}, SetupError);
}

TEST_CASE("no jump as the contact comes to an extremal point and passes it") {
  const Sphere<double> sphere({.radius = 0.03});
  const SmoothInterpolation<double> smooth(make_partition(sphere, sphere.mesh(200)));
  std::vector<Vec3<double>> corners(6, Vec3<double>(1e-4, 2e-4, -1e-4));
  ContactDisplacement<double> contact;
  contact.displacement = Vec3<double>(0, -2e-3, 0);
  contact.position = Vec3<double>(0, 0.03, 0);
  const auto there = field_of(smooth, corners, contact);
  for (const double angle : {1e-3, 1e-5, 1e-7, 1e-9, 1e-12}) {
    contact.position = 0.03 * Vec3<double>(std::sin(angle) * 0.6, std::cos(angle), std::sin(angle) * 0.8);
    const auto near = field_of(smooth, corners, contact);
    double worst = 0;
    for (std::size_t slot = 0; slot < near.size(); ++slot)
      worst = std::max(worst, (near[slot] - there[slot]).norm());
    CHECK(worst <=
          20 * angle * 2e-3 + 1e-10 * 2e-3);  // the slope of the stress test, and the solve's rounding
  }
}
