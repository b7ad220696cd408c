// SPDX-License-Identifier: MIT

#include <palpate/device/energy_limit.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <numbers>
#include <vector>

using namespace palpate;

namespace {

using V = Vec3<double>;

constexpr double k = 500;  // N/m
constexpr double pi = std::numbers::pi;

ContactState<double> touching(double depth, double force) {
  return {1,
          1,
          ContactMode::frictionless,
          V::Zero(),
          V::UnitY(),
          V(0, -depth, 0),
          V(0, force, 0),
          V::Zero(),
          force,
          0,
          depth};
}

// A wall y < 0 whose force on the way out is `more` times that on the way in; in and out again 2 mm in a
// second.
struct Press {
  std::vector<double> asked, given, stored;
  double work = 0, most = 0, tick = 0;  // on the hand: at the end, at its most, and of one tick at most [J]
};
Press press(double more) {
  EnergyLimit<double> limit({});
  Press p;
  V last = V::Zero();
  Pose<double> X;
  double y_last = 1e-3;
  for (int i = 0; i <= 1000; ++i) {
    const double y = 1e-3 - 1.5e-3 * (1 - std::cos(2 * pi * i / 1000.0)), depth = (std::max)(0.0, -y);
    const double F = k * depth * (y > y_last ? more : 1);
    std::vector<ContactState<double>> contacts;
    if (depth > 0) contacts.push_back(touching(depth, F));
    X.translation = V(0, y, 0);
    const Wrench<double> w = limit.pass({V(0, F, 0), V::Zero()}, X, contacts);
    const double work = (last + w.force).y() * (y - y_last) / 2;
    if (i > 0) p.work += work;
    p.most = (std::max)(p.most, p.work);
    p.tick = (std::max)(p.tick, std::abs(work));
    p.asked.push_back(F);
    p.given.push_back(w.force.y());
    p.stored.push_back(limit.stored());
    last = w.force;
    y_last = y;
  }
  return p;
}

}  // namespace

TEST_CASE("energy limit: a spring passes bit for bit until its last tick, and all its energy comes back") {
  const Press p = press(1);
  int changed = 0;
  for (std::size_t i = 0; i < p.asked.size(); ++i) changed += p.given[i] != p.asked[i];
  CHECK(changed <= 1);  // the step over the surface, of which only a part is in contact
  CHECK_ABSOLUTE(p.work, 0, p.tick);
  CHECK(p.stored[500] > 0.99 * 0.5 * k * 4e-6);
}

TEST_CASE("energy limit: what a force would give back in excess is held back, without a jump") {
  for (const double more : {1.02, 1.3, 3.0}) {
    const Press p = press(more);
    CHECK(p.most <= 0.5 * p.tick + 1e-15);
    CHECK(p.work > -0.1 * 0.5 * k * 4e-6);  // and not much more than that
    // s = E / U on the way out, U = k D^2 / 4: d(s F)/dD = 3 s k; a step is a hundredth of D or less.
    const double step = k * 1.5e-3 * 2 * pi / 1000 * more;
    for (std::size_t i = 502; i < p.given.size(); ++i) {
      CHECK(p.given[i] <= p.asked[i]);
      CHECK(std::abs(p.given[i] - p.given[i - 1]) <= 1.01 * 3 * step);
    }
  }
}

TEST_CASE("energy limit: a force that takes energy is left alone") {
  const Press p = press(0.7);
  CHECK(p.given == p.asked);
  CHECK(p.work < 0);
}

TEST_CASE("energy limit: torque does work as well") {
  EnergyLimit<double> limit({});
  const ContactState<double> contact = touching(1e-3, 1);
  double work = 0, tick = 0;
  V last = V::Zero();
  for (int i = 0; i <= 200; ++i) {  // a spring of 1 N m/rad that pushes twice as much on the way back
    const double angle = 0.1 * std::sin(pi * i / 200.0), slope = std::cos(pi * i / 200.0);
    Pose<double> X;
    X.rotation = Eigen::AngleAxis<double>(angle, V::UnitX()).toRotationMatrix();
    const Wrench<double> w = limit.pass({V::Zero(), V(-(slope > 0 ? 1 : 2) * angle, 0, 0)}, X, {&contact, 1});
    const double turn = 0.1 * (std::sin(pi * i / 200.0) - std::sin(pi * (i - 1) / 200.0));
    if (i > 0) work += (last + w.torque).x() * turn / 2;
    tick = (std::max)(tick, std::abs(w.torque.x() * turn));
    last = w.torque;
  }
  CHECK(work <= 0.5 * tick + 1e-9);  // sin for the angle: a relative 4e-7
}

TEST_CASE("energy limit: parameters that are not finite are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(EnergyLimit<double>({.centre_of_mass = V(0, nan, 0)}), SetupError);
  CHECK_THROWS_AS(EnergyLimit<double>({.contact_area = -1}), SetupError);
}

TEST_CASE("energy limit: free of contact everything passes, what is not finite gives zero, and no heap") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EnergyLimit<double> limit({});
  const test::HeapCount heap;
  Pose<double> X;
  CHECK(limit.pass({V(1, 2, 3), V(4, 5, 6)}, X, {}).force == V(1, 2, 3));
  CHECK(limit.pass({V(nan, 0, 0), V::Zero()}, X, {}).force == V::Zero());
  X.translation.x() = nan;
  CHECK(limit.pass({V(1, 0, 0), V::Zero()}, X, {}).force == V::Zero());
  CHECK(limit.stored() == 0);
  CHECK(heap.allocations() == 0);
}
