// SPDX-License-Identifier: MIT

/// @file The controller alone, on prescribed motion. Closed loops with device and hand: tests/stress.

#include <palpate/device/passivity_controller.hpp>
#include <palpate/device/stability_check.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace palpate;

namespace {

using V = Vec3<double>;

constexpr double k = 500;  // N/m
constexpr double pi = std::numbers::pi, dt = 1e-3;

// Nothing of its own: all energy has to be the hand's.
DeviceModel<double> bare(int delay = 0) {
  return {.damping = 0, .friction = 0, .resolution = 0, .delay = delay};
}

Pose<double> at(double y) {
  Pose<double> X;
  X.translation.y() = y;
  return X;
}

EnergyBounds<double> of_spring(double depth, double force) { return {force * depth / 4, force * depth}; }

/// A wall y < 0 whose force on the way out is `more` times that on the way in; in and out again 2 mm in a
/// second, with the force held from tick to tick and `delay` ticks late.
struct Press {
  std::vector<double> asked, given;
  double work = 0, most = 0, tick = 0;  // on the hand: at the end, at its most, and of one tick at most [J]
};
Press press(double more, int delay = 0) {
  PassivityController<double> control(bare(delay));
  Press p;
  std::vector<double> sent(static_cast<std::size_t>(delay) + 1, 0.0);
  double y_last = 1e-3;
  for (int i = 0; i <= 1000; ++i) {
    const double y = 1e-3 - 1.5e-3 * (1 - std::cos(2 * pi * i / 1000.0)), depth = (std::max)(0.0, -y);
    const double work = sent.front() * (y - y_last);  // of the force that was held on the way here
    p.work += work;
    p.most = (std::max)(p.most, p.work);
    p.tick = (std::max)(p.tick, std::abs(work));
    const double F = k * depth * (y > y_last ? more : 1);
    const Wrench<double> w = control.pass({V(0, F, 0), V::Zero()}, at(y), of_spring(depth, F), dt);
    p.asked.push_back(F);
    p.given.push_back(w.force.y());
    sent.erase(sent.begin());
    sent.push_back(w.force.y());
    y_last = y;
  }
  return p;
}

}  // namespace

TEST_CASE("passivity controller: a spring's force passes bit for bit until what the hold makes is due") {
  const Press p = press(1);
  int first = 1000;
  for (int i = 1000; i >= 0; --i)
    if (p.given[std::size_t(i)] != p.asked[std::size_t(i)]) first = i;
  // Hold makes k dx^2 / 2 in each tick, in and out: k times 1e-3 x the mean of |dx| dx ... 2 % of U here, so
  // the controller acts where less than half of 2 % is stored: in the last tenth of the depth.
  REQUIRE(first < 1000);
  CHECK(p.asked[std::size_t(first)] < 0.2 * k * 2e-3);
  CHECK(first > 500);
  CHECK(p.work <= 0);
  CHECK(p.work > -0.02 * 0.5 * k * 4e-6);
}

TEST_CASE("passivity controller: a force that gives back more than it took makes no energy, with any delay") {
  for (const int delay : {0, 1, 2, 8}) {
    for (const double more : {1.0, 1.02, 1.3, 3.0}) {
      INFO(delay, " ticks, ", more);
      const Press p = press(more, delay);
      // A prescribed motion goes on whatever the force is, unlike the free arm that is predicted: one tick's
      // work at most is spent unforeseen.
      CHECK(p.most <= p.tick);
      for (std::size_t i = 0; i < p.given.size(); ++i) CHECK(p.given[i] <= p.asked[i]);
    }
  }
}

TEST_CASE("passivity controller: a force that takes energy is left alone until its last tick") {
  const Press p = press(0.7);
  int changed = 0;  // in the last tick less is stored than the force would do on its way past the surface
  for (std::size_t i = 0; i < p.asked.size(); ++i) changed += p.given[i] != p.asked[i];
  CHECK(changed <= 1);
  CHECK(p.work < 0);
}

// a s^2 + b s = 0: a push of the motors over one tick does no work if it stops the arm and no more.
TEST_CASE("passivity controller: with nothing stored a fast entry meets the force that stops the arm") {
  for (const double asked : {0.3, 0.9, 5.0}) {
    PassivityController<double> control(bare());
    constexpr double speed = 0.01;
    (void)control.pass({}, at(0), {0, 1}, dt);
    const auto given = control.pass({V(0, asked, 0), V::Zero()}, at(-speed * dt), {0, 1}, dt);
    CHECK_RELATIVE(given.force.y(), (std::min)(asked, bare().mass * speed / dt), 1e-12);  // 0.45 N
  }
}

TEST_CASE("passivity controller: torque does work as well") {
  PassivityController<double> control(bare());
  double work = 0, tick = 0, held = 0;
  for (int i = 0; i <= 200; ++i) {  // a spring of 1 N m/rad that pushes twice as much on the way back
    const auto angle = [](int n) { return 0.1 * std::sin(pi * n / 200.0); };
    Pose<double> X;
    X.rotation = Eigen::AngleAxis<double>(angle(i), V::UnitX()).toRotationMatrix();
    if (i > 0) work += held * (angle(i) - angle(i - 1));
    const double torque = -(i <= 100 ? 1 : 2) * angle(i);
    const double stored = -torque * angle(i);
    held = control.pass({V::Zero(), V(torque, 0, 0)}, X, {stored / 4, stored}, dt).torque.x();
    tick = (std::max)(tick, std::abs(held * (angle(i) - angle(i - 1))));
  }
  CHECK(work <= tick);
  CHECK(held == 0);
}

TEST_CASE("passivity controller: what friction took is not given back") {
  PassivityController<double> control(bare());
  // 5 s of sliding at 0.1 m/s against 1 N, pressed by 2 N to 1 mm.
  Pose<double> X;
  const EnergyBounds<double> stored = of_spring(1e-3, 2);
  for (int i = 0; i < 5000; ++i) {
    X.translation.x() = 1e-4 * i;
    (void)control.pass({V(-1, 2, 0), V::Zero()}, X, stored, dt);
  }
  CHECK(control.budget() <= stored.most);  // of 500 mJ
}

TEST_CASE("passivity controller: the arm's own losses on the way out pay for what the hold makes") {
  // A stiff wall, pressed slowly, then shaken by steps of dx: the hold makes K dx^2 in each pair of them.
  const auto scale_after = [](double damping, double friction) {
    PassivityController<double> control(
        {.damping = damping, .friction = friction, .resolution = 0, .delay = 0});
    double least = 1;
    for (int i = 0; i < 20000; ++i) {
      const double depth = i < 10000 ? 1e-7 * i : 1e-3 + 1e-4 * (std::abs(i % 20 - 10) - 10) / 2;
      const double F = 4000 * depth;
      (void)control.pass({V(0, F, 0), V::Zero()}, at(-depth), of_spring(depth, F), dt);
      least = (std::min)(least, control.scale());
    }
    return least;
  };
  // Half of it is made on the way in, where losses do not count: twice K T/2 and twice K dx/2 balance it.
  CHECK(scale_after(0, 0) < 0.1);
  CHECK(scale_after(3, 0) < 1);
  CHECK(scale_after(4.01, 0) == 1);   // b = K T
  CHECK(scale_after(0, 0.201) == 1);  // f_c = K dx
}

TEST_CASE("passivity controller: in free air nothing is sent and a debt is worked off") {
  PassivityController<double> control({.friction = 0.1, .resolution = 0, .delay = 0});
  // An object that pushes without having been pressed: one tick's work is unforeseen.
  (void)control.pass({}, at(0), {}, dt);
  (void)control.pass({V(0, 2, 0), V::Zero()}, at(-1e-4), of_spring(1e-4, 2), dt);
  (void)control.pass({V(0, 2, 0), V::Zero()}, at(1e-3), of_spring(1e-4, 2), dt);
  const double debt = control.budget();
  REQUIRE(debt < 0);
  CHECK(control.scale() == 0);
  for (int i = 2; i < 100; ++i) {
    CHECK(control.pass({}, at(1e-3 * i), {}, dt).force == V::Zero());
    CHECK(control.scale() == 1);  // of nothing
  }
  CHECK(control.budget() == 0);
}

TEST_CASE("passivity controller: what is not finite gives a zero wrench, and all is forgotten") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Wrench<double> w{V(0, 1, 0), V::Zero()};
  const auto pressed = [&] {
    PassivityController<double> control(bare());
    (void)control.pass({}, at(0), {}, dt);
    for (int i = 1; i < 10; ++i) (void)control.pass(w, at(-1e-4 * i), of_spring(1e-4 * i, 1), dt);
    REQUIRE(control.budget() > 0);
    return control;
  };
  const auto zeroes = [&](const Wrench<double>& wrench, const Pose<double>& X, EnergyBounds<double> stored,
                          double step) {
    auto control = pressed();
    const Wrench<double> out = control.pass(wrench, X, stored, step);
    CHECK(out.force == V::Zero());
    CHECK(out.torque == V::Zero());
    CHECK(control.budget() == 0);
    // The next good tick is finite, a passive one passes again.
    CHECK(is_finite(control.pass(w, at(-1e-3), of_spring(1e-3, 1), dt).force));
  };
  const EnergyBounds<double> stored = of_spring(1e-3, 1);
  zeroes({V(0, nan, 0), V::Zero()}, at(-1e-3), stored, dt);
  zeroes({V::Zero(), V(inf, 0, 0)}, at(-1e-3), stored, dt);
  zeroes(w, at(nan), stored, dt);
  zeroes(w, {Mat3<double>::Zero(), V::Zero()}, stored, dt);
  zeroes(w, at(-1e-3), {nan, 1}, dt);
  zeroes(w, at(-1e-3), stored, nan);
  zeroes(w, at(-1e-3), stored, -dt);
  auto control = pressed();
  CHECK(is_finite(control.pass(w, at(-1e-3), stored, 0).force));  // no time has passed
  auto slow = pressed();
  for (int i = 0; i < 20; ++i) {  // the mean step is 1e199 s for as long as it is kept
    const Wrench<double> out =
        slow.pass(i % 2 ? w : Wrench<double>{}, at(-1e-3), stored, i == 0 ? 1e200 : dt);
    CHECK(is_finite(out.force));
    CHECK(slow.scale() >= 0);
    CHECK(slow.scale() <= 1);
  }
}

TEST_CASE("passivity controller: a lost tick does not change the force on a tool that rests") {
  for (const int delay : {0, 1, 2}) {
    PassivityController<double> control({.delay = delay});
    double depth = 0, before = 0;
    const auto tick = [&](double step) {
      const double F = k * depth;
      return control.pass({V(0, F, 0), V::Zero()}, at(-depth), of_spring(depth, F), step).force.y();
    };
    for (int i = 0; i < 400; ++i) {
      depth = 2e-3 * (std::min)(1.0, i / 300.0);
      before = tick(dt);
    }
    REQUIRE(before == k * depth);
    for (const int lost : {1, 2, 5}) CHECK(tick((1 + lost) * dt) == before);
  }
}

TEST_CASE("passivity controller: in a lost tick the newest wrench was sent once more") {
  // So heavy that all forces pass; two ticks of delay.
  PassivityController<double> control(
      {.mass = 1e9, .inertia = 1e9, .damping = 0, .friction = 0, .resolution = 0, .delay = 2});
  double y = 0;
  const auto tick = [&](double F, double moved, double step) {
    y += moved;
    CHECK(control.pass({V(0, F, 0), V::Zero()}, at(y), {0, 1}, step).force.y() == F);
    return control.budget();
  };
  for (int i = 0; i < 20; ++i) tick(0, 0, dt);
  for (int i = 0; i < 20; ++i) tick(10, -1e-4, dt);  // the hand puts something in
  for (const double F : {10.0, 10.0, 10.0, 1.0, 2.0}) tick(F, 0, dt);
  double budget = tick(3, 0, dt);
  CHECK(tick(4, 0, 2 * dt) == budget);  // between 3 and 4 a tick was lost: the driver had 3, 3, 4
  for (const double acted : {3.0, 3.0, 4.0}) {
    const double now = tick(5, -1e-4, dt);
    CHECK_RELATIVE(now - budget, acted * 1e-4, 1e-9);
    budget = now;
  }
  // Of those that acted in a step with lost ticks, 5 and 5 and 9, the least favourable counts: coming out, 9.
  tick(9, 0, dt), tick(9, 0, dt);
  CHECK_RELATIVE(tick(9, 1e-4, 3 * dt) - budget, -9e-4, 1e-9);
}

TEST_CASE("passivity controller: no heap; float as double") {
  const test::HeapCount heap;
  PassivityController<float> control({});
  for (int i = 0; i < 100; ++i) {
    Pose<float> X;
    X.translation.y() = -1e-5F * float(i);
    const float F = 500 * 1e-5F * float(i);
    const auto out = control.pass({{0, F, 0}, {0, 0, 0}}, X, {F * 1e-5F * float(i) / 4, F}, 1e-3F);
    CHECK(out.force.y() == F);
  }
  CHECK(heap.allocations() == 0);
}

TEST_CASE("stored energy: bounds hold for laws from linear to cubic, and for a stretched contact") {
  ContactState<double> c{};
  c.normal = V::UnitY();
  c.displacement = V(0, -2e-3, 0);
  c.normal_force = 3;
  c.depth = 2e-3;
  c.friction = V::Zero();
  for (const double p : {1.0, 1.5, 3.0}) {  // F = k D^p stores F D / (p + 1)
    const EnergyBounds<double> bounds = stored_energy<double>({&c, 1});
    const double U = 3 * 2e-3 / (p + 1);
    CHECK(bounds.least <= U * (1 + 1e-15));
    CHECK(bounds.most >= U);
  }
  c.displacement.x() = 1e-3;
  c.friction = V(-1, 0, 0);
  CHECK_RELATIVE(stored_energy<double>({&c, 1}).most, 3 * 2e-3 + 1e-3, 1e-14);
}

TEST_CASE("device model: each bad value is named; limits are those of the literature") {
  const auto message = [](DeviceModel<double> device) -> std::string {
    try {
      PassivityController<double> control(device);
    } catch (const SetupError& e) {
      return e.what();
    }
    return "";
  };
  CHECK(message({.mass = 0}).find("mass [kg] must be > 0, got 0") != std::string::npos);
  CHECK(message({.inertia = -1}).find("inertia [kg m^2]") != std::string::npos);
  CHECK(message({.damping = -1}).find("damping [N s/m]") != std::string::npos);
  CHECK(message({.rotational_damping = -1}).find("rotational_damping") != std::string::npos);
  CHECK(message({.friction = -1}).find("friction [N]") != std::string::npos);
  CHECK(message({.resolution = -1}).find("resolution [m]") != std::string::npos);
  CHECK(message({.delay = 9}).find("delay [ticks] must be in [0, 8], got 9") != std::string::npos);
  CHECK(message({}).empty());

  // K < 2 (b - B)/T without delay, a third of it with one tick's.
  DeviceModel<double> arm{.damping = 0.8, .friction = 0.1, .resolution = 5e-5, .delay = 0};
  CHECK_RELATIVE(passive_stiffness(arm, 1e-3), 1600, 1e-14);
  CHECK_RELATIVE(passive_stiffness(arm, 1e-3, 0.2), 1200, 1e-14);
  arm.delay = 1;
  CHECK_RELATIVE(passive_stiffness(arm, 1e-3), 1600.0 / 3, 1e-14);
  CHECK_RELATIVE(quantisation_stiffness(arm), 4000, 1e-14);
  arm.rotational_damping = 3e-3;
  CHECK_RELATIVE(passive_rotational_stiffness(arm, 1e-3), 2, 1e-14);

  CHECK(check_stability(200.0, 2.0, 1e-3, arm).is_passive());
  CHECK_FALSE(check_stability(300.0, 2.0, 1e-3, arm).is_passive());
  CHECK(check_stability(300.0, 2.0, 1e-3, arm, 650.0).is_nominal());
  CHECK_FALSE(check_stability(300.0, 2.0, 1e-3, arm, 550.0).is_nominal());
  CHECK(std::string(check_stability(300.0, 2.0, 1e-3, arm, 550.0).advice()).find("VirtualCoupling") !=
        std::string::npos);

  // In rotation 2 N m/rad, whatever the workspace's scale: that turns nothing.
  for (const double scale : {1.0, 2.0}) {
    CHECK(check_stability(200.0, scale, 1e-3, arm, 0.0, 1.99).is_passive());
    const auto stiff = check_stability(200.0, scale, 1e-3, arm, 0.0, 2.01);
    CHECK_FALSE(stiff.is_passive());
    CHECK_FALSE(stiff.is_passive_in_rotation());
    CHECK(std::string(stiff.advice()).find("in rotation") != std::string::npos);
  }
  // What is worse is said first: the maker's figure, then translation.
  CHECK(std::string(check_stability(300.0, 2.0, 1e-3, arm, 550.0, 9.0).advice()).find("own figure") !=
        std::string::npos);
  CHECK(std::string(check_stability(300.0, 2.0, 1e-3, arm, 0.0, 9.0).advice()).find("in rotation") ==
        std::string::npos);
  CHECK(check_stability(300.0, 2.0, 1e-3, arm, 0.0, 1.0).is_passive_in_rotation());
}
