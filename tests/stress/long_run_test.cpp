// SPDX-License-Identifier: MIT

/// @file What is right for a second must be right for an hour: stiction does not creep, a closed path gives
/// the same force in every round, and hands that slide, chatter over an edge or hold two pins gain nothing.
/// PALPATE_STRESS in the environment (tests/run --stress): 1e9 ticks of stiction, hours at 1 kHz.

#include <palpate/device/servo_chain.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/closed_loop.hpp>
#include <support/pins.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

using namespace palpate;

namespace {

using V = Vec3<double>;

const bool thorough = std::getenv("PALPATE_STRESS") != nullptr;
constexpr double pi = std::numbers::pi;
constexpr long second = 1000;  // ticks
const long hour = thorough ? 3600 * second : 20 * second;

const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
const Box<double> block({.half = V(0.1, 0.05, 0.1)});
const DuffingForce<double> law({.c1 = 800, .c3 = 1e7});
const PowerLawFriction<double> fibre({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.3});
const CoulombFriction<double> rough({.mu_static = 0.5, .mu_dynamic = 0.4});

template <class Friction, class Object, class Contacts = SinglePoint>
using Solver = ContactSolver<Object, DuffingForce<double>, Friction, Contacts>;
using Point = Solver<PowerLawFriction<double>, Ellipsoid<double>>;
using Pins = Solver<PowerLawFriction<double>, Ellipsoid<double>, Regions<4, AreaSharing>>;

Point point_on_egg() { return Point({.object = egg, .tool = {}, .force = law, .friction = fibre}); }
Pins pins_on_egg() {
  return Pins({.object = egg,
               .tool = test::pins(3e-3, {-8e-3, 8e-3}),
               .force = law,
               .friction = fibre,
               .contacts = {1.2e-3}});
}

/// On the egg's upper side, pushed along the surface, far below the limit: so far, and turned so far about
/// the normal. Eight poses in turn, a few micrometres apart: none is the last one, whose tick would be
/// skipped.
template <class Solver>
Pose<double> held(const Solver&, long tick) {
  constexpr double depth = std::is_same_v<Solver, Point> ? 1.5e-3 : 2.5e-3;
  const double phase = pi / 4 * static_cast<double>(tick % 8);
  Pose<double> X;
  X.rotation = Eigen::AngleAxis<double>(2e-4 * std::sin(phase), V::UnitY()).toRotationMatrix();
  X.translation = V(4e-3, 0.04 - depth, 2e-3) + 5e-6 * V(std::cos(phase), 0, std::sin(phase));
  return X;
}

/// Largest change of force [N] and torque [N m] at the same pose from the second round of eight ticks to any
/// later one, over their sizes.
template <class Solver>
double creep(Solver solver, long ticks) {
  const V push(2e-5, 0, 1e-5);
  std::array<Pose<double>, 8> poses;
  for (long i = 0; i < 8; ++i) {
    poses[static_cast<std::size_t>(i)] = held(solver, i);
    poses[static_cast<std::size_t>(i)].translation += push;
  }
  (void)solver.tick(held(solver, 0));  // here it sticks
  std::array<Wrench<double>, 8> first;
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < 8; ++i) first[i] = solver.tick(poses[i]).wrench;
  double force = 0, torque = 0;
  for (long tick = 16; tick < ticks; ++tick) {
    const auto i = static_cast<std::size_t>(tick % 8);
    const Wrench<double> wrench = solver.tick(poses[i]).wrench;
    force = (std::max)(force, (wrench.force - first[i].force).squaredNorm());
    torque = (std::max)(torque, (wrench.torque - first[i].torque).squaredNorm());
  }
  CHECK(solver.contacts().size() > 0);
  for (const auto& contact : solver.contacts()) {
    CHECK(contact.mode == ContactMode::sticking);
    CHECK(contact.friction.norm() > 0.01);
  }
  return (std::max)(std::sqrt(force) / first[0].force.norm(),
                    first[0].torque.norm() > 0 ? std::sqrt(torque) / first[0].torque.norm() : 0);
}

/// A tool that slides round and round on a closed path: largest change of the force from the second round to
/// any later one, over its size, and the most work [J] that any round gives to the hand.
struct Rounds {
  double change = 0, work = -1e300;
};
template <class Solver>
Rounds slide(Solver solver, long ticks) {
  std::vector<Pose<double>> path;
  for (long i = 0; i < second; ++i) {
    const double phase = 2 * pi * static_cast<double>(i) / static_cast<double>(second);
    Pose<double> X = held(solver, 0);
    X.translation += V(5e-3 * std::sin(phase), 3e-4 * std::sin(3 * phase), 4e-3 * std::sin(2 * phase));
    X.rotation = Eigen::AngleAxis<double>(0.2 * std::sin(phase), V::UnitY()).toRotationMatrix();
    path.push_back(X);
  }
  std::vector<V> first(path.size());
  Rounds rounds;
  V before = V::Zero();
  for (long round = 0; round < ticks / second; ++round) {
    double work = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const V force = solver.tick(path[i]).wrench.force;
      if (i > 0) work += (before + force).dot(path[i].translation - path[i - 1].translation) / 2;
      before = force;
      if (round == 1) first[i] = force;
      if (round > 1) rounds.change = (std::max)(rounds.change, (force - first[i]).norm() / first[i].norm());
    }
    if (round > 0) rounds.work = (std::max)(rounds.work, work);
  }
  return rounds;
}

/// Device and hand with a solver and the chain, for an hour.
struct Held {
  double made = 0, quantised = 0;  ///< in the hour; what quantisation explains in the first 20 s [J]
  double round = -1e300;           ///< most that any second gives to the hand [J]
  double drift = 0;                ///< of a second's mean force, from the fifth second to any later one [N]
  long touches = 0;                ///< how often contact began
};
template <class Solver, class Script>
Held hold(Solver solver, const test::LoopDevice& device, const V& from, const V& centre_of_mass,
          const Script& script) {
  typename ServoChain<Solver>::Params params{.device = test::model_of(device),
                                             .has_torque = device.inertia > 0};
  params.mapping.centre_of_mass = centre_of_mass;
  params.limits = {.max_force = 50, .max_torque = 5, .arm_after = 0, .ramp_time = 0, .max_speed = 10};
  ServoChain<Solver> chain(solver, params);
  test::ClosedLoop loop(device, {}, from);
  Held seen;
  V mean = V::Zero();
  double given = 0;
  bool touching = false;
  for (long n = 0; n < hour / second; ++n) {
    loop.begin_window();
    for (long i = 0; i < second; ++i)
      loop.tick(script, [&](const Pose<double>& X, double dt) {
        const auto out = chain.tick(X, dt);
        const bool touches = has(out.result.status, Status::contact);
        seen.touches += touches && !touching;
        touching = touches;
        return out.wrench;
      });
    if (n == 4) mean = loop.mean_wrench().force;
    if (n >= 4) {
      seen.drift = (std::max)(seen.drift, (loop.mean_wrench().force - mean).norm());
      seen.round = (std::max)(seen.round, loop.to_hand - given);
    }
    given = loop.to_hand;
    if (n == 19) seen.quantised = loop.most_quantised();
  }
  CHECK(mean.norm() > 0.1);  // it touches
  seen.made = loop.most_made();
  return seen;
}

void print(const char* name, const Held& h) {
  std::printf(
      "%-28s %ld s: made %.2g mJ, quantisation %.2g mJ; a second gives the hand at most %.2g mJ; "
      "drift of its mean force %.2g N; touches %ld\n",
      name, hour / second, 1e3 * h.made, 1e3 * h.quantised, 1e3 * h.round, h.drift, h.touches);
}

}  // namespace

// A contact that sticks keeps where it sticks, in the object's frame: nothing is added up, so nothing drifts.
TEST_CASE("stress: stiction under load does not creep by a bit") {
  const double point = creep(point_on_egg(), thorough ? 1000000000 : 100000);
  const double pins = creep(pins_on_egg(), thorough ? 10000000 : 10000);
  std::printf("stiction, change of the wrench: a point %.2g, two pins %.2g\n", point, pins);
  CHECK(point == 0);
  CHECK(pins == 0);
}

TEST_CASE("stress: a closed path gives the same force in every round of an hour, and no round gives work") {
  const Rounds point = slide(point_on_egg(), hour), pins = slide(pins_on_egg(), hour);
  std::printf(
      "sliding round and round, change of the force: a point %.2g, two pins %.2g; most work of a round "
      "%.2g, %.2g mJ\n",
      point.change, pins.change, 1e3 * point.work, 1e3 * pins.work);
  CHECK(point.change < 1e-12);
  CHECK(pins.change < 1e-12);
  CHECK(point.work < 0);
  CHECK(pins.work < 0);
}

TEST_CASE("stress: an hour of sliding, of chatter at an edge and of two pins gives the hand nothing") {
  using Tip = ContactSolver<Box<double>, LinearForce<double>, CoulombFriction<double>>;
  const auto tip = [] {
    return Tip({.object = block, .tool = {}, .force = LinearForce<double>({.k = 2000}), .friction = rough});
  };
  // Periods jitter, so that no second is like another.
  const test::LoopDevice arm{.delay = 1, .jitter = 0.05};
  const auto swing = [](double t, double hertz) {
    return std::pair(std::sin(2 * pi * hertz * t), 2 * pi * hertz * std::cos(2 * pi * hertz * t));
  };

  const Held sliding = hold(tip(), arm, V(0, 0.05, 0), V::Zero(), [&](double t) {
    const auto [x, vx] = swing(t, 1);
    const auto [z, vz] = swing(t, 2);
    return test::HandTarget{.position = V(0.01 * x, 0.04, 0.01 * z), .velocity = V(0.01 * vx, 0, 0.01 * vz)};
  });
  print("sliding", sliding);

  // Over the edge at x = 0.1 and back, ten times a second, pressing on it.
  const Held chatter = hold(tip(), arm, V(0.09, 0.05, 0), V::Zero(), [&](double t) {
    const auto [x, vx] = swing(t, 10);
    return test::HandTarget{.position = V(0.1 + 5e-3 * x, 0.047, 0), .velocity = V(5e-3 * vx, 0, 0)};
  });
  print("chatter at an edge", chatter);

  const test::LoopDevice turning{.inertia = 5e-5,
                                 .angular_viscous = 3e-4,
                                 .angular_coulomb = 1e-3,
                                 .angular_resolution = 1e-3,
                                 .delay = 1,
                                 .jitter = 0.05};
  const Pins two = pins_on_egg();
  const Held pins = hold(two, turning, V(0, 0.04, 0), two.centre_of_mass(), [&](double t) {
    const auto [x, vx] = swing(t, 1);
    const auto [turn, spin] = swing(t, 2);
    return test::HandTarget{.position = V(5e-3 * x, 0.03, 0),
                            .velocity = V(5e-3 * vx, 0, 0),
                            .turn = V(0, 0.3 * turn, 0),
                            .spin = V(0, 0.3 * spin, 0)};
  });
  print("two pins", pins);

  CHECK(chatter.touches >= 9 * (hour / second));  // ten times a second
  for (const Held& h : {sliding, chatter, pins}) {
    CHECK(h.made <= h.quantised);
    CHECK(h.round < 0);
    CHECK(h.drift <= 2000 * 2 * arm.resolution);  // two encoder steps of the stiffest of them
  }
}
