// SPDX-License-Identifier: MIT
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>
#include <support/paths.hpp>

#include <cstring>
#include <limits>
#include <random>

using namespace palpate;
using V = Vec3<double>;

namespace {

const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});
const CoulombFriction<double> dry({.mu_static = 0.5, .mu_dynamic = 0.3});
const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
const Box<double> block({.half = V(0.05, 0.02, 0.05)});

Pose<double> at(double x, double y, double z) {
  Pose<double> X;
  X.translation = V(x, y, z);
  return X;
}

/// A flat square face of n x n points, `spacing` [m] apart, facing down.
ToolPoints<double> face(int n, double spacing, double contact_area) {
  std::vector<V> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      points.emplace_back(spacing * (i - 0.5 * (n - 1)), 0, spacing * (j - 0.5 * (n - 1)));
  return ToolPoints<double>(points, std::vector<double>(points.size(), spacing * spacing),
                            {.contact_area = contact_area, .centre_of_mass = V(0, 0.03, 0)});
}

/// A surface that is asked point by point.
struct PointByPoint {
  using Scalar = double;
  Superellipsoid<double> body;
  SurfacePoint<double> closest(const V& x) const noexcept { return body.closest(x); }
  Penetration<double> penetration(const V& x) const noexcept { return body.penetration(x); }
  bool separated(const V& c, double r) const noexcept { return body.separated(c, r); }
  double reach() const noexcept { return body.reach(); }
};
static_assert(HasPenetrationBatch<Superellipsoid<double>, 2 * batch_size> &&
              !HasPenetrationBatch<PointByPoint>);

}  // namespace

TEST_CASE_TEMPLATE("a point pressed in: F equals equation (3)", S, float, double) {
  const Box<S> body({.half = Vec3<S>(S(0.05), S(0.02), S(0.05))});
  const DuffingForce<S> duffing({.c1 = S(40), .c3 = S(3e8)});
  ContactSolver<Box<S>, DuffingForce<S>> solver({.object = body, .tool = {}, .force = duffing});
  for (const double depth : {1e-6, 1e-4, 1e-3, 3e-3, 8e-3}) {
    Pose<S> X;
    X.translation = Vec3<S>(S(0.001), S(0.02) - S(depth), S(-0.002));
    // The depth that the rounded pose really has; equation (3) in long double.
    const long double D = static_cast<long double>(S(0.02)) - static_cast<long double>(X.translation.y());
    const long double F = static_cast<long double>(S(40)) * D + static_cast<long double>(S(3e8)) * D * D * D;
    const auto result = solver.tick(X);
    CHECK_RELATIVE(result.wrench.force.y(), F,
                   sizeof(S) == 8 ? 1e-14L : 1e-6L);  // asked for by the project's goals
    CHECK(result.wrench.force.x() == 0);
    CHECK(result.wrench.force.z() == 0);
    CHECK(result.status == Status::contact);
  }
}

TEST_CASE("out of reach: zero wrench, no contact, no region") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> solver(
      {.object = egg, .tool = {}, .force = law, .friction = dry});
  const auto result = solver.tick(at(0, 0.0401, 0));
  CHECK(result.status == Status::ok);
  CHECK(result.wrench.force == V::Zero());
  CHECK(result.wrench.torque == V::Zero());
  CHECK(solver.contacts().empty());
}

TEST_CASE("a bad pose in mid-run: zero wrench, a status bit, recovery at the next good pose") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   inf = std::numeric_limits<double>::infinity();
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> solver(
      {.object = egg, .tool = {}, .force = law, .friction = dry});
  const Pose<double> good = at(0.001, 0.038, 0);
  const auto fresh = solver.tick(good);
  std::vector<Pose<double>> bad(7, good);
  bad[0].translation.x() = nan;
  bad[1].translation.z() = inf;
  bad[2].rotation(1, 2) = nan;
  bad[3].rotation.setZero();
  bad[4].rotation *= 1e200;
  bad[5].rotation.col(2) *= -1;  // a mirror image
  bad[6].translation.y() = 1e300;
  for (const Pose<double>& X : bad) {
    (void)solver.tick(at(0.002, 0.037, 0));
    const auto result = solver.tick(X);
    CHECK(result.status == Status::invalid_pose);
    CHECK(result.wrench.force == V::Zero());
    CHECK(result.wrench.torque == V::Zero());
    CHECK(solver.contacts().empty());
    const auto again = solver.tick(good);
    CHECK(again.status == Status::contact);
    CHECK(again.wrench.force == fresh.wrench.force);
  }
}

TEST_CASE("region: force and torque equal the sum over the points, and do not depend on the clustering") {
  const ToolPoints<double> tool = face(9, 1e-3, 4e-5);
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, Frictionless<double>, SingleRegion<>> one(
      {.object = egg, .tool = tool, .force = law});
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, Frictionless<double>, Regions<8>> many(
      {.object = egg, .tool = tool, .force = law, .contacts = {.distance = 0.5e-3}});
  Pose<double> X = at(0.012, 0.038, 0.003);
  X.rotation = test::rotation_about<double>(V(1, 2, 2) / 3, 0.3);
  V force = V::Zero(), torque = V::Zero();
  const V centre = X * V(0, 0.03, 0);
  int touching = 0;
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const V x = X * V(1e-3 * (i - 4), 0, 1e-3 * (j - 4));
      const SurfacePoint<double> p = egg.closest(x);
      if (p.distance >= 0) continue;
      ++touching;
      const V f = 1e-6 / 4e-5 * law.force(-p.distance) * p.normal;
      force += f;
      torque += (x - centre).cross(f);
    }
  }
  CHECK(touching > 10);
  const auto a = one.tick(X);
  const auto b = many.tick(X);
  // Rounding of a sum of at most 81 terms, torque about a point 30 mm away.
  CHECK((a.wrench.force - force).norm() <= 1e-14 * force.norm());
  CHECK((a.wrench.torque - torque).norm() <= 1e-13 * torque.norm());
  CHECK((b.wrench.force - force).norm() <= 1e-14 * force.norm());
  CHECK((b.wrench.torque - torque).norm() <= 1e-13 * torque.norm());
  CHECK(one.contacts().size() == 1);
  CHECK(one.contacts()[0].points == static_cast<std::uint32_t>(touching));
  CHECK(many.contacts().size() ==
        8);  // every point is a region of its own at that distance: more than there is room for
  CHECK(has(b.status, Status::region_overflow));
}

TEST_CASE(
    "two leaves at once: the same force as point by point, for any number of leaves, the last one full or "
    "not") {
  const Superellipsoid<double> pill({.axes = V(0.06, 0.04, 0.04), .e1 = 0.3, .e2 = 0.7});
  for (const int n : {1, 3, 4, 5, 6, 7, 8, 9, 12}) {  // 1 to 9 leaves
    const ToolPoints<double> tool = face(n, 1e-3, 4e-5);
    const auto compare = [&](auto contacts) {
      using Contacts = decltype(contacts);
      ContactSolver<Superellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Contacts> at_once(
          {.object = pill, .tool = tool, .force = law, .friction = dry, .contacts = contacts});
      ContactSolver<PointByPoint, DuffingForce<double>, CoulombFriction<double>, Contacts> single(
          {.object = {pill}, .tool = tool, .force = law, .friction = dry, .contacts = contacts});
      int touching = 0;
      for (int i = 0; i < 60; ++i) {
        Pose<double> X = at(0.0004 * i, 0.0385 + 1e-4 * (i % 7), 0.001);
        X.rotation = test::rotation_about<double>(V(0, 0, 1), 0.02 * (i % 11));
        const auto a = at_once.tick(X), b = single.tick(X);
        REQUIRE(a.status == b.status);
        // A few roundings of 60 mm, by the slope of the forces' sum.
        REQUIRE((a.wrench.force - b.wrench.force).norm() <= 1e-12 * (1 + b.wrench.force.norm()));
        REQUIRE((a.wrench.torque - b.wrench.torque).norm() <= 1e-13 * (1 + b.wrench.force.norm()));
        touching += has(a.status, Status::contact) ? 1 : 0;
      }
      CHECK(touching > 10);
    };
    INFO("points ", n * n);
    compare(SingleRegion<>{});
    compare(Regions<4>{.distance = 1.5e-3});
  }
}

TEST_CASE(
    "equivalent contact: the law at its depth gives the region's force, and its origin is on the surface") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<>> solver(
      {.object = egg, .tool = face(11, 1e-3, 1e-4), .force = law, .friction = dry});
  for (int i = 0; i <= 200; ++i) (void)solver.tick(at(-0.005 + 5e-5 * i, 0.0385, 0));
  REQUIRE(solver.contacts().size() == 1);
  const ContactState<double>& c = solver.contacts()[0];
  CHECK(c.mode == ContactMode::sliding);
  const double D_n = -c.displacement.dot(c.normal);
  CHECK_RELATIVE(law.force(D_n), c.normal_force, 0.02);  // normal turns by up to 5 degrees over the stretch
  CHECK(std::abs(egg.closest(solver.origin(c)).distance) <= 1e-16);
  CHECK((solver.origin(c) - c.origin()).norm() <= 0.1 * c.displacement.norm());
  CHECK((c.force - c.friction - c.normal_force * c.normal).norm() <= 1e-12);
}

TEST_CASE("one point of the whole nominal area is the single point") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>> point(
      {.object = egg, .tool = {V::Zero(), V(0, 0.03, 0)}, .force = law, .friction = dry});
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<2>> regions(
      {.object = egg,
       .tool = face(1, 1e-3, 1e-6),
       .force = law,
       .friction = dry,
       .contacts = {.distance = 1e-3}});
  for (int i = 0; i < 300; ++i) {
    const Pose<double> X = at(1e-5 * i, 0.0395 - 1e-5 * i, 2e-5 * i);
    const auto a = point.tick(X), b = regions.tick(X);
    // The region finds its depth by the law's inverse: a few ulp.
    CHECK((a.wrench.force - b.wrench.force).norm() <= 1e-13 * a.wrench.force.norm());
    CHECK((a.wrench.torque - b.wrench.torque).norm() <= 1e-13 * a.wrench.force.norm());
  }
}

TEST_CASE("Fig. 10: signs of the force while a tool moves along the ellipsoid in +x") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>> solver(
      {.object = egg,
       .tool = {},
       .force = law,
       .friction = PowerLawFriction<double>({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3})});
  double highest = 0, x_of_highest = 1, first_normal_x = 0, last_normal_x = 0, first_friction_y = 0,
         last_friction_y = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double x = -0.03 + 1.5e-5 * i, z = 1e-6 * i;
    const V top = egg.raycast(V(x, 1, z), V(0, -1, 0)).position;
    (void)solver.tick(at(x, (top - 2e-3 * egg.normal(top)).y(), z));
    REQUIRE(solver.contacts().size() == 1);
    const ContactState<double>& c = solver.contacts()[0];
    if (c.mode != ContactMode::sliding || i < 400) continue;  // stuck at first, while the friction builds up
    const V normal = c.force - c.friction;
    CHECK(c.friction.x() < 0);
    CHECK(normal.y() > 0);
    if (first_normal_x == 0) first_normal_x = normal.x(), first_friction_y = c.friction.y();
    last_normal_x = normal.x();
    last_friction_y = c.friction.y();
    if (normal.y() > highest) highest = normal.y(), x_of_highest = x;
  }
  CHECK(first_normal_x < 0);
  CHECK(last_normal_x > 0);
  CHECK(std::abs(x_of_highest) < 0.002);  // largest at the top
  CHECK(first_friction_y * last_friction_y < 0);
}

TEST_CASE("without friction no closed path gains or loses energy") {
  constexpr std::uint64_t seed = 7;
  std::mt19937_64 random(seed);
  INFO("seed ", seed);
  ContactSolver<Box<double>, DuffingForce<double>, Frictionless<double>, Regions<4>> solver(
      {.object = block, .tool = face(7, 1e-3, 3e-5), .force = law, .contacts = {.distance = 1.5e-3}});
  for (int p = 0; p < 10; ++p) {
    const test::WanderingPath<Box<double>> path(block, V::Zero(), -2e-3, 2e-3, 0.0, random);
    double work = 0, scale = 0;
    constexpr int ticks = 20000;
    Pose<double> last = path.at(0);
    V before = solver.tick(last).wrench.force;
    for (int i = 1; i <= ticks; ++i) {
      const Pose<double> X = path.at(double(i) / ticks);
      const V now = solver.tick(X).wrench.force;
      const double step = 0.5 * (before + now).dot(X.translation - last.translation);
      work += step;
      scale += std::abs(step);
      before = now;
      last = X;
    }
    // Trapezoid rule on a force with kinks: its error is of the order (1/ticks)^2 per kink; 1e-4 is far above
    // it.
    CHECK(std::abs(work) <= 1e-4 * scale);
  }
}

TEST_CASE("regions that split and merge keep the tangential force") {
  // A tool with two feet on a flat face; tilting lifts the bridge between them.
  std::vector<V> points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(5e-4 * i, std::abs(i) > 4 ? 0 : 2e-4, 0);
  ToolPoints<double> tool(points, std::vector<double>(points.size(), 2.5e-7), {.contact_area = 2e-6});
  ContactSolver<Box<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4>> solver(
      {.object = block,
       .tool = std::move(tool),
       .force = law,
       .friction = PowerLawFriction<double>({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3}),
       .contacts = {.distance = 6e-4}});
  V before = V::Zero();
  std::size_t regions_before = 0;
  int splits = 0, merges = 0;
  double largest = 0;
  std::uint32_t id = 0;
  for (int i = 0; i < 6000; ++i) {
    const double depth = 1e-3 + 9e-4 * std::sin(2e-3 * i);  // the bridge touches below 0.2 mm
    const auto result = solver.tick(at(2e-6 * i, 0.02 - depth, 0));
    V friction = V::Zero();
    for (const auto& c : solver.contacts()) friction += c.friction;
    const std::size_t regions = solver.contacts().size();
    if (i > 600 && regions != regions_before) {
      (regions > regions_before ? splits : merges) += 1;
      largest = (std::max)(largest, (friction - before).norm());
    }
    if (i == 700) id = solver.contacts()[0].id;
    if (i == 5999) CHECK(solver.contacts()[0].id == id);
    before = friction;
    regions_before = regions;
    CHECK(result.status == Status::contact);
  }
  CHECK(splits >= 1);
  CHECK(merges >= 1);
  // One tick moves 2 um: the friction may change by the law's stiffness times that, and by mu times the
  // normal change.
  CHECK(largest <= 2 * law.stiffness(2e-3) * 2.7e-6);
}

TEST_CASE("a rate-dependent law uses dt, and only dt that makes sense") {
  const DampedForce<DuffingForce<double>> damped(law, {.damping = 1.0});
  ContactSolver<Box<double>, DampedForce<DuffingForce<double>>> solver(
      {.object = block, .tool = {}, .force = damped});
  (void)solver.tick(at(0, 0.019, 0), 1e-3);
  const auto pushed = solver.tick(at(0, 0.018, 0), 1e-3);  // 1 m/s inwards at 2 mm
  CHECK_RELATIVE(pushed.wrench.force.y(), damped.force(2e-3, 1.0),
                 1e-12);  // depth from 0.02 - y: 1e-14 relative
  CHECK(pushed.wrench.force.y() > law.force(2e-3));
  for (const double dt : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto result = solver.tick(at(0, 0.0175, 0), dt);
    CHECK(has(result.status, Status::invalid_step));
    CHECK_RELATIVE(result.wrench.force.y(), law.force(2.5e-3), 1e-12);
  }
}

TEST_CASE("force at the mass centre: the paper's form has no torque") {
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<>,
                AtMassCentre>
      paper({.object = egg, .tool = face(5, 1e-3, 1e-5), .force = law, .friction = dry});
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<>> full(
      {.object = egg, .tool = face(5, 1e-3, 1e-5), .force = law, .friction = dry});
  for (int i = 0; i < 100; ++i) {
    const Pose<double> X = at(0.01 + 1e-5 * i, 0.0385, 0);
    const auto a = paper.tick(X), b = full.tick(X);
    CHECK(a.wrench.force == b.wrench.force);
    CHECK(a.wrench.torque == V::Zero());
    CHECK(b.wrench.torque.norm() > 0);
  }
}

TEST_CASE("the same poses give the same bits") {
  const auto run = [] {
    ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4>> solver(
        {.object = egg,
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
  ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4>> solver(
      {.object = egg,
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

TEST_CASE("float follows double") {
  const auto run = []<class S>(S) {
    std::vector<Vec3<S>> points;
    for (int i = 0; i < 49; ++i) points.emplace_back(S(1e-3) * S(i % 7 - 3), S(0), S(1e-3) * S(i / 7 - 3));
    ContactSolver<Ellipsoid<S>, DuffingForce<S>, CoulombFriction<S>, Regions<4>> solver(
        {.object = Ellipsoid<S>({.axes = Vec3<S>(S(0.06), S(0.04), S(0.04))}),
         .tool = ToolPoints<S>(points, std::vector<S>(49, S(1e-6)), {.contact_area = S(4e-5)}),
         .force = DuffingForce<S>({.c1 = S(40), .c3 = S(3e8)}),
         .friction = CoulombFriction<S>({.mu_static = S(0.5), .mu_dynamic = S(0.3)}),
         .contacts = {.distance = 1.5e-3}});
    std::vector<Vec3<double>> forces;
    for (int i = 0; i < 400; ++i) {
      Pose<S> X;
      X.translation = Vec3<S>(S(2e-5) * S(i), S(0.038), S(0));
      forces.push_back(solver.tick(X).wrench.force.template cast<double>());
    }
    return forces;
  };
  const auto narrow = run(0.0f), wide = run(0.0);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    worst = (std::max)(worst, (narrow[i] - wide[i]).norm());
    largest = (std::max)(largest, wide[i].norm());
  }
  // 40 mm in float are known to 2.4e-9 m; times the stiffness at 2 mm, 3.6 kN/m, on some 49 points of 1/40
  // share: 1e-5 N.
  CHECK(worst <= 3e-5 * (std::max)(largest, 1.0));
}
