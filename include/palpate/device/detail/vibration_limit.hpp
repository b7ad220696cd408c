// SPDX-License-Identifier: MIT
#pragma once

/// @file  A contact that vibrates at the device becomes softer until it does not.

#include <palpate/core/pose.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/device/device_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::detail {

/// Scale of the wrench, 1 until the tool vibrates: positions that are read half an encoder step wrong hide
/// work, which can feed a limit cycle where the stiffness is above a part of 2 f_c/Delta [abbott2005], f_c
/// the arm's friction and Delta the encoder step. A swing is the travel between two turning points along the
/// wrench that acted, torque counted at the radius of gyration. One counts if it is above the dither of the
/// encoders, takes less than 80 ms, ends near where the one before it began, and if the wrench changed by
/// more than 0.4 f_c/Delta times the travel. From the fourth in a row on, each that is not smaller than the
/// one before last takes a fifth of the scale, in 4 ms. A contact begins at 1 again after 0.2 s in free
/// air.
///
/// noexcept, no heap; all inputs finite.
template <Real S>
class VibrationLimit {
 public:
  explicit VibrationLimit(const DeviceModel<S>& device) noexcept
      : smallest_(dither * device.resolution),
        per_torque2_(device.mass / device.inertia),
        friction_(stiff * device.friction),
        resolution_(device.resolution) {}

  /// `acted`: the wrench that acted since the last call; `work` [J]: what it did; `at` [m]: the stylus now.
  void observe(const Wrench<S>& acted, S work, const Vec3<S>& at, bool touches, S dt) noexcept {
    time_ += dt;
    scale_ = (std::max)(target_, scale_ - dt / ramp);
    free_ = touches ? S(0) : free_ + dt;
    if (free_ > forgotten_after) reset();
    const S size2 = squared(acted);
    if (touches && size2 > S(0)) travel_ += side_ * work / std::sqrt(size2);
    if (travel_ > farthest_.travel) {
      farthest_ = {travel_, time_, acted};
    } else if (farthest_.travel - travel_ > smallest_) {
      turn(at);
    }
  }
  [[nodiscard]] S scale() const noexcept { return scale_; }

  void reset() noexcept {
    travel_ = time_ = free_ = S(0);
    farthest_ = {};
    swings_ = {};
    in_a_row_ = 0;
    side_ = scale_ = target_ = S(1);
  }

 private:
  // Of 225 rows of simulated presses and slides (three arms, rates, delays, ticks lost and late, 1,000 to
  // 10,000 N/m) 24 ended vibrating with these values, 50 without (docs/stability.md).
  static constexpr S dither = S(1.9);    // encoder steps: three axes dither by less than sqrt(3)
  static constexpr S slowest = S(0.08);  // [s]: a hand moves on purpose at up to 6 Hz
  static constexpr S stiff = S(0.4);     // of f_c/Delta; a hand's tremor in a softer scene is left alone
  static constexpr S stays = S(2);       // of a swing: farther is a slide over something uneven
  static constexpr S lasting = S(0.9);   // of the swing before last
  static constexpr S softer = S(0.8);    // reached the end of a cycle sooner than 0.9, felt more than 0.7
  static constexpr S forgotten_after = S(0.2);  // [s]: a tool that bounces is back before
  static constexpr S ramp = S(0.02);            // [s], from 1 to 0: a step of the force would be a jump
  static constexpr int transient = 3;           // swings

  struct Farthest {
    S travel = S(0), time = S(0);
    Wrench<S> wrench{};
  };
  struct Swing {
    S travel = S(0);
    Vec3<S> at = Vec3<S>::Zero();
    Wrench<S> wrench{};
  };

  [[nodiscard]] S squared(const Wrench<S>& w) const noexcept {
    return w.force.squaredNorm() + per_torque2_ * w.torque.squaredNorm();
  }
  /// The tool has come back from the farthest point; from there the next swing is counted.
  void turn(const Vec3<S>& at) noexcept {
    const Swing last = swings_[0], before = swings_[1];
    const S travel = farthest_.travel,
            change2 = squared(
                {farthest_.wrench.force - last.wrench.force, farthest_.wrench.torque - last.wrench.torque}),
            least = friction_ * travel;
    const bool counts = farthest_.time < slowest && (at - before.at).norm() < stays * travel &&
                        change2 * resolution_ * resolution_ > least * least;
    in_a_row_ = counts ? in_a_row_ + 1 : 0;
    if (in_a_row_ > transient && travel > lasting * before.travel) target_ *= softer;
    swings_ = {Swing{travel, at, farthest_.wrench}, last};
    travel_ = farthest_.travel - travel_;
    time_ -= farthest_.time;
    farthest_ = {travel_, time_, farthest_.wrench};
    side_ = -side_;
  }

  S smallest_, per_torque2_, friction_, resolution_;
  std::array<Swing, 2> swings_{};  // newest first
  Farthest farthest_;
  S travel_ = S(0), time_ = S(0);  // since the last turning point [m], [s]
  S free_ = S(0);                  // in free air [s]
  S side_ = S(1), scale_ = S(1), target_ = S(1);
  int in_a_row_ = 0;
};

}  // namespace palpate::detail
