// SPDX-License-Identifier: MIT
// Two fingers hold a block: each a contact resolved at its own points, with the block's pose in between.
#include <palpate/law/friction/coulomb.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/on_block.hpp>
#include <support/paths.hpp>

#include <array>
#include <numbers>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<double>;
constexpr double E = block_E, nu = block_nu, mu = 0.4, R = 8e-3, d = 1e-3, pi = std::numbers::pi;
const V half(0.02, 0.03, 0.02), middle(0, half.y(), 0);

template <class Compliance>
auto solver_of(const Compliance& compliance) {
  return on_block(2 * half, compliance, CoulombFriction<double>({.mu_static = mu, .mu_dynamic = mu}),
                  cap_samples(R, 6e-3, 8e-4));
}

/// Two equal fingers on a block: one solver, a state for each. All that they know of each other is the
/// block's pose.
template <class Solver>
class Grasp {
 public:
  explicit Grasp(const Solver& solver)
      : solver_(solver), states_{solver.initial_state(), solver.initial_state()} {}

  /// On the block, about the middle between the fingers; they are `deep` in it, and it is at `block`.
  Wrench<double> on_block(double deep, const Pose<double>& block) {
    Wrench<double> sum;
    for (std::size_t k = 0; k < 2; ++k) {
      const double side = k == 0 ? -1 : 1;
      Pose<double> finger;
      finger.rotation = rotation_about<double>(V::UnitZ(), -side * pi / 2);
      finger.translation = V(side * (half.x() - deep), half.y(), 0);
      const auto result = solver_.evaluate(finger, block, 1e-3, states_[k]);
      sum.force += result.object.force;
      sum.torque += result.object.torque + (block.translation - middle).cross(result.object.force);
    }
    return sum;
  }
  Wrench<double> squeeze(double deep) {
    Wrench<double> last;
    for (int i = 1; i <= 50; ++i) last = on_block(deep * i / 50, {});
    return last;
  }
  /// N [N], of a finger.
  [[nodiscard]] double normal_force() const {
    return (states_[0].contacts()[0].normal_force + states_[1].contacts()[0].normal_force) / 2;
  }
  [[nodiscard]] bool slides() const {
    return states_[0].contacts()[0].mode == ContactMode::sliding &&
           states_[1].contacts()[0].mode == ContactMode::sliding;
  }

 private:
  const Solver& solver_;
  std::array<typename Solver::State, 2> states_;
};
Pose<double> lowered(double by) {
  Pose<double> X;
  X.translation.y() = -by;
  return X;
}

}  // namespace

TEST_CASE("fingers drag a block up to 2 mu N, and turn it up to 3 pi/8 mu N a, within 3 %") {
  const auto solver = solver_of(HalfSpace({.E = E, .nu = nu}));
  Grasp dragged(solver), turned(solver);
  const double left_over = dragged.squeeze(d).force.norm();
  CHECK(left_over <= 1e-3 * dragged.normal_force());  // the two balls' cells differ
  (void)turned.squeeze(d);
  CHECK_RELATIVE(dragged.normal_force(), 4. / 3 * E / (1 - nu * nu) * std::sqrt(R * d) * d, 0.02);
  double force = 0, torque = 0;
  for (int i = 1; i <= 100; ++i) {
    const double before = force;
    force = dragged.on_block(d, lowered(1e-5 * i)).force.y();
    CHECK(force - before >= -2e-3 * force);  // to the tolerance of two ticks of two fingers
    Pose<double> X;
    X.rotation = rotation_about<double>(V::UnitX(), 8e-3 * i);
    X.translation = middle - X.rotation * middle;
    torque = -turned.on_block(d, X).torque.x();
  }
  CHECK(dragged.slides());
  CHECK(turned.slides());
  CHECK_RELATIVE(force, 2 * mu * dragged.normal_force(), 0.03);  // measured: 0.01 %
  // A sphere's contact radius to second order of its depth [sneddon1965].
  const double a = std::sqrt(R * d * (1 - d / (3 * R)));
  CHECK_RELATIVE(torque, 3 * pi / 8 * mu * turned.normal_force() * a, 0.03);  // measured: 0.6 %
}

TEST_CASE(
    "a block of weight m g is held if 2 mu N is 3 % more, falls if it is 3 % less, and not when squeezed") {
  const auto solver = solver_of(HalfSpace({.E = E, .nu = nu}));
  double sunk = 0;
  // Lowered by what the fingers' friction lacks, over the stiffness of two that stick, the largest there is.
  const auto holds = [&](double weight, double deep) {
    Grasp grasp(solver);
    (void)grasp.squeeze(deep);
    const double stiffness = 2 * 8 * E / (2 * (1 + nu)) / (2 - nu) * std::sqrt(R * deep);
    for (sunk = 0; sunk < 3e-3;) {
      const double missing = weight - grasp.on_block(deep, lowered(sunk)).force.y();
      if (missing <= 1e-3 * weight) return !grasp.slides();
      sunk += missing / stiffness;
    }
    CHECK(grasp.slides());
    return false;
  };
  Grasp grasp(solver);
  (void)grasp.squeeze(d);
  const double most = 2 * mu * grasp.normal_force();
  CHECK(holds(most / 1.03, d));
  CHECK(sunk < 6e-4);  // Mindlin's displacement when all of it slips
  CHECK_FALSE(holds(most / 0.97, d));
  CHECK(holds(most / 0.97, 1.1 * d));
}

TEST_CASE("fingers drag a rubber block, fixed below, up to 2 mu N within 3 %") {
  const auto solver = solver_of(block_compliance(2 * half, 80));
  Grasp grasp(solver);
  (void)grasp.squeeze(d);
  double force = 0;
  for (int i = 1; i <= 100; ++i) force = grasp.on_block(d, lowered(2e-5 * i)).force.y();
  CHECK(grasp.slides());
  CHECK_RELATIVE(force, 2 * mu * grasp.normal_force(), 0.03);  // measured: 0.1 %
}
