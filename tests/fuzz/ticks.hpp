// SPDX-License-Identifier: MIT
#pragma once

/// @file A walk of a tool from bytes, and what must hold at every tick of it.

#include "bytes.hpp"

#include <palpate/solver/contact_solver.hpp>

#include <algorithm>

namespace palpate::fuzz {

/// What is known of a scene.
struct Scene {
  double size;                 ///< of the object [m]
  double limit;                ///< no normal force of a region is larger [N]; infinity: not stated
  bool passes_forces = false;  ///< between regions, so that the wrench is more than their sum
};

template <Real S>
void require_same(const TickResult<S>& a, const TickResult<S>& b) {
  require(
      same(a.wrench.force, b.wrench.force) && same(a.wrench.torque, b.wrench.torque) && a.status == b.status,
      "same state and pose, same bits");
}

template <class Solver>
void require_sound(const Solver& solver, const typename Solver::State& state,
                   const Pose<typename Solver::Scalar>& X, bool is_step,
                   const TickResult<typename Solver::Scalar>& result, const Scene& scene) {
  using S = typename Solver::Scalar;
  constexpr bool needs_step = Solver::is_rate_dependent || Solver::has_memory;
  const auto& [force, torque] = result.wrench;
  const Status status = result.status;
  require(is_finite(force) && is_finite(torque), "a wrench is finite");
  require(has(status, Status::invalid_pose) == !is_usable(X), "invalid_pose for poses that are none");
  require(has(status, Status::invalid_step) == (needs_step && !is_step),
          "invalid_step for steps that are none");
  // A rate term after a step of next to no time may leave the range of the scalar: no force then, and said.
  if constexpr (!Solver::is_rate_dependent)
    require(!has(status, Status::non_finite_result), "no law gives what is not finite");
  const bool is_zero = force.isZero(S(0)) && torque.isZero(S(0));
  // A law with memory keeps dents, which are contacts without points and force.
  const auto touching = std::count_if(state.contacts().begin(), state.contacts().end(),
                                      [](const auto& c) { return c.points > 0; });
  if (!has(status, Status::contact)) require(is_zero && touching == 0, "no contact, no force");
  if (has(status, Status::non_finite_result)) require(is_zero, "what is not finite is no force");
  if (has(status, Status::invalid_pose)) require(touching == 0, "a bad pose forgets contact");
  Vec3<S> sum = Vec3<S>::Zero();
  for (const auto& c : state.contacts()) {
    require(is_finite(c.centre) && is_finite(c.normal) && is_finite(c.displacement) && is_finite(c.force) &&
                is_finite(c.friction) && is_finite(c.normal_force) && is_finite(c.area) &&
                is_finite(c.depth) && is_finite(c.dent),
            "a contact is finite");
    require(std::abs(c.normal.norm() - S(1)) < S(1e-3), "a contact's normal is a unit vector");
    if (c.points == 0)
      require(Solver::has_memory && c.force.isZero(S(0)) && c.normal_force == S(0), "a dent has no force");
    // A pose is a rotation to 1e-3 and so is all that is turned with it; the rest is rounding.
    const S most = S(scene.limit) * S(1.001);
    require(c.normal_force >= S(0) && c.normal_force <= most, "a region's normal force is the law's at most");
    const S limit = solver.friction_law().static_limit(c.normal_force);
    require(stable_norm(c.friction) <= S(1.01) * limit + std::numeric_limits<S>::min(),
            "friction is within its limit");
    sum += c.force;
  }
  if (!scene.passes_forces)
    require((sum - force).norm() <= S(1e-5) * (sum.norm() + force.norm()),
            "the contacts' forces are the wrench's");
}

/// Through a body of this size [m]. `before(state, in)`: ahead of each tick; `sound(solver, state, X,
/// is_step, result)`: what must hold after it.
template <class Solver, class Before, class Sound>
void walk(Solver& solver, double size, Bytes& in, const Before& before, const Sound& sound) {
  using S = typename Solver::Scalar;
  using State = typename Solver::State;
  static State state = solver.initial_state(), saved = state, again = state;
  state.reset(), saved.reset();
  Pose<S> X;
  X.translation = S(1.2 * size) * Vec3<S>::UnitY();
  S dt = S(1e-3);
  for (int k = 0; k < 200 && !in.empty(); ++k) {
    const std::uint8_t op = in.byte();
    switch (op % 16) {
      case 0: {  // onto the surface, or into it
        X.translation = in.units<S>() * S(size);
        break;
      }
      case 1:
        X.translation = in.numbers<S>();
        break;
      case 2:
        X.rotation(op / 16 % 3, in.byte() % 3) = in.number<S>();
        break;
      case 3:
        for (int i = 0; i < 9; ++i) X.rotation(i / 3, i % 3) = in.raw<S>();
        for (int i = 0; i < 3; ++i) X.translation[i] = in.raw<S>();
        break;
      case 4:
        dt = in.number<S>();
        break;
      case 5:
        X.rotation = Mat3<S>::Identity();
        dt = S(1e-3);
        break;
      case 6:
        saved = state;
        break;
      case 7:
        state = saved;
        break;
      case 8:
        if (op & 16)
          state.reset();
        else
          state.refresh();
        break;
      case 9: {  // turn
        const Vec3<S> axis = in.units<S>();
        if (axis.norm() > S(0.01))
          X.rotation = Eigen::AngleAxis<S>(in.unit<S>(), axis.normalized()).toRotationMatrix() * X.rotation;
        break;
      }
      default:  // a short step
        X.translation += in.units<S>() * S(size) * (op & 16 ? S(1e-3) : S(0.05));
    }
    before(state, in);
    again = state;
    TickResult<S> first, second;
    {
      const NoHeap none;
      first = solver.evaluate(X, dt, state);
      second = solver.evaluate(X, dt, again);
    }
    require_same(first, second);
    sound(solver, state, X, is_finite(dt) && dt > S(0), first);
    if (op & 128) {  // where the object has a pose: action is reaction
      Pose<S> object;
      object.translation = in.numbers<S>();
      const auto world = solver.evaluate(X, object, dt, again);
      require(is_finite(world.tool.force) && is_finite(world.object.force) && is_finite(world.tool.torque),
              "a wrench in the world is finite");
      require((world.object.force + world.tool.force).isZero(S(0)), "reaction is minus action");
    }
  }
}

template <class Solver>
void walk(Solver& solver, const Scene& scene, Bytes& in) {
  walk(
      solver, scene.size, in, [](const auto&, const Bytes&) {},
      [&scene](const auto&... tick) { require_sound(tick..., scene); });
}

/// The first byte chooses the walk.
template <std::size_t N>
int play(void (*const (&walks)[N])(Bytes&), const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  walks[in.byte() % N](in);
  return 0;
}

}  // namespace palpate::fuzz
