// SPDX-License-Identifier: MIT
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/no_heap.hpp>
#include <support/paths.hpp>
#include <support/solvers.hpp>

using namespace palpate;
using V = Vec3<double>;

namespace {

const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
using Beams = Skeleton<double>;
template <class Rule>
using Coupled =
    ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>,
                  NoDeformation<double>, AtContact, RegionSkeletons<Beams, Rule>>;
using Independent =
    ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>>;

/// Two pins 30 mm apart, each of nine points.
ToolPoints<double> compass() {
  std::vector<V> points;
  for (const double x : {-0.015, 0.015})
    for (int i = 0; i < 9; ++i) points.emplace_back(x + 5e-4 * (i % 3 - 1), 0, 5e-4 * (i / 3 - 1));
  return ToolPoints<double>(points, std::vector<double>(points.size(), 2.5e-7), {.contact_area = 2e-6});
}

template <class Rule>
Coupled<Rule> coupled() {
  std::vector<V> places;
  for (const auto& p : extremal_points(egg)) places.push_back(p.position);
  return Coupled<Rule>(
      {.object = egg,
       .tool = compass(),
       .force = DuffingForce<double>({.c1 = 40, .c3 = 3e8}),
       .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3}),
       .contacts = {.distance = 1e-3},
       .coupling = RegionSkeletons<Beams, Rule>(
           Beams(places, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
                 VolumePreserving<double>({.volume = egg.volume()})))});
}
Independent independent() {
  return Independent({.object = egg,
                      .tool = compass(),
                      .force = DuffingForce<double>({.c1 = 40, .c3 = 3e8}),
                      .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3}),
                      .contacts = {.distance = 1e-3}});
}

/// The compass leans: one pin goes in at i = 0, the other follows.
Pose<double> leaning(int i) {
  Pose<double> X;
  X.rotation = test::rotation_about<double>(V::UnitZ(), -0.1 + 2e-5 * i);
  X.translation = V(0, 0.0378, 0);
  return X;
}

/// The largest change of the wrench's force in a tick while the second pin comes down, and the regions at the
/// end.
template <class Solver>
std::pair<double, std::size_t> land(Solver solver, double& at_landing) {
  V before = solver.tick(leaning(0)).wrench.force;
  std::size_t regions = solver.contacts().size();
  CHECK(regions == 1);
  double largest = 0;
  for (int i = 1; i <= 5000; ++i) {
    const V now = solver.tick(leaning(i)).wrench.force;
    largest = (std::max)(largest, (now - before).norm());
    if (solver.contacts().size() > regions) at_landing = (now - before).norm();
    regions = solver.contacts().size();
    before = now;
  }
  return {largest, regions};
}

}  // namespace

TEST_CASE("section VI: with one region the coupling changes nothing, with two each feels the other") {
  auto with = coupled<CoupledRegions>();
  auto without = independent();
  for (const int i : {0, 100, 200})
    CHECK(with.tick(leaning(i)).wrench.force == without.tick(leaning(i)).wrench.force);
  for (int i = 201; i <= 5000; ++i) {
    (void)with.tick(leaning(i));
    (void)without.tick(leaning(i));
  }
  REQUIRE(with.contacts().size() == 2);
  REQUIRE(without.contacts().size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const V passed_on = with.contacts()[k].force - without.contacts()[k].force;
    CHECK(passed_on.norm() > 1e-3 * without.contacts()[k].force.norm());
    CHECK(passed_on.norm() < without.contacts()[k].force.norm());
  }
}

TEST_CASE("section VI: a second pin lands without a jump when coupled, and with one as printed") {
  double smooth = 0, printed = 0, alone = 0;
  const auto a = land(coupled<CoupledRegions>(), smooth);
  const auto b = land(coupled<SuperposedRegions>(), printed);
  const auto c = land(independent(), alone);
  CHECK(a.second == 2);
  CHECK(b.second == 2);
  CHECK(c.second == 2);
  MESSAGE("force step in the tick of landing: coupled ", smooth, " N, superposed ", printed,
          " N, independent ", alone, " N");
  CHECK(smooth <= 1.1 * alone);  // the coupling starts from zero: landing feels as it does without it
  CHECK(printed > 10 * smooth);  // what the default avoids
}

TEST_CASE("section VI: a coupled tick takes no heap") {
  auto solver = coupled<CoupledRegions>();
  const test::HeapCount heap;
  for (int i = 0; i <= 5000; i += 50) (void)solver.tick(leaning(i));
  CHECK(heap.allocations() == 0);
}
