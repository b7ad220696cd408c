// SPDX-License-Identifier: MIT
#pragma once

/// @file  The hand gets back no more energy than it has put in, whatever the scene, the delay and the hold.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/device/detail/turned.hpp>
#include <palpate/device/detail/vibration_limit.hpp>
#include <palpate/device/device_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace palpate {

/// What contacts store [J] lies between these.
template <Real S>
struct EnergyBounds {
  S least = S(0);
  S most = S(0);
};

/// From the contacts of a tick: 1/4 F_n D_n and F_n D_n + |F_t| |D_t|. A law from linear to cubic stores
/// between a quarter and a half of F_n D_n, a Hertzian one 0.4.
template <Real S>
[[nodiscard]] EnergyBounds<S> stored_energy(std::span<const ContactState<S>> contacts) noexcept {
  EnergyBounds<S> sum;
  for (const ContactState<S>& c : contacts) {
    const S pressed = (std::max)(-c.displacement.dot(c.normal), S(0));
    const S stretched = (c.displacement + pressed * c.normal).norm();
    sum.least += c.normal_force * (std::min)(pressed, (std::max)(c.depth, S(0))) / S(4);
    sum.most += c.normal_force * (std::max)(pressed, c.depth) + c.friction.norm() * stretched;
  }
  return sum;
}

/// Observer and controller of passivity on the wrench that is sent, the last stage of a chain. Time domain
/// passivity control [hannaford2002] with the work of the motors counted exactly, as they hold each wrench
/// for a tick, d ticks late, and with the wrench scaled in place of a damper, which would need a velocity.
///
///     B += W,   W = - F_held . dx - tau_held . dtheta          put in by the hand since the last tick
///        where W < 0, the arm's own losses b |dx|^2/dt + f_c |dx| come first
///     B := min(B, U_most)                                      what friction took is not given back
///     sent = s (F, tau),   s the largest in [0, 1] with
///       s <= (B' + A)/U_least                                  fade with the energy that the contact stores
///       s (F . v + tau . w) T + s^2 (F^2/m + tau^2/I) T^2 <= B'    no tick spends more than there is
///
/// with T the usual dt: ticks may be lost.
///
/// Within a contact s rises by dt/0.02 s at most; a new contact begins at 1.
///
/// B' is B less the work that the wrenches in flight will do, with the free arm's motion predicted, and
/// A = 1/2 (d + 1/2) max(0, -F . dx): going in, what is in flight has not been counted yet.
///
/// So a contact begins at s = 1 and stays there, at any depth, as long as the hold and the delay make less
/// than half of what is stored and not lost in the arm. Then the tool comes out with less force, down to
/// none, and a scene that would buzz softens until it does not; the next touch begins anew. B below 0
/// (predictions err by what a hand accelerates in d + 1 ticks) is paid back first, also by the arm's losses
/// in free air.
///
/// What quantised positions hide from B may keep a stiff contact vibrating; softened() then asks for less
/// until it does not (detail/vibration_limit.hpp). It is the stiffness that has to fall, not the largest
/// force, so the chain scales what the scene demands, before all limits.
///
/// The wrench and its work are about the stylus point in the device's frame: what is really sent, after all
/// other limits. A pose, wrench or energy that is not finite: a zero wrench, and all is forgotten. noexcept,
/// no heap; same inputs, same bits.
template <Real S>
class PassivityController {
 public:
  static constexpr bool active = true;

  /// Reports a value of the model that is out of range.
  explicit PassivityController(const DeviceModel<S>& device) : device_(device), vibration_(device) {
    check(device);
  }

  /// The wrench to send. `stylus`: its pose when the wrench was worked out, device frame; `stored`: of the
  /// contacts, in joules of the hand; `dt` [s]: since the last call, 0 is allowed.
  [[nodiscard]] Wrench<S> pass(const Wrench<S>& wrench, const Pose<S>& stylus, const EnergyBounds<S>& stored,
                               S dt) noexcept {
    const S last = scale_;
    scale_ = S(1);
    if (!is_usable(stylus) || !is_finite(wrench.force) || !is_finite(wrench.torque) ||
        !is_finite(stored.least) || !is_finite(stored.most) || !is_finite(dt) || dt < S(0)) {
      reset();
      return {};
    }
    const Motion moved = advance(stylus, dt), now = velocity();
    const S tick = usual_step();
    book(moved, now, dt, tick);
    budget_ = (std::min)(budget_, stored.most);

    Motion v = now;  // of the free arm, when this wrench comes to act
    S left = budget_;
    for (int age = device_.delay; age > 0; --age) {
      const Wrench<S>& flying = sent(age);
      v.translation += tick / device_.mass * flying.force;
      v.rotation += tick / device_.inertia * flying.torque;
      left -= (std::max)(S(0), work(flying, v) * tick);
    }
    const S going_in = (std::max)(S(0), -work(wrench, now) * tick);
    const S in_flight = going_in * (static_cast<S>(device_.delay) + S(0.5)) / S(2);
    if (stored.least > S(0) && left + in_flight < stored.least)  // not of a debt in free air, 0/0
      scale_ = (std::max)(S(0), left + in_flight) / stored.least;
    scale_ = (std::min)(scale_, spends(wrench, v, (std::max)(S(0), left), tick));
    if (stored.most > S(0)) scale_ = (std::min)(scale_, last + dt / recovery);
    const Wrench<S>& held = sent(device_.delay + 1);
    vibration_.observe(held, work(held, moved), stylus.translation, stored.most > S(0), dt);

    const Wrench<S> out = scale_ < S(1) ? Wrench<S>{scale_ * wrench.force, scale_ * wrench.torque} : wrench;
    send(out);
    return out;
  }

  /// s of the last tick.
  [[nodiscard]] S scale() const noexcept { return scale_; }
  /// Scale of what the scene demands in the next tick, 1 unless the tool vibrates.
  [[nodiscard]] S softened() const noexcept { return vibration_.scale(); }
  /// B [J].
  [[nodiscard]] S budget() const noexcept { return budget_; }
  [[nodiscard]] const DeviceModel<S>& device() const noexcept { return device_; }

  /// Forgets all, as after an error of the device.
  void reset() noexcept {
    budget_ = S(0);
    known_ = 0;
    sent_.fill({});
    vibration_.reset();
  }

 private:
  struct Motion {  // a displacement [m], [rad] or a velocity
    Vec3<S> translation = Vec3<S>::Zero(), rotation = Vec3<S>::Zero();
  };
  static constexpr std::size_t window = 16;  // poses kept: 16 ms at 1 kHz
  static constexpr S max_slope = S(1e9);     // [m/s]: none
  // [s], of s from 0 to 1. A force that comes back at once is a vibration of its own: of 225 simulated taps,
  // presses, slides and throws some ended in 13 encoder steps without it, none in over 0.2 with 0.02 s.
  static constexpr S recovery = S(0.02);

  [[nodiscard]] static S work(const Wrench<S>& w, const Motion& by) noexcept {
    return w.force.dot(by.translation) + w.torque.dot(by.rotation);
  }
  /// What was sent `age` calls ago; 1: in the last one.
  [[nodiscard]] const Wrench<S>& sent(int age) const noexcept {
    return sent_[(newest_ + sent_.size() + 1 - static_cast<std::size_t>(age)) % sent_.size()];
  }

  /// Notes the pose; the motion since the last one.
  Motion advance(const Pose<S>& stylus, S dt) noexcept {
    const Pose<S> last = poses_[pose_];
    pose_ = (pose_ + 1) % window;
    poses_[pose_] = stylus;
    time_[pose_] = dt;
    const Motion moved = known_ > 0 ? between(last, stylus) : Motion{};
    known_ = (std::min)(known_ + 1, window);
    return moved;
  }

  [[nodiscard]] static Motion between(const Pose<S>& from, const Pose<S>& to) noexcept {
    return {to.translation - from.translation, detail::turned(from.rotation, to.rotation)};
  }

  /// Mean of the steps before the last [s]; the last where there are none. So long the next wrenches will be
  /// held: the last step alone may have lost ticks, and the force would drop at each of them.
  [[nodiscard]] S usual_step() const noexcept {
    S sum = S(0);
    for (std::size_t back = 1; back + 1 < known_; ++back) sum += time_[(pose_ + window - back) % window];
    return sum > S(0) ? sum / static_cast<S>(known_ - 2) : time_[pose_];
  }

  /// First-order adaptive windowing [janabi2000]: over the longest window in which a line keeps all positions
  /// within an encoder step. Rotations are taken over the same window.
  [[nodiscard]] Motion velocity() const noexcept {
    using Lanes = Eigen::Array<S, 3, 1>;
    const Lanes band = Lanes::Constant(S(1.01) * device_.resolution);  // 1 % more for rounding
    Lanes least = Lanes::Constant(-max_slope), most = Lanes::Constant(max_slope);
    S time = S(0);
    Motion v;
    for (std::size_t back = 1; back < known_; ++back) {
      time += time_[(pose_ + window + 1 - back) % window];
      if (!(time > S(0))) continue;
      const Pose<S>& then = poses_[(pose_ + window - back) % window];
      const Lanes gone = (poses_[pose_].translation - then.translation).array();
      if ((gone < least * time).any() || (gone > most * time).any()) break;
      const Motion moved = between(then, poses_[pose_]);
      v = {moved.translation / time, moved.rotation / time};
      least = least.max((gone - band) / time);
      most = most.min((gone + band) / time);
    }
    return v;
  }

  void send(const Wrench<S>& wrench) noexcept {
    newest_ = (newest_ + 1) % sent_.size();
    sent_[newest_] = wrench;
  }

  /// What the hand has put in since the last call; `v`: the velocity now, `tick`: the usual step.
  void book(const Motion& moved, const Motion& v, S dt, S tick) noexcept {
    S in = -work(sent(device_.delay + 1), moved);
    // A step that is longer than others has lost ticks, in each of which the newest wrench was sent once
    // more; what did the work is any of those that came to act.
    const S ticks = tick > S(0) ? (std::min)(dt / tick, static_cast<S>(sent_.size())) : S(1);
    for (S last = S(1.5); last <= ticks; last += S(1)) {
      send(sent(1));
      in = (std::min)(in, -work(sent(device_.delay + 1), moved));
    }
    const S lost = device_.damping * v.translation.squaredNorm() * dt +
                   device_.rotational_damping * v.rotation.squaredNorm() * dt +
                   device_.friction * moved.translation.norm();
    const S after = in < S(0) ? in + lost : lost;  // the arm's losses that are left
    budget_ += in < S(0) ? (std::min)(after, S(0)) : in;
    if (budget_ < S(0)) budget_ = (std::min)(S(0), budget_ + (std::max)(after, S(0)));
  }

  /// The largest s with which the wrench, at the velocity v, does no more work in a tick than `left`.
  [[nodiscard]] S spends(const Wrench<S>& wrench, const Motion& v, S left, S tick) const noexcept {
    const S a = (wrench.force.squaredNorm() / device_.mass + wrench.torque.squaredNorm() / device_.inertia) *
                tick * tick;
    const S b = work(wrench, v) * tick;
    if (a + b <= left) return S(1);
    const S root = std::sqrt(b * b + S(4) * a * left);
    return b > S(0) ? S(2) * left / (b + root) : (root - b) / (S(2) * a);
  }

  DeviceModel<S> device_;
  std::array<Wrench<S>, DeviceModel<S>::max_delay + 1> sent_{};  // a ring
  std::size_t newest_ = 0;
  std::array<Pose<S>, window> poses_{};  // a ring, and the time from the pose before [s]
  std::array<S, window> time_{};
  std::size_t pose_ = 0, known_ = 0;
  S budget_ = S(0);  // B
  S scale_ = S(1);
  detail::VibrationLimit<S> vibration_;
};

}  // namespace palpate
