// SPDX-License-Identifier: MIT

#include <palpate/geometry/sphere.hpp>
#include <palpate/touch/detail/curved_surface.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <memory>
#include <vector>

using namespace palpate;

TEST_CASE("curved surface: its box is wider by the margin, its curvature goes from vertex to vertex") {
  const TriangleMesh<double> ball(Sphere<double>({.radius = 0.05}).mesh(100));
  std::vector<double> mean;
  for (const Vec3<double>& v : ball.vertices()) mean.push_back(20 + 100 * v.x());
  const auto surface = std::make_shared<const MeshSurface<double>>(ball);
  const detail::CurvedSurface curved(surface, mean, 0.002);
  for (int k = 0; k < 3; ++k) {
    CHECK(curved.lower()[k] == ball.lower()[k] - 0.002);
    CHECK(curved.upper()[k] == ball.upper()[k] + 0.002);
  }
  for (const auto& t : ball.triangles()) {
    const Vec3<double> middle = (ball.vertices()[t[0]] + ball.vertices()[t[1]] + ball.vertices()[t[2]]) / 3;
    const Curvature<double> c = curved.curvature(middle);
    CHECK_RELATIVE(c.k1, 20 + 100 * middle.x(), test::ulps<double>(64));
    CHECK(c.k2 == c.k1);
    CHECK_ABSOLUTE(c.dir1.dot(c.dir2), 0, test::ulps<double>(8));
  }
}
