// SPDX-License-Identifier: MIT

/// @file A small tool thrown at a thin plate, several of its sizes in a tick: with SweptPose none gets
/// through.

#include <palpate/detection/swept_pose.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/palpate.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <random>

using namespace palpate;

namespace {

using V = Vec3<double>;

constexpr double half_thickness = 5e-4, radius = 2e-3;
const Box<double> plate({.half = V(0.5, half_thickness, 0.5)});
const ToolPoints<double> tool(TriangleMesh<double>(Sphere<double>({.radius = radius}).mesh(60)),
                              {.contact_area = 1e-6});

struct Throws {
  int lost = 0, held = 0, pulled = 0;
};

// Ticks until the device is well past the plate, and then straight back.
template <class Object>
Throws throw_many(const Object& object, int count, bool sweep_them) {
  ContactSolver<Object, LinearForce<double>, Frictionless<double>, SingleRegion<AreaSharing>> solver(
      {object, tool, LinearForce<double>({.k = 1000}), {}, {}, {}});
  std::mt19937_64 random(20240801);
  std::uniform_real_distribution<double> unit(-1, 1);
  Throws result;
  for (int i = 0; i < count; ++i) {
    const double side = i % 2 == 0 ? 1 : -1;
    const V at(0.1 * unit(random), side * (0.01 + 0.05 * std::abs(unit(random))), 0.1 * unit(random));
    // 5 to 25 tool diameters in a tick, up to 72 degrees off the normal, turning by up to 3 rad.
    const double speed = 2 * radius * (5 + 20 * std::abs(unit(random)));
    const V step = speed * V(unit(random), -side * 0.5 * (1.5 + unit(random)), unit(random)).normalized();
    const Eigen::AngleAxis<double> turn(3 * unit(random),
                                        V(unit(random), unit(random), 1.1 + unit(random)).normalized());
    Pose<double> X;
    X.translation = at;
    SweptPose<double> sweep(0.6 * half_thickness);
    solver.reset();
    bool lost = false, held = false, behind = false;
    const auto tick = [&] {
      auto pose = X;
      if (sweep_them) {
        const auto reached = sweep.advance(tool, object, X);
        pose = reached.pose;
        behind = has(reached.status, Status::held_back);
        held = held || behind;
        lost = lost || side * pose.translation.y() < 0;
      }
      const auto r = solver.tick(pose);
      if (side * r.wrench.force.y() < 0) ++result.pulled, lost = true;
      if (!sweep_them && side * X.translation.y() < -2 * radius && !has(r.status, Status::contact))
        lost = true;
      return r;
    };
    (void)tick();
    while (side * X.translation.y() > -0.05) {
      X.translation += step;
      X.rotation = (turn * X.rotation).eval();
      (void)tick();
    }
    const auto r = tick();
    if (sweep_them) {  // pushed back to the side it came from, and free again when the device is back
      lost = lost || !has(r.status, Status::contact) || !(side * r.wrench.force.y() > 0);
      while (side * X.translation.y() < 0.02) {
        X.translation -= step;
        (void)tick();
      }
      lost = lost || has(tick().status, Status::contact) || behind;
    }
    result.lost += lost;
    result.held += held;
  }
  return result;
}

}  // namespace

TEST_CASE("stress: of 10,000 throws at a thin plate none is lost") {
  const auto exact = throw_many(plate, 10000, true);
  std::printf("exact plate, swept: %d lost, %d held back, %d pulled through\n", exact.lost, exact.held,
              exact.pulled);
  CHECK(exact.lost == 0);
  CHECK(exact.held == 10000);
  const MeshSurface<double> mesh{TriangleMesh<double>(plate.mesh(200))};
  const auto swept = throw_many(mesh, 10000, true), without = throw_many(mesh, 1000, false);
  std::printf("mesh, swept: %d lost, %d held back; without: %d lost, %d of them pulled through\n", swept.lost,
              swept.held, without.lost, without.pulled);
  CHECK(swept.lost == 0);
  CHECK(swept.held == 10000);
  CHECK(without.lost > 900);  // so the throws are hard
}
