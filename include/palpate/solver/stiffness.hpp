// SPDX-License-Identifier: MIT
#pragma once

/// @file The contact's stiffness as the tool feels it, for implicit integrators and stability checks.

#include <palpate/core/pose.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// K = - d(F, tau)/d(x, theta), 6 x 6: force [N] and torque [N m] about the tool's centre of mass over its
/// translation [m] and rotation [rad] about that centre, all in object coordinates, from the state after the
/// tick at X. Friction is as in the next tick: a contact that sticks resists. Rate terms are left out.
///
/// Central differences, twelve evaluations; the step is the third root of the rounding unit times the depth,
/// so the error is about its square: 1e-10 of K in double, 1e-4 in float, where the law is smooth over a
/// step. A resolved contact is solved to a tolerance, 1e-4 of the depths: its step is 2 % of the depth, the
/// error about 1 %. `scratch` is another state of the same solver; no heap. Zero without contact.
template <class Solver>
[[nodiscard]] Eigen::Matrix<typename Solver::Scalar, 6, 6> stiffness(
    const Solver& solver, const Pose<typename Solver::Scalar>& X, const typename Solver::State& state,
    typename Solver::State& scratch) noexcept {
  using S = typename Solver::Scalar;
  Eigen::Matrix<S, 6, 6> K = Eigen::Matrix<S, 6, 6>::Zero();
  const Vec3<S> centre = X * solver.centre_of_mass();
  S depth = S(0), arm = S(0);
  for (const auto& contact : state.contacts()) {
    if (contact.points == 0) continue;
    depth = (std::max)(depth, contact.displacement.norm());
    arm = (std::max)(arm, (contact.centre - centre).norm());
  }
  if (!(depth > S(0))) return K;
  S share = std::cbrt(std::numeric_limits<S>::epsilon());
  if constexpr (requires { requires Solver::is_resolved; }) share = S(0.02L);
  const S step = share * depth;
  const S angle = step / (std::max)(arm, depth);
  const auto wrench = [&](int axis, S sign) noexcept {
    Pose<S> moved = X;
    if (axis < 3) {
      moved.translation[axis] += sign * step;
    } else {
      const Mat3<S> turn = Eigen::AngleAxis<S>(sign * angle, Vec3<S>::Unit(axis - 3)).toRotationMatrix();
      moved.rotation = turn * X.rotation;
      moved.translation = centre + turn * (X.translation - centre);
    }
    scratch = state;
    return solver.evaluate(moved, S(0), scratch).wrench;
  };
  for (int axis = 0; axis < 6; ++axis) {
    const Wrench<S> ahead = wrench(axis, S(1)), behind = wrench(axis, S(-1));
    const S per = S(-1) / (S(2) * (axis < 3 ? step : angle));
    K.col(axis) << per * (ahead.force - behind.force), per * (ahead.torque - behind.torque);
  }
  return K;
}

}  // namespace palpate
