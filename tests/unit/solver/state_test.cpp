// SPDX-License-Identifier: MIT
// The solver's state as a value, moving objects, parameters that change, the stiffness, and the shape as a
// role.
#include <palpate/solver/aliases.hpp>
#include <palpate/solver/make_solver.hpp>
#include <palpate/solver/stiffness.hpp>
#include <palpate/solver/wrench_ramp.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include "unit/solver/scene.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

using namespace palpate;
using namespace palpate::test;

namespace {

using Clustered =
    ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>>;
using Single = ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>,
                             SingleRegion<AreaSharing>>;

// Sliding, rocking, in and out of contact.
Pose<double> on_path(int i) {
  const double t = 0.01 * i;
  Pose<double> X = at(0.02 * std::sin(t), 0.0385 + 0.002 * std::sin(2.3 * t), 0.006 * std::sin(0.7 * t));
  X.rotation = test::rotation_about<double>(V(2, 1, 2) / 3, 0.2 * std::sin(1.7 * t));
  return X;
}

bool same(const TickResult<double>& a, const TickResult<double>& b) {
  return std::memcmp(&a.wrench, &b.wrench, sizeof a.wrench) == 0 && a.status == b.status;
}

}  // namespace

TEST_CASE("back in time: 1,000 evaluations in random order have the bits of those in order, without heap") {
  const Clustered solver({.object = egg,
                          .tool = face(9, 1e-3, 4e-5),
                          .force = law,
                          .friction = dry,
                          .contacts = {.distance = 2e-3}});
  constexpr int ticks = 1000;
  std::vector<Clustered::State> before;
  std::vector<TickResult<double>> in_order;
  Clustered::State state = solver.initial_state();
  int touching = 0;
  for (int i = 0; i < ticks; ++i) {
    before.push_back(state);
    in_order.push_back(solver.evaluate(on_path(i), 1e-3, state));
    touching += !state.contacts().empty();
  }
  CHECK(touching > ticks / 3);
  CHECK(touching < ticks);
  std::vector<int> order(ticks);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(1);
  std::shuffle(order.begin(), order.end(), random);
  Clustered::State scratch = solver.initial_state();
  int different = 0;
  const HeapCount heap;
  for (const int i : order) {
    scratch = before[std::size_t(i)];
    different += !same(solver.evaluate(on_path(i), 1e-3, scratch), in_order[std::size_t(i)]);
  }
  CHECK(heap.allocations() == 0);
  CHECK(different == 0);
}

TEST_CASE("tick is evaluate on the solver's own state, and restore goes back to an earlier one") {
  Single solver({.object = egg, .tool = face(9, 1e-3, 4e-5), .force = law, .friction = dry});
  Single::State state = solver.initial_state();
  for (int i = 0; i < 100; ++i) CHECK(same(solver.tick(on_path(i)), solver.evaluate(on_path(i), 0, state)));
  const Single::State kept = solver.state();
  std::vector<TickResult<double>> first;
  for (int i = 100; i < 200; ++i) first.push_back(solver.tick(on_path(i)));
  solver.restore(kept);
  for (int i = 100; i < 200; ++i) CHECK(same(solver.tick(on_path(i)), first[std::size_t(i - 100)]));
}

TEST_CASE("a moving object: the wrench turns with it, and the reaction balances force and moment") {
  Single still({.object = egg, .tool = face(9, 1e-3, 4e-5), .force = law, .friction = dry});
  Single moving = still;
  for (int i = 0; i < 300; ++i) {
    Pose<double> object = at(0.3 + 1e-4 * i, -0.2, 0.1);
    object.rotation = test::rotation_about<double>(V(1, 2, 2) / 3, 0.01 * i);
    const Pose<double> X = on_path(i);
    const Pose<double> tool{object.rotation * X.rotation, object * X.translation};
    const TickResult<double> in_object = still.tick(X, 1e-3);
    const WorldResult<double> in_world = moving.tick(tool, object, 1e-3);
    // Poses are composed and taken apart: lengths of 0.3 m to 1e-16 of them, against a stiffness below
    // 1e5 N/m (and a slip that remembers): 1e-10 N.
    CHECK_ABSOLUTE((object.rotation.transpose() * in_world.tool.force - in_object.wrench.force).norm(), 0,
                   1e-9);
    CHECK_ABSOLUTE((object.rotation.transpose() * in_world.tool.torque - in_object.wrench.torque).norm(), 0,
                   1e-10);
    CHECK((in_world.object.force + in_world.tool.force).norm() == 0);
    // About the world's origin the two wrenches cancel.
    const V centre = tool * still.centre_of_mass();
    const V moment = in_world.tool.torque + centre.cross(in_world.tool.force) + in_world.object.torque +
                     object.translation.cross(in_world.object.force);
    CHECK_ABSOLUTE(moment.norm(), 0, 1e-14);  // rounding of products of 1 N and 0.3 m
  }
  Pose<double> bad = at(0, 0, 0);
  bad.rotation(0, 0) = std::nan("");
  const WorldResult<double> refused = moving.tick(on_path(0), bad, 1e-3);
  CHECK(has(refused.status, Status::invalid_pose));
  CHECK(refused.tool.force.norm() == 0);
  CHECK(refused.object.torque.norm() == 0);
}

TEST_CASE(
    "the stiffness is the law's along the normal, the same for force and torque, and zero in free air") {
  using Frictionless1 = ContactSolver<Ellipsoid<double>, DuffingForce<double>>;
  const Frictionless1 solver(
      {.object = egg, .tool = {.tip = V(0, 0, 0), .centre_of_mass = V(0, 0.03, 0)}, .force = law});
  Frictionless1::State state = solver.initial_state(), scratch = state;
  const Pose<double> X = at(0, 0.038, 0);
  const auto felt = solver.evaluate(X, 0, state);
  const HeapCount heap;
  const auto K = stiffness(solver, X, state, scratch);
  CHECK(heap.allocations() == 0);
  CHECK_RELATIVE(K(1, 1), law.stiffness(2e-3), 1e-9);  // the step's square
  // The exit direction turns with the surface: across, -F/(R + ...) of a distance field over a sphere of the
  // tangent ellipsoid; only its sign is asked here, that it pushes the tool off.
  CHECK(K(0, 0) < 0);
  CHECK(felt.wrench.force.y() > 0);
  // Frictionless forces have a potential: K is symmetric.
  CHECK_ABSOLUTE((K - K.transpose()).norm(), 0, 1e-7 * K.norm());
  const Pose<double> away = at(0, 0.06, 0);
  (void)solver.evaluate(away, 0, state);
  CHECK(stiffness(solver, away, state, scratch).norm() == 0);
}

TEST_CASE("a contact that sticks resists across as the law does at zero stretch") {
  using OnBlock =
      ContactSolver<Box<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>;
  const OnBlock solver({.object = block,
                        .tool = face(9, 1e-3, 4e-5),
                        .force = law,
                        .friction = PowerLawFriction<double>({.K = 0.5, .beta = 0.75, .mu_dynamic = 0.3}),
                        .contacts = {.distance = 2e-3}});
  OnBlock::State state = solver.initial_state(), scratch = state;
  for (int i = 0; i <= 20; ++i) (void)solver.evaluate(at(0, 0.0202 - 1e-4 * i, 0), 1e-3, state);
  REQUIRE(state.contacts().size() == 1);
  const auto K = stiffness(solver, at(0, 0.0182, 0), state, scratch);
  // One region, so one tangential spring of c1; its cubic part over a step of 1e-8 m is below rounding.
  CHECK_RELATIVE(K(0, 0), law.params().c1, 1e-6);
  CHECK_RELATIVE(K(2, 2), law.params().c1, 1e-6);
}

TEST_CASE(
    "parameters that change under load: the first force is the last one, then a ramp, then the new one") {
  Single solver({.object = egg, .tool = face(9, 1e-3, 4e-5), .force = law, .friction = dry});
  WrenchRamp<double> ramp({.time = 0.02});
  const Pose<double> X = at(0, 0.038, 0);
  V sent = V::Zero();
  const auto tick = [&] {
    const auto felt = solver.tick(X, 1e-3);
    const V before = sent;
    sent = ramp.pass(felt.wrench, has(felt.status, Status::contact), 1e-3).force;
    return (sent - before).norm();
  };
  tick();
  tick();
  const V soft = sent;
  const DuffingForce<double> stiff({.c1 = 400, .c3 = 3e9});
  solver.set_force_law(stiff);
  ramp.begin();
  CHECK(tick() <= 1e-14);  // rounding of a force of 10 N
  double largest = 0;
  for (int i = 0; i < 25; ++i) largest = (std::max)(largest, tick());
  CHECK_RELATIVE(sent.y(), 10 * soft.y(), 1e-12);
  CHECK_RELATIVE(largest, 9 * soft.norm() / 20, 1e-9);
  CHECK((solver.tick(at(0, 0.06, 0), 1e-3).wrench.force).norm() == 0);
  CHECK(ramp.pass({}, false, 1e-3).force.norm() == 0);
  // A ramp that is not at its end ends where the tool lifts off.
  const Wrench<double> pressed{V(0, 10, 0), V::Zero()};
  (void)ramp.pass(pressed, true, 1e-3);
  ramp.begin();
  CHECK(ramp.pass({V(0, 4, 0), V::Zero()}, true, 1e-3).force.y() == 10);
  CHECK(ramp.pass({}, false, 1e-3).force.norm() == 0);
  CHECK(ramp.pass(pressed, true, 1e-3).force == pressed.force);
  CHECK_THROWS_AS(WrenchRamp<double>({.time = 0}), SetupError);
}

TEST_CASE("types are deduced from the parts in the order of their roles") {
  const auto point = make_solver(egg, PointTool<double>{}, law);
  static_assert(std::same_as<std::remove_const_t<decltype(point)>,
                             ContactSolver<Ellipsoid<double>, DuffingForce<double>>>);
  const auto stylus = make_solver(egg, PointTool<double>{}, law, dry);
  static_assert(std::same_as<std::remove_const_t<decltype(stylus)>, PointSolver<Ellipsoid<double>>>);
  const ToolPoints<double> cube(TriangleMesh<double>(block.mesh(8)), {.contact_area = 1e-4});
  const auto region = make_solver(egg, cube, law, dry);
  static_assert(
      std::same_as<
          std::remove_const_t<decltype(region)>,
          ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<>>>);
  const auto regions = make_solver(egg, cube, law, dry, Regions<4>{2e-1});
  static_assert(std::same_as<std::remove_const_t<decltype(regions)>, RegionSolver<Ellipsoid<double>>>);
}

TEST_CASE("the shape as a role: the solver draws what the model alone draws, and costs no byte without one") {
  const IsotropicElasticity<double> rubber({.E = 1e5, .nu = 0.5});
  const MeshData<double> mesh = egg.mesh(500);
  const auto make = [&] {
    return make_beam_skeleton(egg, mesh, EulerBernoulli<double>(rubber),
                              VolumePreserving<double>({.volume = egg.volume()}),
                              AreaNeighbourhood<double>({}));
  };
  auto alone = make();
  PaperSolver<Ellipsoid<double>> solver(
      {.object = egg,
       .tool = ToolPoints<double>(TriangleMesh<double>(Box<double>({.half = V(4e-3, 1e-3, 4e-3)}).mesh(8)),
                                  {.contact_area = 4e-5}, 1e-3),
       .force = law,
       .friction = PowerLawFriction<double>({.K = 0.5, .beta = 0.75, .mu_dynamic = 0.3}),
       .contacts = {.distance = 2e-3},
       .deformation = make()});
  std::vector<double> drawn(3 * mesh.vertices.size()), expected = drawn;
  const VertexBuffer<double> out{.positions = drawn.data()}, to{.positions = expected.data()};
  solver.draw_rest(out);
  alone.write_rest(to);
  for (int i = 0; i < 200; ++i) {
    (void)solver.tick(on_path(i));
    const HeapCount heap;
    solver.draw(solver.contacts(), out);
    CHECK(heap.allocations() == 0);
    alone.write(solver.contacts(), to);
    CHECK(drawn == expected);
  }
  static_assert(sizeof(RegionSolver<Ellipsoid<double>>) + sizeof(decltype(alone)) <= sizeof(solver) + 64);
}
