// SPDX-License-Identifier: MIT

#include <palpate/touch/tools.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <numbers>

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
  // A capsule has 512 points, but an end in by a quarter of its radius 10 to 40.
  const double end = pi / 4 * 0.005 * 0.005;
  CHECK_RELATIVE(rod.spacing * rod.spacing, 2 * pi * 0.005 * 0.03 / 512, 1e-12);
  const MeshTool long_rod = capsule(0.005, 0.07);
  CHECK_RELATIVE(long_rod.spacing * long_rod.spacing, end / 10, 1e-12);
  // A needle has no more points than 1,500.
  const MeshTool needle = cylinder(0.0002, 0.2);
  CHECK_RELATIVE(needle.spacing, std::sqrt(TriangleMesh<double>(needle.mesh).area() / 1500), 1e-12);
  CHECK(ball(0.01).radius == 0.01);
}

TEST_CASE("tools: sizes that are none are refused") {
  CHECK_THROWS_AS((void)ball(0), SetupError);
  CHECK_THROWS_AS((void)capsule(-0.01, 0.01), SetupError);
  CHECK_THROWS_AS((void)capsule(0.01, 0), SetupError);
  CHECK_THROWS_AS((void)cylinder(0.01, -1), SetupError);
  CHECK_THROWS_AS((void)box(V(0.01, 0, 0.01)), SetupError);
  CHECK_THROWS_AS((void)box(V(0.01, 0.01, 0.01), {.spacing = -1}), SetupError);
  CHECK_THROWS_AS((void)tool_mesh(MeshData<double>{}), SetupError);
}
