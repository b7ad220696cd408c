// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/deformation/vertex_normals.hpp>
#include <palpate/surface/cylinder.hpp>
#include <palpate/surface/ellipsoid.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE("area of a vertex's ring equals the sum over its triangles, on displaced meshes", S, float,
                   double) {
  const Cylinder<S> body(typename Cylinder<S>::Params{});  // rings of 3 to 8 neighbours
  const auto mesh = body.mesh(500);
  const VertexNormals<S> normals(mesh.triangles, mesh.vertices.size());
  std::mt19937_64 random(3);
  INFO("seed 3");
  std::uniform_real_distribution<double> unit(-1e-3, 1e-3);
  std::vector<CyclicPoint<S>> position;
  for (const auto& v : mesh.vertices) {
    const S x = v.x() + S(unit(random)), y = v.y() + S(unit(random)), z = v.z() + S(unit(random));
    position.push_back({x, y, z, x, y});
  }
  using L = Eigen::Matrix<long double, 3, 1>;
  std::vector<L> exact(mesh.vertices.size(), L::Zero());
  for (const auto& t : mesh.triangles) {
    const auto point = [&](std::size_t k) {
      return L(position[t[k]][0], position[t[k]][1], position[t[k]][2]);
    };
    const L area = (point(1) - point(0)).cross(point(2) - point(0));
    for (const std::uint32_t v : t) exact[v] += area;
  }
  for (std::size_t v = 0; v < exact.size(); ++v) {
    const Vec3<S> area = normals.area(v, position.data());
    // Differences of places of 0.03 over edges of 0.003: 10 ulp each, a few of them.
    CHECK((area.template cast<long double>() - exact[v]).norm() <= ulps<S>(100) * exact[v].norm());
  }
}

TEST_CASE("normals of a fine mesh are the surface's, and outward") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  const auto mesh = body.mesh(5000);
  const VertexNormals<double> normals(mesh.triangles, mesh.vertices.size());
  std::vector<CyclicPoint<double>> position;
  for (const auto& v : mesh.vertices) position.push_back({v.x(), v.y(), v.z(), v.x(), v.y()});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    CHECK(normals.area(v, position.data()).normalized().dot(body.closest(mesh.vertices[v]).normal) > 0.999);
}

TEST_CASE("set-up refuses a mesh that does not close, or names a vertex that does not exist") {
  const Ellipsoid<double> body({.axes = {0.03, 0.02, 0.02}});
  auto mesh = body.mesh(50);
  auto open = mesh.triangles;
  open.pop_back();
  CHECK_THROWS_AS(VertexNormals<double>(open, mesh.vertices.size()), SetupError);
  auto bad = mesh.triangles;
  bad[3][1] = 1000;
  CHECK_THROWS_WITH(VertexNormals<double>(bad, mesh.vertices.size()),
                    "VertexNormals: vertex does not exist, at triangle 3, got 1000");
  auto flipped = mesh.triangles;
  std::swap(flipped[5][0], flipped[5][1]);
  CHECK_THROWS_AS(VertexNormals<double>(flipped, mesh.vertices.size()), SetupError);
}
