// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/linear.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::field_of;
using palpate::test::ulps;

namespace {

const Mat3<double> gradient =
    (Mat3<double>() << 0.1, -0.2, 0.05, 0.3, 0.15, -0.1, 0.02, 0.07, -0.25).finished();
const Vec3<double> shift(1e-3, -2e-3, 5e-4);

}  // namespace

TEST_CASE_TEMPLATE(
    "affine displacements of a box are exact, without a contact and with one in a face or on an edge", S,
    float, double) {
  const Box<S> box({.half = {S(0.03), S(0.02), S(0.015)}});
  const auto mesh = box.mesh(600);
  const LinearInterpolation<S> linear(make_partition(box, mesh));
  const auto affine = [](const Vec3<S>& x) { return Vec3<S>(gradient.cast<S>() * x + shift.cast<S>()); };
  std::vector<Vec3<S>> corners;
  for (const auto& point : linear.partition().points()) corners.push_back(affine(point.position));
  // Bilinear weights of all four corners are at least 0.1; on the edge two are, and the others are 0.
  for (const Vec3<S>& position :
       {Vec3<S>(S(0.003), S(0.02), S(0.001)), Vec3<S>(S(-0.002), S(-0.02), S(-0.003)),
        Vec3<S>(S(0.03), S(0.02), S(0.006)), Vec3<S>(S(-0.03), S(-0.02), S(-0.015))}) {
    ContactDisplacement<S> contact;
    contact.position = position;
    contact.displacement = affine(position);
    const auto field = field_of(linear, corners, contact);
    for (std::size_t slot = 0; slot < field.size(); ++slot) {
      const Vec3<S> exact = affine(mesh.vertices[linear.partition().order()[slot]]);
      // A weighted mean of values up to 0.015.
      CHECK((field[slot] - exact).norm() <= S(ulps<S>(32)) * S(0.015));
    }
  }
}

TEST_CASE("affine displacements of an ellipsoid are exact at the vertices' positions on the polyhedron") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.015}});
  const auto mesh = body.mesh(600);
  const LinearInterpolation<double> linear(make_partition(body, mesh));
  const auto& part = linear.partition();
  const auto affine = [](const Vec3<double>& x) { return Vec3<double>(gradient * x + shift); };
  const auto on_polyhedron = [&](const Vec3<double>& x) {  // |x|/a + |y|/b + |z|/c = 1
    return Vec3<double>(x / (std::fabs(x.x()) / 0.03 + std::fabs(x.y()) / 0.02 + std::fabs(x.z()) / 0.015));
  };
  std::vector<Vec3<double>> corners;
  for (const auto& point : part.points()) corners.push_back(affine(point.position));
  ContactDisplacement<double> contact;
  contact.position = body.raycast(Vec3<double>::Zero(), Vec3<double>(0.01, 0.008, 0.006)).position;
  contact.displacement = affine(on_polyhedron(contact.position));
  const auto field = field_of(linear, corners, contact);
  for (std::size_t slot = 0; slot < field.size(); ++slot) {
    const Vec3<double>& x = mesh.vertices[part.order()[slot]];
    CHECK((field[slot] - affine(on_polyhedron(x))).norm() <= 1e-16);  // 32 ulp of 0.015
  }
}

TEST_CASE("the field stays within the range of its corners, wherever the contact is") {
  const Superellipsoid<double> body(Superellipsoid<double>::Params{});
  const LinearInterpolation<double> linear(make_partition(body, body.mesh(300)));
  std::mt19937_64 random(7);
  INFO("seed 7");
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3<double>(unit(random), unit(random), unit(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Vec3<double>> corners(linear.partition().points().size());
    for (auto& u : corners) u = vector();
    ContactDisplacement<double> contact;
    contact.position = vector();
    contact.displacement = vector();
    Vec3<double> low = contact.displacement, high = low;
    for (const auto& u : corners) low = low.cwiseMin(u), high = high.cwiseMax(u);
    for (const Vec3<double>& u : field_of(linear, corners, contact)) {
      CHECK((u - low).minCoeff() >= -1e-14);
      CHECK((high - u).minCoeff() >= -1e-14);
    }
  }
}

TEST_CASE("a face whose corners do not move and that no contact splits does not move") {
  const Box<double> box(Box<double>::Params{});
  const LinearInterpolation<double> linear(make_partition(box, box.mesh(100)));
  std::vector<Vec3<double>> corners(8, Vec3<double>::Zero());
  ContactDisplacement<double> contact;
  contact.position = Vec3<double>(0, 0.02, 0);
  contact.displacement = Vec3<double>(0, -0.001, 0);
  LinearInterpolation<double>::Load load;
  linear.prepare(corners, contact, load);
  std::size_t moving = 0;
  for (std::size_t f = 0; f < 6; ++f) moving += linear.moves(load, f) ? 1 : 0;
  CHECK(moving == 1);
}
