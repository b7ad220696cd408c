// SPDX-License-Identifier: MIT
#pragma once

/// @file  From the device's pose to the wrench for its motors: one servo tick with all that stands between a
/// solver and a hand.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/status.hpp>
#include <palpate/device/device_model.hpp>
#include <palpate/device/gate.hpp>
#include <palpate/device/passivity_controller.hpp>
#include <palpate/device/virtual_coupling.hpp>
#include <palpate/device/workspace.hpp>

#include <concepts>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate {

/// No passivity controller behind the limits.
template <Real S>
struct NoPassivityControl {
  static constexpr bool active = false;
  explicit NoPassivityControl(const DeviceModel<S>&) {}
};

/// No limits: what the solver gives goes on, be it as large as it may. For simulated devices only.
template <Real S>
struct NoLimits {
  static constexpr bool active = false;
  struct Params {};
  explicit NoLimits(const Params&) {}
};

/// What the chain asks of a solver: `tick(pose, dt)`, noexcept, gives a value with `.wrench` (about the
/// tool's centre of mass, object coordinates) and `.status`.
template <class Solver, class S>
concept HapticSolver = requires(Solver& solver, const Pose<S>& X, S dt) {
  { solver.tick(X, dt) } noexcept;
  { solver.tick(X, dt).wrench } -> std::convertible_to<Wrench<S>>;
  { solver.tick(X, dt).status } -> std::convertible_to<Status>;
};

namespace detail {
/// The contacts of a tick: in its result, or kept by the solver as ContactSolver does.
template <class Solver, class Result>
concept HasContacts = requires(const Result& result) { result.contacts.begin(); } ||
                      requires(const Solver& solver) { solver.contacts().begin(); };
}  // namespace detail

/// The chain to the motors, one tick:
///
///     pose -> workspace -> coupling -> solver -> coupling -> workspace -> limits -> passivity -> sent
///
/// | role      | parameter    | ships                                     | default               |
/// |-----------|--------------|-------------------------------------------|-----------------------|
/// | coupling  | `Coupling`   | NoVirtualCoupling, VirtualCoupling        | `NoVirtualCoupling`   |
/// | limits    | `Limits`     | Gate, NoLimits                            | `Gate`                |
/// | passivity | `Passivity`  | PassivityController, NoPassivityControl   | `PassivityController` |
///
/// Passivity comes last because it counts the work of what is really sent. An absent part is a type and costs
/// nothing. The solver belongs to the thread that ticks. tick() is noexcept, without heap or lock.
///
/// A jump (Gate) is a change of the force by more than four times what `stiffness` and the motion of the
/// contacts since the last tick explain; four is chosen, for friction that breaks loose and laws that
/// stiffen within a tick.
template <class Solver, class Coupling = NoVirtualCoupling<double>, class Limits = Gate<double>,
          class Passivity = PassivityController<double>>
  requires HapticSolver<Solver, double>
class ServoChain {
 public:
  using S = double;
  using Result =
      std::remove_cvref_t<decltype(std::declval<Solver&>().tick(std::declval<const Pose<S>&>(), S(1e-3)))>;
  static_assert(!Passivity::active || detail::HasContacts<Solver, Result>,
                "ServoChain: a passivity controller needs the contacts, as result.contacts or "
                "solver.contacts()");

  struct Params {
    WorkspaceMapping<S> mapping{};
    DeviceModel<S> device{};
    typename Limits::Params limits{};
    typename Coupling::Params coupling{};
    bool has_torque = false;  ///< the device has motors for torque; else torque is not sent
    S stiffness = S(0);       ///< largest tangent stiffness of the scene [N/m], >= 0; 0: no jump is known
  };

  /// One tick.
  struct Output {
    Wrench<S> wrench{};  ///< to send: device axes, about the stylus point
    Result result{};     ///< the solver's
    Pose<S> tool{};      ///< where the solver was asked: object's frame
    GateStatus gate = GateStatus::ok;
    S passivity = S(1);  ///< scale of the passivity controller
  };

  /// Reports a parameter out of range.
  ServoChain(Solver& solver, const Params& params)
      : solver_(solver),
        params_(params),
        coupling_(params.coupling),
        limits_(params.limits),
        passivity_(params.device) {
    check(params.device);
    require_positive(params.mapping.scale, "ServoChain", "mapping.scale must be > 0");
    require_non_negative(params.stiffness, "ServoChain", "stiffness [N/m] must be >= 0 and finite");
    if (!params.mapping.is_usable())
      fail("ServoChain", "mapping.axes must be a rotation, the rest of it finite");
  }

  /// `stylus`: the device's pose in its own frame [m]; `dt`: since the last tick [s]; `speed`: of the stylus,
  /// as the device has it [m/s].
  Output tick(const Pose<S>& stylus, S dt, S speed = S(0)) noexcept {
    Output out;
    const Pose<S> X = params_.mapping.to_scene(stylus);
    out.tool = X;
    if constexpr (Coupling::active) out.tool = coupling_.tool(X);
    out.result = solver_.tick(out.tool, dt);
    const Status status = out.result.status;
    const bool touches = has(status, Status::contact);

    Wrench<S> wrench = out.result.wrench;
    if constexpr (Coupling::active) wrench = coupling_.answer(X, wrench, touches);
    out.wrench = params_.mapping.to_device(wrench, X);
    if (!params_.has_torque) out.wrench.torque.setZero();
    const S demanded = out.wrench.force.norm() + out.wrench.torque.norm();
    if constexpr (Passivity::active) {
      if (passivity_.softened() < S(1))
        out.wrench = {passivity_.softened() * out.wrench.force, passivity_.softened() * out.wrench.torque};
    }

    if constexpr (Limits::active) {
      if (has(status, Status::invalid_pose) || has(status, Status::non_finite_result)) limits_.disarm();
      out.wrench = limits_.pass(out.wrench, touches, dt, speed, explained(out));
      out.gate = limits_.status();
    }
    if constexpr (Passivity::active) {
      // Forces that the limits have scaled down store as much less, in joules of the hand.
      const S kept = demanded > S(0) ? (out.wrench.force.norm() + out.wrench.torque.norm()) / demanded : S(1);
      out.wrench = passivity_.pass(out.wrench, stylus, stored(out.result, kept / params_.mapping.scale), dt);
      out.passivity = passivity_.scale();
    }
    last_ = out.tool;
    return out;
  }

  /// No force before the limits arm again, and no energy is remembered: after an error of the device.
  void reset() noexcept {
    if constexpr (Coupling::active) coupling_.reset();
    if constexpr (Limits::active) limits_.disarm();
    if constexpr (Passivity::active) passivity_.reset();
    if constexpr (requires {
                    { solver_.reset() } noexcept;
                  })
      solver_.reset();
  }
  /// No force from the next tick until the limits arm again.
  void disarm() noexcept
    requires(Limits::active)
  {
    limits_.disarm();
  }

  [[nodiscard]] const Params& params() const noexcept { return params_; }
  [[nodiscard]] const Coupling& coupling() const noexcept { return coupling_; }
  [[nodiscard]] const Limits& limits() const noexcept { return limits_; }
  [[nodiscard]] const Passivity& passivity() const noexcept { return passivity_; }

 private:
  [[nodiscard]] std::span<const ContactState<S>> contacts(const Result& result) const noexcept {
    if constexpr (requires { result.contacts.begin(); }) {
      return {result.contacts.begin(), result.contacts.size()};
    } else {
      const auto& all = std::as_const(solver_).contacts();
      return {all.begin(), all.size()};
    }
  }

  [[nodiscard]] EnergyBounds<S> stored(const Result& result, S per) const noexcept {
    EnergyBounds<S> sum = stored_energy<S>(contacts(result));
    if constexpr (Coupling::active) {
      sum.least += coupling_.energy() / S(2);
      sum.most += coupling_.energy();
    }
    return {per * sum.least, per * sum.most};
  }

  /// The largest change of the force [N] that the tool's motion since the last tick explains.
  [[nodiscard]] S explained(const Output& out) const noexcept {
    if (!(params_.stiffness > S(0)) || !is_usable(out.tool)) return Limits::max_limit;
    S arm = S(0);
    if constexpr (detail::HasContacts<Solver, Result>) {
      for (const ContactState<S>& c : contacts(out.result))
        if (c.points > 0) arm = (std::max)(arm, (c.centre - out.tool.translation).norm());
    }
    const S moved = (out.tool.translation - last_.translation).norm() +
                    arm * (out.tool.rotation - last_.rotation).norm() +
                    S(2) * params_.mapping.scale * params_.device.resolution;
    return S(4) * params_.stiffness * moved;
  }

  Solver& solver_;
  Params params_;
  PALPATE_NO_UNIQUE_ADDRESS Coupling coupling_;
  PALPATE_NO_UNIQUE_ADDRESS Limits limits_;
  PALPATE_NO_UNIQUE_ADDRESS Passivity passivity_;
  Pose<S> last_{};
};

}  // namespace palpate
