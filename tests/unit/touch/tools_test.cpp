// SPDX-License-Identifier: MIT

#include <palpate/resolved/contact_samples.hpp>
#include <palpate/touch/tools.hpp>

#include <support/check.hpp>
#include <support/response_meshes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

using namespace palpate;

namespace {
using V = Vec3<double>;
constexpr double pi = std::numbers::pi;
}  // namespace

TEST_CASE("tools: closed meshes of the size asked for, with points as fine as their contact asks for") {
  const MeshTool rod = capsule(0.005, 0.02), pin = cylinder(0.002, 0.03), head = box(V(0.02, 0.01, 0.03));
  // Lengths are to rounding, 1e-12. Chords: of a circle of 48 they take off 0.3 %, of the pin's 24 1.1 %.
  CHECK_RELATIVE(TriangleMesh<double>(rod.mesh).volume(),
                 pi * 0.005 * 0.005 * 0.02 + 4.0 / 3 * pi * 0.005 * 0.005 * 0.005, 0.01);
  CHECK_RELATIVE(TriangleMesh<double>(pin.mesh).volume(), pi * 0.002 * 0.002 * 0.03, 0.012);
  CHECK_RELATIVE(TriangleMesh<double>(head.mesh).volume(), 6e-6, 1e-12);
  CHECK(TriangleMesh<double>(rod.mesh).upper().isApprox(V(0.005, 0.015, 0.005), 1e-12));
  CHECK(TriangleMesh<double>(head.mesh).lower().isApprox(V(-0.01, -0.005, -0.015), 1e-12));
  CHECK_RELATIVE(pin.spacing * pin.spacing, pi * 0.002 * 0.002 / 40, 1e-12);
  CHECK_RELATIVE(head.spacing * head.spacing, 6e-4 / 40, 1e-12);
  const MeshTool scanned = tool_mesh(head.mesh),
                 told = tool_mesh(head.mesh, {.centre_of_mass = V(0, 1, 0), .contact_area = 1e-4}),
                 fine = tool_mesh(head.mesh, {.contact_area = 1e-4, .spacing = 1e-3});
  CHECK_RELATIVE(scanned.spacing * scanned.spacing, 0.1 * 2.2e-3 / 40, 1e-12);
  CHECK_RELATIVE(told.spacing * told.spacing, 1e-4 / 40, 1e-12);
  CHECK(told.centre_of_mass == V(0, 1, 0));
  CHECK(fine.spacing == 1e-3);
  // Touch may take points down to 1,500 in all where nothing is told.
  CHECK_RELATIVE(scanned.finest * scanned.finest, 2.2e-3 / 1500, 1e-12);
  CHECK((told.finest == 0 && fine.finest == 0));
  // A capsule has 512 points, but an end in by a quarter of its radius 10 to 40.
  const double end = pi / 4 * 0.005 * 0.005;
  CHECK_RELATIVE(rod.spacing * rod.spacing, 2 * pi * 0.005 * 0.03 / 512, 1e-12);
  const MeshTool long_rod = capsule(0.005, 0.07);
  CHECK_RELATIVE(long_rod.spacing * long_rod.spacing, end / 10, 1e-12);
  // A needle has no more points than 1,500.
  const MeshTool needle = cylinder(0.0002, 0.2);
  CHECK_RELATIVE(needle.spacing, std::sqrt(TriangleMesh<double>(needle.mesh).area() / 1500), 1e-12);
  CHECK(point_ball(0.01).radius == 0.01);
}

namespace {
/// Points of a tool, and what the largest |f(point)| of them is.
template <class Distance>
double farthest(const MeshTool& tool, const Distance& f) {
  double most = 0;
  const auto samples = contact_samples(TriangleMesh<double>(tool.mesh), tool.spacing);
  for (const V& p : samples.points) most = (std::max)(most, std::abs(f(p)));
  return most;
}
}  // namespace

TEST_CASE("tools: points lie on the surface, also of a long capsule") {
  // Measured: 0.01 % of the radius for the ball, 0.12 to 0.2 % for capsules, where their ends begin, as the
  // curvature changes there within a triangle. The side of one of 12 radii bulged by a whole radius.
  const double r = 0.004;
  CHECK(farthest(ball(r), [r](const V& p) { return p.norm() - r; }) < 2e-4 * r);
  for (const double length : {0.25 * r, 1 * r, 6 * r, 12 * r, 50 * r}) {
    CAPTURE(length);
    const double off = farthest(capsule(r, length), [=](const V& p) {
      return (p - V(0, std::clamp(p.y(), -length / 2, length / 2), 0)).norm() - r;
    });
    CHECK(off < 0.0025 * r);
  }
}

TEST_CASE("tools: flat faces of a CAD model with rounded edges stay flat") {
  const V half(0.02, 0.01, 0.015);
  const double r = 0.002;
  // Strips of 45, 22.5, 15 and 7.5 degrees. Off by 1.3, 0.7, 0.5 and 0.25 r where normals are weighted by angles
  // alone.
  for (const auto& [n, bound] :
       {std::pair(1, 0.1), std::pair(2, 0.005), std::pair(3, 0.002), std::pair(6, 0.001)}) {
    CAPTURE(n);
    const double off =
        farthest(tool_mesh(test::rounded_box_mesh(half, r, n), {.spacing = 1e-3}),
                 [&](const V& p) { return (p.cwiseAbs() - half + V::Constant(r)).cwiseMax(0).norm() - r; });
    CHECK(off < bound * r);  // measured: 0.06, 0.0025, 0.0009 and 0.0006
  }
}

TEST_CASE("tools: sizes that are none are refused") {
  CHECK_THROWS_AS((void)ball(0), SetupError);
  CHECK_THROWS_AS((void)point_ball(-1), SetupError);
  CHECK_THROWS_AS((void)capsule(-0.01, 0.01), SetupError);
  CHECK_THROWS_AS((void)capsule(0.01, 0), SetupError);
  CHECK_THROWS_AS((void)cylinder(0.01, -1), SetupError);
  CHECK_THROWS_AS((void)box(V(0.01, 0, 0.01)), SetupError);
  CHECK_THROWS_AS((void)box(V(0.01, 0.01, 0.01), {.spacing = -1}), SetupError);
  CHECK_THROWS_AS((void)tool_mesh(MeshData<double>{}), SetupError);
}
