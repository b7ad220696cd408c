// SPDX-License-Identifier: MIT
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/extremal_points.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>

#include <numbers>
#include <vector>

using namespace palpate;
using V = Vec3<double>;

namespace {

// Two pins on a box of 100 mm.
constexpr double a = 3e-3;  // of each pin [m]
const Box<double> box({.half = V(0.05, 0.05, 0.05)});
const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});

template <class Force, class Coupling, class Friction = Frictionless<double>>
using Pins = ContactSolver<Box<double>, Force, Friction, Regions<4, AreaSharing>, NoDeformation<double>,
                           AtContact, Coupling>;

/// Pins along x at these positions [m], x then height of the tip.
ToolPoints<double> pins(const std::vector<std::pair<double, double>>& tips) {
  std::vector<V> points;
  for (const auto& [x, height] : tips)
    for (int i = -5; i <= 5; ++i)
      for (int k = -5; k <= 5; ++k)
        if (i * i + k * k <= 25) points.push_back(V(x + a / 5 * i, height, a / 5 * k));
  const double area = std::numbers::pi * a * a * double(tips.size()) / double(points.size());
  return ToolPoints<double>(points, std::vector<double>(points.size(), area),
                            {.contact_area = std::numbers::pi * a * a});
}
template <class Coupling, class Force = DuffingForce<double>>
Pins<Force, Coupling> pressing(const ToolPoints<double>& tool, const Force& force = law,
                               const Coupling& coupling = {}) {
  return Pins<Force, Coupling>(
      {.object = box, .tool = tool, .force = force, .contacts = {.distance = 1e-3}, .coupling = coupling});
}
Pose<double> deep(double depth) {
  Pose<double> X;
  X.translation = V(0, 0.05 - depth, 0);
  return X;
}
using Beams = Skeleton<double>;
RegionSkeletons<Beams> box_beams() {
  std::vector<V> corners;
  for (const auto& p : extremal_points(box)) corners.push_back(p.position);
  return RegionSkeletons<Beams>(
      Beams(corners, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e6, .nu = 0.5})),
            VolumePreserving<double>({.volume = 1e-3})));
}
double up(TickResult<double> result) { return result.wrench.force.y(); }

}  // namespace

TEST_CASE("section VI: two pins 10 mm apart push back, by elasticity's share less than independent ones") {
  const auto tool = pins({{-5e-3, 0}, {5e-3, 0}});
  const double independent = up(pressing<IndependentRegions>(tool).tick(deep(1.9e-3)));
  const double coupled = up(pressing<CompliantRegions<>>(tool).tick(deep(1.9e-3)));
  CHECK_RELATIVE(independent, 2 * law.force(1.9e-3), 1e-12);  // 4.27 N; shares that sum to 1
  // The flat punch's surface at 10 mm is (2/pi) asin(a/r) of what is beneath it; R is 0.6 % of 1 less.
  CHECK_RELATIVE(coupled, independent / (1 + 2 / std::numbers::pi * std::asin(0.3)), 0.01);

  // As printed: the beams' stress forces are larger than the regions' own and would pull.
  auto printed = pressing<RegionSkeletons<Beams>>(tool, law, box_beams());
  const auto felt = printed.tick(deep(1.9e-3));
  MESSAGE("two pins: independent ", independent, " N, compliant ", coupled, " N, beams ", up(felt), " N");
  CHECK(has(felt.status, Status::stress_bounded));
  CHECK(up(felt) >= -1e-12);  // rounding of a difference of 2 N
  V sum = V::Zero();
  for (const auto& contact : printed.contacts()) {
    CHECK(contact.force.y() >= -1e-12);
    sum += contact.force;
  }
  CHECK((felt.wrench.force - sum).norm() <= 1e-14);  // some roundings of 2 N
}

TEST_CASE("section VI: for a linear law it is (C_own + C_jk) F = delta, and reciprocal") {
  const auto tool = pins({{-10e-3, 0}, {5e-3, 3e-4}});
  const LinearForce<double> linear({.k = 500});
  auto solver = pressing<CompliantRegions<>>(tool, linear);
  (void)solver.tick(deep(1.5e-3));
  REQUIRE(solver.contacts().size() == 2);
  const double F_0 = solver.contacts()[0].normal_force, F_1 = solver.contacts()[1].normal_force;
  const double C = 1 / 500.0, C_01 = C * HalfSpaceCompliance{}.ratio(std::hypot(15e-3, 3e-4), a);
  const bool swapped = F_0 < F_1;
  const double deeper = swapped ? F_1 : F_0, shallower = swapped ? F_0 : F_1;
  CHECK_RELATIVE(C * deeper + C_01 * shallower, 1.5e-3, 1e-12);  // a solve of two rows
  CHECK_RELATIVE(C * shallower + C_01 * deeper, 1.2e-3, 1e-12);
  // D is where the tool stands, of which the other's dent is a part.
  for (const auto& contact : solver.contacts()) {
    const bool is_deeper = contact.normal_force == deeper;
    CHECK_RELATIVE(-contact.displacement.y(), is_deeper ? 1.5e-3 : 1.2e-3, 1e-12);
    CHECK_RELATIVE(contact.dent, C_01 * (is_deeper ? shallower : deeper), 1e-9);  // a difference of depths
  }
}

TEST_CASE("section III, phase 3: a pin within another's dent is not felt until it reaches the dent's floor") {
  const LinearForce<double> linear({.k = 500});
  for (const double depth : {0.18e-3, 0.345e-3, 0.355e-3, 0.5e-3}) {
    const double apart = std::hypot(10e-3, 1.9e-3 - depth);
    const double dent = 1.9e-3 * HalfSpaceCompliance{}.ratio(apart, a);  // 0.35 mm
    const auto tool = pins({{-5e-3, 0}, {5e-3, 1.9e-3 - depth}});
    auto solver = pressing<CompliantRegions<>>(tool, linear);
    auto independent = pressing<IndependentRegions>(tool, linear);
    const auto felt = solver.tick(deep(1.9e-3));
    (void)independent.tick(deep(1.9e-3));
    CHECK(independent.contacts().size() == 2);
    CHECK(has(felt.status, Status::contact));
    if (depth < dent) {
      CHECK(solver.contacts().size() == 1);
      CHECK_RELATIVE(up(felt), 500 * 1.9e-3, 1e-12);
    } else {
      CHECK(solver.contacts().size() == 2);
    }
  }
}

TEST_CASE("section VI: a region that appears changes nothing at once; one region is as without coupling") {
  const auto tool = pins({{-5e-3, 0}, {5e-3, 1e-3}});
  auto with = pressing<CompliantRegions<>>(tool);
  auto without = pressing<IndependentRegions>(tool);
  double before = 0;
  bool has_second = false;
  for (int i = 0; i <= 3000; ++i) {
    const double depth = 1e-6 * i, now = up(with.tick(deep(depth))), alone = up(without.tick(deep(depth)));
    if (depth <= 1e-3) CHECK(now == alone);  // one region: scaled by 1
    CHECK(now <= alone * (1 + 1e-12));
    CHECK(now >= 0);
    // Two springs in parallel: 1 um of each at the law's stiffness, and no pair is stiffer than apart.
    CHECK(std::abs(now - before) <= 2 * law.stiffness(depth) * 1e-6 + 1e-12);
    before = now;
    has_second = has_second || with.contacts().size() == 2;
  }
  CHECK(has_second);
}

TEST_CASE("section VI: the force on each of eight pins is between none and its own") {
  std::vector<std::pair<double, double>> tips;
  for (int k = 0; k < 8; ++k) tips.emplace_back(-28e-3 + 8e-3 * k, 2e-4 * ((5 * k) % 8));
  using Eight = ContactSolver<Box<double>, DuffingForce<double>, Frictionless<double>,
                              Regions<8, AreaSharing>, NoDeformation<double>, AtContact, CompliantRegions<>>;
  Eight solver({.object = box, .tool = pins(tips), .force = law, .contacts = {.distance = 1e-3}});
  const auto felt = solver.tick(deep(2e-3));
  CHECK(solver.contacts().size() >= 4);
  double sum = 0;
  for (const auto& contact : solver.contacts()) {
    CHECK(contact.normal_force > 0);
    CHECK(contact.normal_force < law.force(-contact.displacement.y()));
    CHECK(contact.dent > 0);
    sum += contact.normal_force;
  }
  CHECK_RELATIVE(up(felt), sum, 1e-12);  // a sum of eight
}

TEST_CASE("section VI: friction is that of the coupled normal force") {
  const auto tool = pins({{-5e-3, 0}, {5e-3, 0}});
  Pins<DuffingForce<double>, CompliantRegions<>, CoulombFriction<double>> solver(
      {.object = box,
       .tool = tool,
       .force = law,
       .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3}),
       .contacts = {.distance = 1e-3}});
  Pose<double> X = deep(1.9e-3);
  for (int i = 0; i <= 300; ++i) {
    X.translation.x() = 1e-4 * i;
    (void)solver.tick(X);
  }
  REQUIRE(solver.contacts().size() == 2);
  const double F_n = law.force(1.9e-3) / (1 + HalfSpaceCompliance{}.ratio(10e-3, a));
  for (const auto& contact : solver.contacts()) {
    CHECK(contact.mode == ContactMode::sliding);
    CHECK_RELATIVE(contact.normal_force, F_n, 1e-12);
    CHECK_RELATIVE(-contact.friction.x(), 0.3 * F_n, 1e-9);  // the return mapping's root
  }
}

TEST_CASE("section VI: coupled, the same in float, no heap in a tick, any topology of regions") {
  const auto tool = pins({{-5e-3, 0}, {5e-3, 0}});
  auto solver = pressing<CompliantRegions<>>(tool);
  const test::HeapCount heap;
  const double felt = up(solver.tick(deep(1.9e-3)));
  CHECK(heap.allocations() == 0);

  std::vector<Vec3<float>> points;
  for (const V& p : tool.points()) points.push_back(p.cast<float>());
  ContactSolver<Box<float>, DuffingForce<float>, Frictionless<float>, Regions<64, EqualSharing>,
                NoDeformation<float>, AtContact, CompliantRegions<>>
      narrow({.object = Box<float>({.half = Vec3<float>(0.05f, 0.05f, 0.05f)}),
              .tool = ToolPoints<float>(points, std::vector<float>(points.size(), float(tool.area(0))),
                                        {.contact_area = float(tool.contact_area())}),
              .force = DuffingForce<float>({.c1 = 40, .c3 = 3e8f}),
              .contacts = {.distance = 1e-3}});
  Pose<float> X;
  X.translation = Vec3<float>(0, 0.05f - 1.9e-3f, 0);
  // 50 mm less 1.9 mm has a depth to 2 ulp of 50 mm, 3e-6 of it; cubed.
  CHECK_RELATIVE(double(narrow.tick(X).wrench.force.y()), felt, 2e-5);

  // One region, and one point, have nothing to couple.
  ContactSolver<Box<double>, DuffingForce<double>, Frictionless<double>, SingleRegion<AreaSharing>,
                NoDeformation<double>, AtContact, CompliantRegions<>>
      one({.object = box, .tool = tool, .force = law});
  CHECK_RELATIVE(up(one.tick(deep(1.9e-3))), 2 * law.force(1.9e-3), 1e-12);
}

namespace {

const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
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
  std::vector<V> positions;
  for (const auto& p : extremal_points(egg)) positions.push_back(p.position);
  return Coupled<Rule>(
      {.object = egg,
       .tool = compass(),
       .force = DuffingForce<double>({.c1 = 40, .c3 = 3e8}),
       .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3}),
       .contacts = {.distance = 1e-3},
       .coupling = RegionSkeletons<Beams, Rule>(
           Beams(positions, EulerBernoulli<double>(IsotropicElasticity<double>({.E = 1e5, .nu = 0.5})),
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

/// What happens while the second pin comes down.
struct Landing {
  double step_at_landing = 0;  // of the wrench's force, in that tick [N]
  std::size_t regions = 0;     // at the end
  bool bounded_at_landing = false;
};
template <class Solver>
Landing land(Solver solver) {
  Landing found;
  V before = solver.tick(leaning(0)).wrench.force;
  found.regions = solver.contacts().size();
  CHECK(found.regions == 1);
  for (int i = 1; i <= 5000; ++i) {
    const auto now = solver.tick(leaning(i));
    if (solver.contacts().size() > found.regions) {
      found.step_at_landing = (now.wrench.force - before).norm();
      found.bounded_at_landing = has(now.status, Status::stress_bounded);
    }
    found.regions = solver.contacts().size();
    before = now.wrench.force;
  }
  return found;
}

}  // namespace

TEST_CASE("section VI, beams: with one region they change nothing, with two each feels the other") {
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

TEST_CASE("section VI, beams: a second pin lands without a jump; as printed its stress force is bounded") {
  const Landing smooth = land(coupled<CoupledRegions>());
  const Landing printed = land(coupled<SuperposedRegions>());
  const Landing alone = land(independent());
  CHECK(smooth.regions == 2);
  CHECK(printed.regions == 2);
  CHECK(alone.regions == 2);
  MESSAGE("force step in the tick of landing: coupled ", smooth.step_at_landing, " N, superposed ",
          printed.step_at_landing, " N, independent ", alone.step_at_landing, " N");
  CHECK(smooth.step_at_landing <= 1.1 * alone.step_at_landing);  // the coupling starts from zero
  // The printed form gives the second pin 0.23 N at once; its own force, which bounds that, is still small.
  CHECK(printed.bounded_at_landing);
  CHECK(printed.step_at_landing <= 2.2 * alone.step_at_landing);  // at most as much again, on either side
}

TEST_CASE("section VI, beams: a coupled tick takes no heap") {
  auto solver = coupled<CoupledRegions>();
  const test::HeapCount heap;
  for (int i = 0; i <= 5000; i += 50) (void)solver.tick(leaning(i));
  CHECK(heap.allocations() == 0);
}
