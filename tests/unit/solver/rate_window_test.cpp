// SPDX-License-Identifier: MIT
#include <palpate/geometry/box.hpp>
#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <support/check.hpp>

#include <cmath>
#include <random>
#include <string>

using namespace palpate;
using V = Vec3<double>;

namespace {

using Damped = DampedForce<LinearForce<double>>;
using Solver = ContactSolver<Box<double>, Damped>;
const Box<double> block({.half = V(0.05, 0.02, 0.05)});
const Damped damped(LinearForce<double>({.k = 1000}), {.damping = 10});
constexpr double speed = 0.05, dt = 1e-3;       // m/s inwards, s
constexpr double right = 1 + 1.5 * 10 * speed;  // F/kD by Hunt and Crossley: 1.75

Pose<double> at_depth(double depth) {
  Pose<double> X;
  X.translation = V(0, 0.02 - depth, 0);
  return X;
}
double ratio(Solver& solver, double depth) {
  return solver.tick(at_depth(depth), dt).wrench.force.y() / (1000 * depth);
}

}  // namespace

TEST_CASE("poses that are new only every 1, 2, 3, 4 ticks: the rate is right, and does not step") {
  for (const int every : {1, 2, 3, 4}) {
    Solver solver({.object = block, .tool = {}, .force = damped});
    double worst = 0;
    for (int tick = 0; tick < 200; ++tick) {
      const double depth = 1e-3 + speed * dt * (tick / every * every);
      const double now = ratio(solver, depth);
      if (tick > 2 * every) worst = (std::max)(worst, std::abs(now - right));
    }
    CHECK_ABSOLUTE(worst, 0, 1e-9);  // differences of positions of 20 mm over steps of 50 um
  }
}

TEST_CASE("poses that come after 1, 2 or 3 ticks, by chance, and to steps of 10 um: within 3 %") {
  std::mt19937_64 random(2000);  // fixed seed
  std::uniform_int_distribution<int> ticks(1, 3);
  Solver solver({.object = block, .tool = {}, .force = damped});
  double depth = 1e-3, worst = 0, step = 0, before = right;
  int next = 0;
  for (int tick = 0; tick < 200; ++tick) {
    if (tick == next) {
      depth = 1e-5 * std::round((1e-3 + speed * dt * tick) / 1e-5);
      next += ticks(random);
    }
    const double now = ratio(solver, depth);
    if (tick > 10) {
      worst = (std::max)(worst, std::abs(now - right) / right);
      step = (std::max)(step, std::abs(now - before) / right);
    }
    before = now;
  }
  CHECK(
      worst <=
      0.03);  // half a step of 10 um over half the window, 8 poses of 2 ms: 0.6 mm/s of 50, and as much again
  CHECK(step <= 0.03);
}

TEST_CASE("a slow slide into an encoder of 10 um steps: no tick is damped as a step of 10 um in 1 ms") {
  constexpr double slow = 2e-3;  // m/s: a new position every 5 ms
  Solver solver({.object = block, .tool = {}, .force = damped});
  double most = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double depth = 1e-5 * std::floor((1e-3 + slow * dt * tick) / 1e-5 + 0.5);
    const double now = ratio(solver, depth);
    if (tick > 20) most = (std::max)(most, std::abs(now - (1 + 15 * slow)));
  }
  // A tick in two intervals of 5 ms; one tick is off by 400 %.
  CHECK(most <= 15 * slow * 0.12);
}

TEST_CASE("a tool that stops: the rate falls to nothing within the window, and then nothing is worked out") {
  Solver solver({.object = block, .tool = {}, .force = damped});
  double depth = 1e-3;
  for (int tick = 0; tick < 50; ++tick) (void)ratio(solver, depth += speed * dt);
  double before = right;
  for (int tick = 1; tick <= 30; ++tick) {
    const double now = ratio(solver, depth);
    CHECK(now <= before * (1 + 1e-12));
    if (tick >= 4) CHECK(now - 1 <= 0.3 * (right - 1));  // three intervals late: no faster than a third
    if (tick > 20) CHECK_ABSOLUTE(now, 1, 1e-12);
    before = now;
  }
}

TEST_CASE("a rate at each tick of a motion that turns: within the resolution over the window") {
  Solver solver({.object = block, .tool = {}, .force = damped});
  double worst = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double t = dt * tick, w = 2 * 3.14159265358979323846 * 4;  // 4 Hz, 2 mm: 50 mm/s
    const double depth = 4e-3 + 2e-3 * std::sin(w * t);
    const double F = solver.tick(at_depth(depth), dt).wrench.force.y() / (1000 * depth);
    if (tick > 20) worst = (std::max)(worst, std::abs(F - (1 + 15 * 2e-3 * w * std::cos(w * t))));
  }
  // A line within d = 10 um of an arc of curvature A w^2 = 1.26 m/s^2 is T = sqrt(8 d/(A w^2)) = 8 ms long
  // and lags by half of that: 5 mm/s of 50. One more pose of 1 ms may be in.
  CHECK(worst <= 15 * 1.26 * 0.0055);
}

TEST_CASE("damping by the window only takes energy, from motions of one step of the encoder upwards") {
  for (const double amplitude : {1e-5, 2e-5, 1e-4, 1e-3, 5e-3}) {
    for (const double hertz : {1.0, 5.0, 20.0, 60.0, 150.0}) {
      Solver solver({.object = block, .tool = {}, .force = damped});
      double work = 0, before = 0, last = 0;
      for (int tick = 0; tick <= 2000; ++tick) {  // whole periods
        const double depth = 7e-3 + amplitude * std::sin(2 * 3.14159265358979323846 * hertz * dt * tick);
        const double F = solver.tick(at_depth(depth), dt).wrench.force.y() - 1000 * depth;
        if (tick > 1000) work += 0.5 * (F + before) * (depth - last);
        before = F;
        last = depth;
      }
      INFO(amplitude, " m, ", hertz, " Hz");
      CHECK(work > 0);
    }
  }
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("a window that makes no sense is refused by name and value") {
  const auto message = [](RateWindow<double> rate) {
    try {
      Solver solver({.object = block, .tool = {}, .force = damped, .rate = rate});
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message({.resolution = 0}).empty());
  CHECK(message({.resolution = -1}) == "RateWindow: resolution [m] must be >= 0 and finite, got -1");
  CHECK(message({.longest = 0}) == "RateWindow: longest [s] must be > 0 and finite, got 0");
}
#endif
