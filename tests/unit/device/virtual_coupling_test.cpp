// SPDX-License-Identifier: MIT

#include <palpate/device/virtual_coupling.hpp>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace palpate;

namespace {

using V = Vec3<double>;

constexpr double K = 400, K_r = 0.5;       // of the coupling
constexpr double wall = 5000, wall_r = 2;  // of the scene [N/m], [N m/rad]

VirtualCoupling<double>::Params params() {
  return {.stiffness = K,
          .rotational_stiffness = K_r,
          .contact_stiffness = wall,
          .contact_rotational_stiffness = wall_r};
}

/// Floor y < 0 with a torsion spring about x at its surface.
struct Floor {
  bool touches = false;
  Wrench<double> wrench{};
  void ask(const Pose<double>& X) {
    const double depth = -X.translation.y();
    touches = depth > 0;
    wrench = {};
    if (!touches) return;
    wrench.force.y() = wall * depth;
    wrench.torque.x() = -wall_r * std::asin(X.rotation(2, 1));
  }
};

Pose<double> at(double y, double angle = 0) {
  Pose<double> X;
  X.translation.y() = y;
  X.rotation = Eigen::AngleAxis<double>(angle, V::UnitX()).toRotationMatrix();
  return X;
}

}  // namespace

TEST_CASE("virtual coupling: in free air the tool is the device's, bit for bit, and the force is 0") {
  VirtualCoupling<double> coupling(params());
  for (int i = 0; i < 100; ++i) {
    const Pose<double> X = at(1e-3 * (i + 1), 0.01 * i);
    CHECK(same_bits(coupling.tool(X), X));
    const Wrench<double> w = coupling.answer(X, {}, false);
    CHECK(w.force == V::Zero());
    CHECK(w.torque == V::Zero());
  }
}

TEST_CASE("virtual coupling: at rest the hand feels both springs in series, force and torque") {
  VirtualCoupling<double> coupling(params());
  Floor floor;
  const Pose<double> X = at(-2e-3, 0.05);
  Wrench<double> w;
  for (int i = 0; i < 40; ++i) {
    floor.ask(coupling.tool(X));
    w = coupling.answer(X, floor.wrench, floor.touches);
  }
  CHECK_RELATIVE(w.force.y(), 2e-3 * K * wall / (K + wall), 1e-12);
  // The spring's torque goes with the sine of its angle.
  const double inside = std::asin(coupling.tool(X).rotation(2, 1));
  CHECK_RELATIVE(w.torque.x(), -K_r * std::sin(0.05 - inside), 1e-9);
  CHECK_RELATIVE(w.torque.x(), -wall_r * inside, 1e-9);
  CHECK_RELATIVE(coupling.energy(), (w.force.squaredNorm() / K + w.torque.squaredNorm() / K_r) / 2, 1e-12);
}

TEST_CASE("virtual coupling: a tick makes no more than the hold of its own spring, 1/2 K dx^2") {
  // E = 1/2 K e^2 + U of spring and wall after each tick; work in: - F_held dx.
  VirtualCoupling<double> coupling(params());
  Floor floor;
  double E = 0, held = 0, y_last = 1e-3;
  for (int i = 0; i < 4000; ++i) {
    const double y = 1e-3 - 2e-3 * std::pow(std::sin(0.01 * i), 2) - 1e-3 * std::sin(0.37 * i);
    const Pose<double> X = at(y);
    const double in = -held * (y - y_last);
    const Pose<double> tool = coupling.tool(X);
    floor.ask(tool);
    held = coupling.answer(X, floor.wrench, floor.touches).force.y();
    const double depth = (std::max)(0.0, -tool.translation.y());
    // The tick in which contact begins takes the tool where it is: its depth is the device's own way.
    const double begins = E == 0 ? wall * depth * depth / 2 : 0;
    const double now = floor.touches ? coupling.energy() + wall * depth * depth / 2 : 0;
    CHECK(now - E <= in + K * (y - y_last) * (y - y_last) / 2 + begins + 1e-15);
    E = now;
    y_last = y;
  }
}

TEST_CASE("virtual coupling: the spring turns about the tool's centre of mass") {
  auto p = params();
  p.centre_of_mass = V(0.03, 0, 0);
  VirtualCoupling<double> coupling(p);
  Pose<double> X;
  (void)coupling.tool(X);
  (void)coupling.answer(X, {}, true);
  // The device turns about the centre of mass: a torque and no force.
  X.rotation = Eigen::AngleAxis<double>(0.1, V::UnitZ()).toRotationMatrix();
  X.translation = V(0.03, 0, 0) - X.rotation * V(0.03, 0, 0);
  const Wrench<double> w = coupling.answer(X, {}, true);
  CHECK_ABSOLUTE(w.force.norm(), 0, 1e-14);
  CHECK_RELATIVE(w.torque.z(), -K_r * std::sin(0.1), 1e-12);
}

TEST_CASE("virtual coupling: bad input gives zero and a new beginning; a million ticks keep the rotation") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  VirtualCoupling<double> coupling(params());
  Pose<double> X = at(-1e-3, 0.3);
  const Wrench<double> push{V(0, 1, 0), V(0.1, 0.2, 0.3)};
  (void)coupling.tool(X);
  (void)coupling.answer(X, push, true);
  CHECK(coupling.answer(X, {V(nan, 0, 0), V::Zero()}, true).force == V::Zero());
  CHECK(same_bits(coupling.tool(X), X));
  Pose<double> bad = X;
  bad.translation.x() = nan;
  (void)coupling.tool(bad);
  CHECK(coupling.answer(bad, push, true).force == V::Zero());
  CHECK(same_bits(coupling.tool(X), X));
  const test::HeapCount heap;
  for (int i = 0; i < 1000000; ++i) {
    (void)coupling.tool(X);
    (void)coupling.answer(X, push, true);
  }
  CHECK(heap.allocations() == 0);
  CHECK(is_usable(coupling.tool(X), 1e6, 1e-14));
}

TEST_CASE("virtual coupling: bad parameters are named") {
  const auto message = [](VirtualCoupling<double>::Params p) -> std::string {
    try {
      VirtualCoupling<double> coupling(p);
    } catch (const SetupError& e) {
      return e.what();
    }
    return "";
  };
  auto p = params();
  p.stiffness = 0;
  CHECK(message(p).find("stiffness [N/m] must be > 0, got 0") != std::string::npos);
  p = params();
  p.rotational_stiffness = -1;
  CHECK(message(p).find("rotational_stiffness") != std::string::npos);
  p = params();
  p.contact_stiffness = -1;
  CHECK(message(p).find("contact_stiffness") != std::string::npos);
  p = params();
  p.contact_rotational_stiffness = -1;
  CHECK(message(p).find("contact_rotational_stiffness") != std::string::npos);
}
