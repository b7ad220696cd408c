// SPDX-License-Identifier: MIT
// What a tick promises beside its result: the same bits again, no work where nothing moved, no heap.
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include "unit/solver/scene.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

using namespace palpate;
using namespace palpate::test;

TEST_CASE("the same poses give the same bits") {
  const auto run = [] {
    ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>>
        solver({.object = egg,
                .tool = face(9, 1e-3, 4e-5),
                .force = law,
                .friction = dry,
                .contacts = {.distance = 1.5e-3}});
    std::vector<double> all;
    for (int i = 0; i < 500; ++i) {
      const auto w = solver.tick(at(2e-5 * i, 0.0385 + 1e-3 * std::sin(0.05 * i), 1e-5 * i)).wrench;
      all.insert(all.end(),
                 {w.force.x(), w.force.y(), w.force.z(), w.torque.x(), w.torque.y(), w.torque.z()});
    }
    return all;
  };
  const auto a = run(), b = run();
  REQUIRE(a.size() == b.size());
  CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

namespace {
/// Counts how often it is asked.
struct CountingEgg : Ellipsoid<double> {
  using Ellipsoid<double>::Ellipsoid;
  int* asked = nullptr;
  Penetration<double> penetration(const V& x) const noexcept {
    ++*asked;
    return Ellipsoid<double>::penetration(x);
  }
};
}  // namespace

TEST_CASE("nothing moved: from the third tick at a pose on nothing is worked out, and nothing changes") {
  int asked = 0;
  CountingEgg body({.axes = V(0.06, 0.04, 0.04)});
  body.asked = &asked;
  ContactSolver<CountingEgg, DuffingForce<double>, CoulombFriction<double>> solver(
      {.object = body, .tool = {}, .force = law, .friction = dry});
  // Slides into the pose, so that the slip rule has something to settle.
  for (int i = 0; i < 50; ++i) (void)solver.tick(at(1e-4 * i, 0.038, 0));
  const Pose<double> X = at(1e-4 * 50, 0.038, 0);
  (void)solver.tick(X);
  const auto second = solver.tick(X);
  const ContactState<double> state = solver.contacts()[0];
  const int before = asked;
  for (int i = 0; i < 3; ++i) {
    const auto later = solver.tick(X);
    CHECK(std::memcmp(&later.wrench, &second.wrench, sizeof later.wrench) == 0);
    CHECK(later.status == second.status);
  }
  CHECK(asked == before);
  REQUIRE(solver.contacts().size() == 1);
  CHECK(solver.contacts()[0].friction == state.friction);

  (void)solver.tick(at(std::nextafter(1e-4 * 50, 1.0), 0.038, 0));
  CHECK(asked == before + 1);

  // A bad pose between forgets: the same pose is a new contact then.
  Pose<double> bad = X;
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  (void)solver.tick(bad);
  (void)solver.tick(bad);
  CHECK(has(solver.tick(bad).status, Status::invalid_pose));
  CHECK(solver.tick(X).wrench.force.x() != second.wrench.force.x());
  CHECK(asked == before + 2);
}

TEST_CASE("a tick takes no heap") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>
      solver({.object = egg,
              .tool = face(9, 1e-3, 4e-5),
              .force = law,
              .friction = PowerLawFriction<double>({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3}),
              .contacts = {.distance = 1.2e-3}});
  const test::HeapCount guard;
  for (int i = 0; i < 500; ++i) {
    Pose<double> X = at(2e-5 * i, 0.0385 + 2e-3 * std::sin(0.05 * i), 1e-5 * i);
    X.rotation = test::rotation_about<double>(V::UnitZ(), 0.3 * std::sin(0.03 * i));
    (void)solver.tick(X);
  }
  CHECK(guard.allocations() == 0);
}
