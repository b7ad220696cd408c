// SPDX-License-Identifier: MIT
#pragma once

/// @file  The turn between two rotations.

#include <palpate/core/vector.hpp>

namespace palpate::detail {

/// Rotation vector from R to Q, its length the sine of the angle: for turns of a few ticks the angle [rad],
/// and monotone to a right angle.
template <Real S>
[[nodiscard]] inline Vec3<S> turned(const Mat3<S>& R, const Mat3<S>& Q) noexcept {
  Vec3<S> sum = Vec3<S>::Zero();
  for (int axis = 0; axis < 3; ++axis) sum += Vec3<S>(R.col(axis)).cross(Vec3<S>(Q.col(axis)));
  return sum / S(2);
}

}  // namespace palpate::detail
