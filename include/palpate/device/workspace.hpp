// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where a haptic device's workspace lies in the scene, and how forces come back.

#include <palpate/core/pose.hpp>

namespace palpate {

/// From the device's frame to the object's frame, and back for the wrench.
///
///   x_O = s A x_D + o,   R_O = A R_D A^T,   F_D = A^T F_O,   torque_D = A^T (torque_O + R_O c x F_O)
///
/// | symbol | name               | unit | range       |
/// |--------|--------------------|------|-------------|
/// | A      | axes               | 1    | rotation    |
/// | s      | scale              | 1    | > 0         |
/// | o      | offset             | m    | finite      |
/// | c      | centre_of_mass     | m    | finite      |
///
/// At the device's zero orientation the tool stands as it was modelled. A solver's torque is about the tool's
/// centre of mass, a device's about its stylus point, which is the tool's origin: hence c. Force and torque
/// are not scaled, so the hand feels s times the object's stiffness. No equation of the paper: own choice.
template <Real S>
struct WorkspaceMapping {
  Mat3<S> axes = Mat3<S>::Identity();        ///< device axes to object axes
  Vec3<S> offset = Vec3<S>::Zero();          ///< the device's origin in the object's frame [m]
  S scale = S(1);                            ///< metres of the scene per metre of the hand
  Vec3<S> centre_of_mass = Vec3<S>::Zero();  ///< of the tool, in tool coordinates [m]

  /// False for a scale <= 0, axes that are no rotation, or anything not finite.
  [[nodiscard]] bool is_usable() const noexcept {
    return is_finite(scale) && scale > S(0) && palpate::is_usable(Pose<S>{axes, offset}) &&
           is_finite(centre_of_mass);
  }
  /// `device`: pose of the stylus in the device's frame [m].
  [[nodiscard]] Pose<S> to_scene(const Pose<S>& device) const noexcept {
    Pose<S> tool;
    tool.rotation = axes * device.rotation * axes.transpose();
    tool.translation = scale * (axes * device.translation) + offset;
    return tool;
  }
  /// `wrench`: a solver's, for the tool's pose `tool`; the result is in device axes, about the stylus point.
  [[nodiscard]] Wrench<S> to_device(const Wrench<S>& wrench, const Pose<S>& tool) const noexcept {
    const Vec3<S> arm = tool.rotation * centre_of_mass;
    return {axes.transpose() * wrench.force, axes.transpose() * (wrench.torque + arm.cross(wrench.force))};
  }
};

}  // namespace palpate
