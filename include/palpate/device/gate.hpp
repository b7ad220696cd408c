// SPDX-License-Identifier: MIT
#pragma once

/// @file  Limits before the motors. Whatever the solver, the scene or the scheduler does, what leaves here is
/// finite, bounded, and zero when something is wrong.

#include <palpate/config.hpp>
#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace palpate {

/// What the gate did in this tick. `armed` and `ramping` are states, the others say which limit acted.
enum class GateStatus : std::uint32_t {
  ok = 0,
  armed = 1u << 0,             ///< force may pass
  ramping = 1u << 1,           ///< armed, and still below full gain
  in_contact = 1u << 2,        ///< not armed because the tool touches: pull it free first
  force_saturated = 1u << 3,   ///< wrench scaled down for its force, directions kept
  torque_saturated = 1u << 4,  ///< wrench scaled down for its torque, directions kept
  jump = 1u << 5,              ///< tripped: the demand changed by more than the tool's motion explains
  heat_limited = 1u << 6,      ///< the long-term budget has lowered the force limit
  non_finite = 1u << 7,        ///< tripped: NaN, infinity or more than 1e9 in the wrench
  invalid_step = 1u << 8,      ///< tripped: dt is not finite, or negative
  gap = 1u << 9,               ///< tripped: dt > max_gap
  over_speed = 1u << 10,       ///< tripped: speed > max_speed, or not finite
  disarmed = 1u << 11,         ///< tripped by disarm()
};
[[nodiscard]] constexpr GateStatus operator|(GateStatus a, GateStatus b) noexcept {
  return static_cast<GateStatus>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr GateStatus& operator|=(GateStatus& a, GateStatus b) noexcept { return a = a | b; }
/// True when `all` has every bit of `asked`.
[[nodiscard]] constexpr bool has(GateStatus all, GateStatus asked) noexcept {
  return (static_cast<std::uint32_t>(all) & static_cast<std::uint32_t>(asked)) ==
         static_cast<std::uint32_t>(asked);
}

/// Limits, arming and watchdog between a solver and a haptic device. No equation of the paper: own choice,
/// after the practice of device libraries.
///
/// A *trip* (bad number, jump, gap, over-speed, disarm()) gives zero at once and disarms. Armed again after
/// `arm_after` seconds without a trip and without contact, so that no force starts inside an object; then the
/// gain rises linearly from 0 to 1 over `ramp_time`. Armed, the output is
///
///   (f, tau) gain min(1, L/|gain f|, max_torque/|gain tau|)
///
/// with L the force limit: `max_force`, lowered toward `continuous_force` Fc by a heat estimate q' = (|f|^2
/// - q)/heat_time of what left: L = max_force for q <= Fc^2/2, falling linearly to Fc at q = Fc^2. A demand
/// above Fc that lasts ends at Fc. Force and torque are scaled together: the tool is pushed along the same
/// screw. The output is continuous in the input except for a trip's drop to zero;
/// |force| <= max_force always.
///
/// A jump is a change of the demanded force from one call to the next by more than `explained`, which the
/// caller works out from stiffness and motion (ServoChain does): a scene that was changed under the tool. A
/// limit of the rate in its place would act in normal touch, and energy comes from what is held back.
///
/// What it does not do: it cannot make a scene passive (PassivityController does). Time and memory: no heap,
/// no lock, no loop. One gate belongs to one thread.
template <Real S>
class Gate {
 public:
  static constexpr bool active = true;
  static constexpr S max_limit = S(1e9);  ///< squares and quotients of these are safe in float

  /// Limits are in [1e-6, 1e9], waits >= 0. Infinity switches off `max_speed` and `continuous_force`; nothing
  /// else.
  struct Params {
    S max_force = S(3);  ///< [N]. 0.9 of the 3.3 N peak of the weakest common device
    S continuous_force = std::numeric_limits<S>::infinity();  ///< [N]: what the motors bear for ever
    S heat_time = S(10);     ///< time constant of the heat estimate [s]; of the order of small motors'
    S max_torque = S(0.17);  ///< [N m]. 0.9 of the 0.188 N m of a common 6-DOF device
    S arm_after = S(0.5);    ///< time free of contact before force [s], >= 0: a human can let go in it
    S ramp_time = S(0.5);    ///< [s], >= 0; chosen
    S max_gap = S(5e-3);     ///< longest step [s]: five periods at 1 kHz; the hand moves 5 mm at 1 m/s
    S max_speed = S(1.5);    ///< of the device's tip [m/s]: faster is a fault or an arm let go
  };

  Gate() : Gate(Params{}) {}
  /// Reports a parameter out of the range above.
  explicit Gate(const Params& params) : params_(params) {
    const auto check = [](S value, const char* rule) {
      if (!in_range(value)) fail("Gate", rule, static_cast<double>(value));
    };
    check(params.max_force, "max_force [N] must be in [1e-6, 1e9]");
    check(params.max_torque, "max_torque [N m] must be in [1e-6, 1e9]");
    check(params.heat_time, "heat_time [s] must be in [1e-6, 1e9]");
    check(params.max_gap, "max_gap [s] must be in [1e-6, 1e9]");
    require_non_negative(params.arm_after, "Gate", "arm_after [s] must be finite and >= 0");
    require_non_negative(params.ramp_time, "Gate", "ramp_time [s] must be finite and >= 0");
    // Infinity becomes the largest limit, which never acts: infinities are not safe under -ffast-math.
    const auto limit = [&](S value, const char* rule) {
      if (!is_infinity(value)) check(value, rule);
      return is_infinity(value) ? max_limit : value;
    };
    max_speed_ = limit(params.max_speed, "max_speed [m/s] must be in [1e-6, 1e9] or infinity");
    // A budget above the peak never acts.
    continuous_ =
        (std::min)(limit(params.continuous_force, "continuous_force [N] must be in [1e-6, 1e9] or infinity"),
                   params.max_force);
  }

  /// What may go to the motors for the demand `wrench`. `contact`: the solver's, true when anything touches.
  /// `dt`: time since the last call [s], 0 is allowed. `speed`: of the tip [m/s]. `explained`: how much the
  /// force may have changed since the last call [N].
  [[nodiscard]] Wrench<S> pass(const Wrench<S>& wrench, bool contact, S dt, S speed = S(0),
                               S explained = max_limit) noexcept {
    status_ = GateStatus::ok;
    if (!is_finite(dt) || dt < S(0)) {
      trip(GateStatus::invalid_step);
    } else {
      const S load = last_force_ / continuous_;
      heat_ += (load * load - heat_) * (std::min)(S(1), dt / params_.heat_time);
      if (dt > params_.max_gap) trip(GateStatus::gap);
    }
    if (!is_finite(speed) || speed > max_speed_) trip(GateStatus::over_speed);
    if (!is_sane(wrench.force) || !is_sane(wrench.torque))
      trip(GateStatus::non_finite);
    else if (armed_ && !((wrench.force - demand_).norm() <= explained))
      trip(GateStatus::jump);
    demand_ = is_sane(wrench.force) ? wrench.force : Vec3<S>(Vec3<S>::Zero());
    if (disarm_) trip(GateStatus::disarmed);
    disarm_ = false;
    if (status_ != GateStatus::ok) return Wrench<S>{};

    if (!armed_) {
      if (contact) {
        free_ = S(0);
        status_ |= GateStatus::in_contact;
        return Wrench<S>{};
      }
      free_ += dt;
      if (free_ < params_.arm_after) return Wrench<S>{};
      armed_ = true;
    }
    status_ |= GateStatus::armed;
    const S gain = params_.ramp_time > S(0) ? gain_ : S(1);
    if (gain < S(1)) {
      status_ |= GateStatus::ramping;
      gain_ = (std::min)(S(1), gain_ + dt / params_.ramp_time);
    }

    const S limit = force_limit();
    if (limit < params_.max_force) status_ |= GateStatus::heat_limited;
    const Wrench<S> raised{gain * wrench.force, gain * wrench.torque};
    const S by_force = factor(raised.force, limit), by_torque = factor(raised.torque, params_.max_torque);
    if (by_force < S(1)) status_ |= GateStatus::force_saturated;
    if (by_torque < S(1)) status_ |= GateStatus::torque_saturated;
    const S both = (std::min)(by_force, by_torque);
    const Wrench<S> out{both * raised.force, both * raised.torque};
    last_force_ = out.force.norm();
    return out;
  }

  /// Zero and disarmed from the next pass() on: for the host's reasons, such as an error of the device.
  void disarm() noexcept { disarm_ = true; }

  [[nodiscard]] bool armed() const noexcept { return armed_; }
  /// Of the last pass().
  [[nodiscard]] GateStatus status() const noexcept { return status_; }
  [[nodiscard]] const Params& params() const noexcept { return params_; }

 private:
  using Bits = std::conditional_t<sizeof(S) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
  static constexpr S min_limit = S(1e-6);  // quotients by it are safe in float

  [[nodiscard]] static bool in_range(S x) noexcept {
    return is_finite(x) && x >= min_limit && x <= max_limit;
  }
  [[nodiscard]] static bool is_infinity(S x) noexcept {
    return std::bit_cast<Bits>(x) == std::bit_cast<Bits>(std::numeric_limits<S>::infinity());
  }
  [[nodiscard]] static bool is_sane(const Vec3<S>& v) noexcept {
    return is_finite(v) && v.cwiseAbs().maxCoeff() <= max_limit;
  }

  void trip(GateStatus why) noexcept {
    status_ |= why;
    armed_ = false;
    free_ = gain_ = S(0);
    last_force_ = S(0);
  }

  [[nodiscard]] S force_limit() const noexcept {
    const S used = S(2) * heat_ - S(1);  // 0 at half the budget, 1 at all of it
    if (!(used > S(0))) return params_.max_force;
    return params_.max_force + (std::min)(used, S(1)) * (continuous_ - params_.max_force);
  }

  /// What brings v to |v| <= limit.
  [[nodiscard]] static S factor(const Vec3<S>& v, S limit) noexcept {
    const S norm = v.norm();
    if (norm <= limit) return S(1);
    return limit / norm * (S(1) - S(4) * std::numeric_limits<S>::epsilon());  // rounding stays inside
  }

  Params params_;
  S max_speed_ = S(0), continuous_ = S(0);
  Vec3<S> demand_ = Vec3<S>::Zero();  // the last one's force
  S last_force_ = S(0);               // |force| that left last
  S free_ = S(0);                     // time without contact and trip [s]
  S gain_ = S(0);
  S heat_ = S(0);  // mean square force / continuous_^2
  bool armed_ = false;
  bool disarm_ = false;
  GateStatus status_ = GateStatus::ok;
};

}  // namespace palpate
