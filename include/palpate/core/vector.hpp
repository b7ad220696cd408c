// SPDX-License-Identifier: MIT
#pragma once

/// @file Vectors and matrices of space. Only 3-vectors and 3 x 3 matrices cross the interface: their size and
/// alignment do not depend on the host's vectorisation flags.

#include <palpate/core/scalar.hpp>

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross(), which Eigen/Core declares and does not define

#include <cmath>
#include <limits>

namespace palpate {

template <Real S>
using Vec3 = Eigen::Matrix<S, 3, 1>;
template <Real S>
using Mat3 = Eigen::Matrix<S, 3, 3>;

template <Real S>
[[nodiscard]] inline bool is_finite(const Vec3<S>& v) noexcept {
  return is_finite(v.x()) && is_finite(v.y()) && is_finite(v.z());
}
/// is_within() of every entry.
template <Real S>
[[nodiscard]] inline bool is_within(const Vec3<S>& v, S limit) noexcept {
  return is_within(v.x(), limit) && is_within(v.y(), limit) && is_within(v.z(), limit);
}

/// v without its component along the unit vector n.
template <Real S>
[[nodiscard]] inline Vec3<S> tangential(const Vec3<S>& v, const Vec3<S>& n) noexcept {
  return v - n * n.dot(v);
}

/// A unit vector perpendicular to the unit vector n; continuous in n except across the plane n.z = 0.
/// Source: [duff2017].
template <Real S>
[[nodiscard]] inline Vec3<S> perpendicular(const Vec3<S>& n) noexcept {
  const S sign = n.z() < S(0) ? S(-1) : S(1);
  const S a = S(-1) / (sign + n.z());
  return Vec3<S>(S(1) + sign * n.x() * n.x() * a, sign * n.x() * n.y() * a, -sign * n.x());
}

namespace detail {
/// A square of a length that has neither overflowed nor lost digits to underflow: the usual case.
template <Real S>
[[nodiscard]] inline bool is_usual_square(S square) noexcept {
  return square > (std::numeric_limits<S>::min)() / std::numeric_limits<S>::epsilon() && is_finite(square);
}
}  // namespace detail

/// |v| to 2 epsilon wherever it can be represented; not finite where v is not. The same bits for the same v:
/// Eigen's stableNorm begins with what lies on an aligned address, so that its last digit depends on where v
/// lies.
template <Real S>
[[nodiscard]] inline S stable_norm(const Vec3<S>& v) noexcept {
  const S square = v.squaredNorm();
  if (detail::is_usual_square(square)) return std::sqrt(square);
  const S largest = v.cwiseAbs().maxCoeff();
  if (is_finite(square) && largest == S(0)) return S(0);
  return largest * (v / largest).norm();
}

/// v / |v|, or `otherwise` where |v| is too small to have a direction.
template <Real S>
[[nodiscard]] inline Vec3<S> unit_or(const Vec3<S>& v, const Vec3<S>& otherwise) noexcept {
  const S square = v.squaredNorm();
  if (detail::is_usual_square(square))
    return v * (std::sqrt(square) * (S(1) / square));  // root and division side by side
  const S length = stable_norm(v);
  if (length > (std::numeric_limits<S>::min)()) return v / length;
  return otherwise;
}

}  // namespace palpate
