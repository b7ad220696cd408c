// SPDX-License-Identifier: MIT
#pragma once

/// @file How fast the tool goes in: the rate that rate-dependent force laws are given.

#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace palpate {

/// The window over which the tool's rate is taken. The defaults are chosen: 10 um is the step of a good
/// desktop device, 20 ms is shorter than any motion of a hand.
template <Real S>
struct RateWindow {
  S resolution = S(1e-5);  ///< what a position of the tool is good to [m], >= 0: one step of the encoders
  S longest = S(0.02);     ///< [s] > 0
};

namespace detail {

template <Real S>
void check(const RateWindow<S>& window) {
  require_non_negative(window.resolution, "RateWindow", "resolution [m] must be >= 0 and finite");
  require_positive(window.longest, "RateWindow", "longest [s] must be > 0 and finite");
}

/// The tool's last poses, and from them the rate of any point of it: first-order adaptive windowing
/// [janabi2000]. The line through the newest position and the oldest that keeps all between within the
/// resolution: long where the tool moves evenly, short where it does not. The difference of two ticks would
/// double at every other tick where poses come at half the servo's rate.
///
/// A pose with the bits of the last one is none: the device, or the scene that moves the tool, has no new
/// one. The rate holds while the next may still come (twice the longest interval of the window), then falls
/// as if the tool had just not made its next step, and is 0 after `longest` (or four such intervals).
template <Real S>
class PoseHistory {
 public:
  static constexpr std::size_t capacity = 16;  // 16 ms at 1 kHz

  void clear() noexcept { count_ = 0; }

  /// The pose of a tick, dt [s] after the last one; dt <= 0: nobody knows how long, so it begins anew.
  void push(const Pose<S>& X, S dt) noexcept {
    if (!(dt > S(0))) count_ = 0;
    if (count_ > 0) {
      waiting_ += dt;
      if (same_bits(X, poses_[newest_])) return;
    }
    newest_ = (newest_ + 1) % capacity;
    poses_[newest_] = X;
    interval_[newest_] = waiting_;
    waiting_ = S(0);
    count_ = (std::min)(count_ + 1, capacity);
  }

  /// True when no rate is left: the tool rests.
  [[nodiscard]] bool at_rest(const RateWindow<S>& window) const noexcept {
    return waiting_ > (std::max)(window.longest, S(4) * longest_interval());
  }

  /// How fast [m/s] the tool's point `point_T` (tool coordinates) goes against the unit normal.
  [[nodiscard]] S rate(const Vec3<S>& point_T, const Vec3<S>& normal,
                       const RateWindow<S>& window) const noexcept {
    const auto height = [&](std::size_t i) { return normal.dot(pose(i) * point_T); };
    const S now = count_ > 0 ? height(0) : S(0);
    // Three positions, each off by half a step, are off a line by one; 1 % more for rounding.
    const S band = S(1.01) * window.resolution;
    S age = S(0), rate = S(0), interval = S(0);
    // Lines through the newest position that keep all seen so far within the resolution.
    S least = -std::numeric_limits<S>::infinity(), most = std::numeric_limits<S>::infinity();
    for (std::size_t i = 1; i < count_; ++i) {
      const S before = interval_[(newest_ + capacity - (i - 1)) % capacity];
      age += before;
      const S gone_in = height(i) - now;
      if (i > 1 && (age > window.longest || gone_in < least * age || gone_in > most * age)) break;
      rate = gone_in / age;
      interval = (std::max)(interval, before);
      least = (std::max)(least, (gone_in - band) / age);
      most = (std::min)(most, (gone_in + band) / age);
    }
    if (!(waiting_ > S(2) * interval)) return rate;
    const S end = (std::max)(window.longest, S(4) * interval);
    const S left = (std::max)(S(0), (end - waiting_) / (end - S(2) * interval));
    return rate * left * (interval / (waiting_ - interval));
  }

 private:
  /// The i-th before the newest.
  [[nodiscard]] const Pose<S>& pose(std::size_t i) const noexcept {
    return poses_[(newest_ + capacity - i) % capacity];
  }
  [[nodiscard]] S longest_interval() const noexcept {
    S longest = S(0);
    for (std::size_t i = 0; i + 1 < count_; ++i)
      longest = (std::max)(longest, interval_[(newest_ + capacity - i) % capacity]);
    return longest;
  }

  std::array<Pose<S>, capacity> poses_;
  std::array<S, capacity> interval_{};  // since the pose before [s]
  std::size_t newest_ = 0, count_ = 0;
  S waiting_ = S(0);  // since the newest pose [s]
};

}  // namespace detail

}  // namespace palpate
