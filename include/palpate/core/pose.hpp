// SPDX-License-Identifier: MIT
#pragma once

/// @file  Rigid pose of the tool in the elastic object's frame, and the wrench on it.

#include <palpate/core/vector.hpp>

#include <cstring>

namespace palpate {

/// X_OT: maps tool coordinates to object coordinates, x_O = rotation x_T + translation [m].
template <Real S>
struct Pose {
  Mat3<S> rotation = Mat3<S>::Identity();  ///< orthonormal, right-handed
  Vec3<S> translation = Vec3<S>::Zero();   ///< position of the tool's origin [m]

  [[nodiscard]] Vec3<S> operator*(const Vec3<S>& p_T) const noexcept { return rotation * p_T + translation; }
  /// The inverse map, object to tool coordinates.
  [[nodiscard]] Vec3<S> to_tool(const Vec3<S>& p_O) const noexcept {
    return rotation.transpose() * (p_O - translation);
  }
};

/// True when every entry is finite, the translation is below `limit` [m] and the rotation is orthonormal and
/// right-handed to within `tolerance`. A device driver can hand over anything; the servo tick asks this
/// first. The defaults are chosen: squares of 1e6 m are safe in float, and 1e-3 forgives what a
/// driver rounds.
template <Real S>
[[nodiscard]] inline bool is_usable(const Pose<S>& X, S limit = S(1e6), S tolerance = S(1e-3)) noexcept {
  const Vec3<S> x = X.rotation.col(0), y = X.rotation.col(1), z = X.rotation.col(2);
  // Entries below 2 first, so that nothing overflows after that.
  if (!is_within(X.translation, limit) || !is_within(x, S(2)) || !is_within(y, S(2)) || !is_within(z, S(2)))
    return false;
  // Of z the length needs no test: it is x cross y.
  return is_within(Vec3<S>(x.squaredNorm() - S(1), y.squaredNorm() - S(1), x.dot(y)), tolerance) &&
         is_within(Vec3<S>(x.cross(y) - z), tolerance);
}

/// The tool's pose in the object's coordinates; both poses are in world coordinates.
template <Real S>
[[nodiscard]] inline Pose<S> relative(const Pose<S>& tool, const Pose<S>& object) noexcept {
  return {object.rotation.transpose() * tool.rotation, object.to_tool(tool.translation)};
}

/// Bit by bit: also under -ffast-math no NaN is the same as a number, and -0 is not 0.
template <Real S>
[[nodiscard]] inline bool same_bits(const Pose<S>& a, const Pose<S>& b) noexcept {
  static_assert(sizeof(Pose<S>) == 12 * sizeof(S));
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// What the tool feels: force [N] and torque about its centre of mass [N m], in object coordinates.
template <Real S>
struct Wrench {
  Vec3<S> force = Vec3<S>::Zero();
  Vec3<S> torque = Vec3<S>::Zero();
};

/// The same wrench in coordinates that `rotation` turns the present ones into.
template <Real S>
[[nodiscard]] inline Wrench<S> rotated(const Mat3<S>& rotation, const Wrench<S>& wrench) noexcept {
  return {rotation * wrench.force, rotation * wrench.torque};
}

}  // namespace palpate
