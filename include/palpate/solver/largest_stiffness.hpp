// SPDX-License-Identifier: MIT
#pragma once

/// @file  How stiff a scene gets up to a force: for a device's limits and for virtual couplings.

#include <palpate/core/error.hpp>
#include <palpate/solver/stiffness.hpp>

#include <algorithm>

namespace palpate {

/// How a tool is pressed to learn a scene's stiffness.
template <Real S>
struct Press {
  Pose<S> from{};                     ///< free, above the place [m]
  Vec3<S> along = -Vec3<S>::UnitZ();  ///< the push, unit
  S travel;                           ///< no further than this [m], > 0
  S max_force;                        ///< nor beyond this force [N], > 0
  int steps = 200;                    ///< > 0; chosen: half a percent of the travel
};

/// The largest tangent stiffness met along a press.
template <Real S>
struct LargestStiffness {
  S translation = S(0);  ///< [N/m]
  S rotation = S(0);     ///< about the tool's centre of mass [N m/rad]
};

/// Over the press: the largest column of -dF/dx and of -dtau/dtheta (stiffness.hpp), which is no less than
/// the largest single entry and no more than sqrt(3) below the largest principal stiffness.
/// Set-up time: 13 evaluations a step.
/// @throws SetupError for a press out of range.
template <class Solver>
[[nodiscard]] LargestStiffness<typename Solver::Scalar> largest_stiffness(
    const Solver& solver, const Press<typename Solver::Scalar>& press) {
  using S = typename Solver::Scalar;
  require_positive(press.travel, "largest_stiffness", "travel [m] must be > 0");
  require_positive(press.max_force, "largest_stiffness", "max_force [N] must be > 0");
  if (press.steps < 1) fail("largest_stiffness", "steps must be > 0", static_cast<double>(press.steps));
  if (!is_usable(press.from) || !is_within(press.along.norm() - S(1), S(1e-3)))
    fail("largest_stiffness", "from must be a pose and along a unit vector");
  typename Solver::State state = solver.initial_state(), scratch = solver.initial_state();
  LargestStiffness<S> most;
  for (int i = 0; i <= press.steps; ++i) {
    Pose<S> X = press.from;
    X.translation += press.travel * (static_cast<S>(i) / static_cast<S>(press.steps)) * press.along;
    const Wrench<S> wrench = solver.evaluate(X, S(0), state).wrench;
    const auto K = stiffness(solver, X, state, scratch);
    for (int axis = 0; axis < 3; ++axis) {
      most.translation = (std::max)(most.translation, K.col(axis).template head<3>().norm());
      most.rotation = (std::max)(most.rotation, K.col(axis + 3).template tail<3>().norm());
    }
    if (wrench.force.norm() >= press.max_force) break;
  }
  return most;
}

}  // namespace palpate
