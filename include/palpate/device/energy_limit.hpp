// SPDX-License-Identifier: MIT
#pragma once

/// @file  A contact gives back no more energy than the hand has put into it.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/error.hpp>
#include <palpate/core/pose.hpp>

#include <algorithm>
#include <span>

namespace palpate {

/// Keeps a contact passive whose force is not, such as one that is looked for on a shape that it deforms
/// itself (geometry/deformed_surface.hpp). One line after the solver's tick:
///
///     result.wrench = limit.pass(result.wrench, pose, solver.contacts());
///
///     E += -1/2 (F + F') . dx          put in by the hand; F of this tick, F' of the last; torques likewise
///     F := s F,   s = min(1, E / U),   U = 1/4 sum F_n D_n min(1, A_0 / A)
///
/// | symbol | name                     | unit | range                                                    |
/// |--------|--------------------------|------|----------------------------------------------------------|
/// | A_0    | `Params::contact_area`   | m^2  | the tool's, as ToolPoints has it; not used for one point |
/// |        | `Params::centre_of_mass` | m    | of the tool, in tool coordinates                         |
///
/// U is no more than the energy that evenly pressed contacts store by a force law from linear to cubic. While
/// E is no less, as in passive scenes, the wrench is passed on bit for bit. Where energy was made, the force
/// fades as the tool leaves, without a jump: with depth at most three times as fast as a linear law's, down
/// to 0 with U. Besides, no tick may spend more than E. E never falls below minus half a tick's work, and
/// that is paid back first. So from one moment without contact to any later time
///
///     work on the hand <= 1/2 max |F . dx|
///
/// by the trapezoidal rule; what holding a force for a whole tick adds is the device's ("Stability" in
/// docs/device.md). Energy that friction has taken counts as put in until the contact ends; then the rest is
/// forgotten. A tool that is inside at the start feels nothing until it has been free.
///
/// The observer of [hannaford2002] with the force scaled, instead of a damper, which would need a speed.
/// Poses are the device's, in the object's frame; the wrench is about the tool's centre of mass, as
/// ContactSolver's. A wrench or pose that is not finite: a zero wrench, and E is forgotten. noexcept, without
/// heap.
template <Real S>
class EnergyLimit {
 public:
  struct Params {
    Vec3<S> centre_of_mass = Vec3<S>::Zero();  ///< [m]
    S contact_area{S(0)};                      ///< A_0 [m^2]
  };

  /// Reports what is not finite.
  explicit EnergyLimit(const Params& params) : p_(params) {
    if (!is_finite(params.centre_of_mass)) fail("EnergyLimit", "centre_of_mass must be finite");
    require_non_negative(params.contact_area, "EnergyLimit", "contact_area [m^2] must be >= 0");
  }

  [[nodiscard]] Wrench<S> pass(const Wrench<S>& wrench, const Pose<S>& X,
                               std::span<const ContactState<S>> contacts) noexcept {
    S energy = S(0);
    for (const ContactState<S>& c : contacts) {
      const S share = c.area > p_.contact_area ? p_.contact_area / c.area : S(1);
      energy -= share * c.normal_force * c.displacement.dot(c.normal) / S(4);
    }
    if (!is_usable(X) || !is_finite(wrench.force) || !is_finite(wrench.torque) || !is_finite(energy)) {
      reset();
      return {};
    }
    const Vec3<S> move =
        known_ ? Vec3<S>(X * p_.centre_of_mass - last_ * p_.centre_of_mass) : Vec3<S>(Vec3<S>::Zero());
    const Vec3<S> turn = known_ ? turned(last_.rotation, X.rotation) : Vec3<S>(Vec3<S>::Zero());
    const auto half_work = [&](const Wrench<S>& w) {
      return (w.force.dot(move) + w.torque.dot(turn)) / S(2);
    };
    known_ = true;
    last_ = X;
    stored_ -= half_work(out_);
    scale_ = S(1);
    if (contacts.empty()) {
      stored_ = (std::min)(stored_, S(0));
      out_ = {};
      return wrench;
    }
    const S left = (std::max)(stored_, S(0)), work = half_work(wrench);
    // Going in, the energy of this very step counts as well: a contact begins at s = 1.
    const S after = work < S(0) ? left - work : left;
    if (after < energy) scale_ = after / energy;
    if (scale_ * work > left) scale_ = left / work;
    out_ = scale_ < S(1) ? Wrench<S>{scale_ * wrench.force, scale_ * wrench.torque} : wrench;
    stored_ -= scale_ * work;
    return out_;
  }

  /// s of the last tick.
  [[nodiscard]] S scale() const noexcept { return scale_; }
  /// E [J].
  [[nodiscard]] S stored() const noexcept { return stored_; }

  /// Forgets what was put in, as after an error of the device.
  void reset() noexcept {
    known_ = false;
    stored_ = S(0);
    out_ = {};
  }

 private:
  /// Rotation vector from R to Q, for turns of a tick: sin instead of the angle.
  [[nodiscard]] static Vec3<S> turned(const Mat3<S>& R, const Mat3<S>& Q) noexcept {
    Vec3<S> sum = Vec3<S>::Zero();
    for (int axis = 0; axis < 3; ++axis) sum += Vec3<S>(R.col(axis)).cross(Vec3<S>(Q.col(axis)));
    return sum / S(2);
  }

  Params p_;
  Pose<S> last_{};
  Wrench<S> out_;    // of the last tick
  S stored_ = S(0);  // E
  S scale_ = S(1);
  bool known_ = false;  // is there a last pose?
};

}  // namespace palpate
