// SPDX-License-Identifier: MIT
#include <palpate/core/error.hpp>
#include <palpate/detection/coarse_tool.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/sphere.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

using namespace palpate;
using V = Vec3<double>;

namespace {

const TriangleMesh<double> ball(Sphere<double>({.radius = 5e-3}).mesh(1000));
const TriangleMesh<double> box(Box<double>({.half = V(5e-3, 3e-3, 4e-3)}).mesh(1000));
const ToolPoints<double>::Params params{.contact_area = 2e-5, .centre_of_mass = V(0, 0.01, 0)};

/// Sum of areas [m^2], of vector areas [m^2], of a_i x_i^T [m^3].
struct Sums {
  double area = 0;
  V vector_area = V::Zero();
  Mat3<double> moment = Mat3<double>::Zero();

  explicit Sums(const ToolPoints<double>& tool) {
    for (std::size_t i = 0; i < tool.size(); ++i) {
      area += tool.area(i);
      if (tool.vector_areas().empty()) continue;
      vector_area += tool.vector_areas()[i];
      moment += tool.vector_areas()[i] * tool.point(i).transpose();
    }
  }
};

}  // namespace

TEST_CASE("a coarse tool has no more points than asked for, and hardly fewer") {
  for (const TriangleMesh<double>* mesh : {&ball, &box}) {
    const ToolPoints<double> fine(*mesh, params);
    for (const std::size_t most : {1ul, 2ul, 10ul, 50ul, 200ul, 700ul}) {
      const CoarseTool<double> tool(fine, most);
      INFO(most, " of ", fine.size(), ": ", tool.size());
      CHECK(tool.is_coarse());
      CHECK(tool.size() <= most);
      // What stays is 3/4 to 3/2 of a spacing apart, so that their number comes in steps.
      if (most >= 50) CHECK(tool.size() >= most * 6 / 10);
      CHECK(tool.contact_area() == params.contact_area);
      CHECK(tool.centre_of_mass() == params.centre_of_mass);
    }
  }
}

TEST_CASE("a coarse tool keeps area, closedness and volume") {
  for (const TriangleMesh<double>* mesh : {&ball, &box}) {
    const ToolPoints<double> fine(*mesh, params);
    const CoarseTool<double> tool(fine, 200);
    const Sums before(fine), after(tool);
    CHECK_RELATIVE(after.area, before.area, 1e-13);  // rounding of 1,000 terms
    CHECK((after.vector_area - before.vector_area).norm() <= 1e-13 * before.area);
    // Exact where samples lie on all sides; over an edge they do not.
    CHECK((after.moment - before.moment).norm() <= 0.02 * before.moment.norm());
  }
}

TEST_CASE("a box keeps its corners") {
  const CoarseTool<double> tool(ToolPoints<double>(box, params), 200);
  int corners = 0;
  for (const V& p : tool.points()) corners += (p.cwiseAbs() - V(5e-3, 3e-3, 4e-3)).norm() < 1e-15;
  CHECK(corners == 8);
}

TEST_CASE("a tool that has no more points stays as it is") {
  const ToolPoints<double> fine(ball, params);
  const CoarseTool<double> tool(fine, fine.size());
  CHECK_FALSE(tool.is_coarse());
  REQUIRE(tool.size() == fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    CHECK(tool.point(i) == fine.point(i));
    CHECK(tool.area(i) == fine.area(i));
  }
}

TEST_CASE("bare points, with areas only, can be made coarse") {
  std::vector<V> points;
  for (int i = 0; i < 20; ++i)
    for (int k = 0; k < 20; ++k) points.emplace_back(1e-3 * i, 0, 1e-3 * k);
  const ToolPoints<double> fine(points, std::vector<double>(400, 1e-6), params);
  const CoarseTool<double> tool(fine, 100);
  CHECK(tool.size() <= 100);
  CHECK(tool.vector_areas().empty());
  CHECK_RELATIVE(Sums(tool).area, 400e-6, 1e-13);
}

TEST_CASE("no point at all is refused") {
  const ToolPoints<double> fine(ball, params);
  CHECK_THROWS_AS(CoarseTool<double>(fine, 0), SetupError);
}
