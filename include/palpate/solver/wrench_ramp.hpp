// SPDX-License-Identifier: MIT
#pragma once

/// @file Parameters that change while the tool touches: the wrench goes from the old to the new one in a
/// stated time, without a kick.

#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>

#include <algorithm>

namespace palpate {

/// Stands between a solver and the device. After begin() the next pass() keeps what was sent last, and what
/// is kept beyond the solver's wrench fades out linearly:
///
///     W_sent = W + (1 - t/T) (W_last - W_first),   W_first the solver's first wrench after begin()
///
/// | symbol | name           | unit | range |
/// |--------|----------------|------|-------|
/// | T      | `Params::time` | s    | > 0   |
///
/// Without contact nothing is kept: a tool in free air feels nothing. A stiffer law brings energy with it, as
/// a spring exchanged under load does; the ramp spreads it over T. Real time: as a tick.
template <Real S>
class WrenchRamp {
 public:
  struct Params {
    S time{0.1};  ///< chosen: ten periods of the fastest hand motion, 100 Hz
  };

  explicit WrenchRamp(const Params& params) : p_(params) {
    require_positive(p_.time, "WrenchRamp", "time [s] must be > 0");
  }
  WrenchRamp() : WrenchRamp(Params{}) {}

  /// Parameters change now; the next pass() gets the first wrench of the new ones.
  void begin() noexcept { begins_ = true; }

  /// The wrench to send. `dt` [s]: since the last one; if it is not finite or not > 0 the ramp stands still.
  [[nodiscard]] Wrench<S> pass(const Wrench<S>& wrench, bool contact, S dt) noexcept {
    if (!contact) {
      left_ = S(0);
    } else if (begins_) {
      kept_ = {sent_.force - wrench.force, sent_.torque - wrench.torque};
      left_ = S(1);
    } else if (is_finite(dt) && dt > S(0)) {
      left_ = (std::max)(left_ - dt / p_.time, S(0));
    }
    begins_ = false;
    sent_ = wrench;
    if (left_ > S(0)) {
      sent_.force += left_ * kept_.force;
      sent_.torque += left_ * kept_.torque;
    }
    return sent_;
  }

  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  Params p_;
  Wrench<S> sent_{}, kept_{};
  S left_ = S(0);  // 1 - t/T
  bool begins_ = false;
};

}  // namespace palpate
