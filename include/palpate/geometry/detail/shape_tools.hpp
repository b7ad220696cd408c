// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the exact surfaces share: set-up checks, the ray of a round body, principal curvatures from a
/// shape operator, and the direction of a parameter pair.

#include <palpate/core/error.hpp>
#include <palpate/geometry/concept.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::detail {

template <Real S>
inline constexpr S four_pi_thirds = static_cast<S>(4 * std::numbers::pi_v<long double> / 3);

/// Sizes from 1e-6 m to 1e6 m: their squares and the ratios below are safe in float.
template <Real S>
inline void require_size(S value, const char* where, const char* rule) {
  if (!is_finite(value) || !(value >= S(1e-6L) && value <= S(1e6L)))
    fail(where, rule, static_cast<double>(value));
}

template <Real S>
inline void require_centre(const Vec3<S>& centre, const char* where) {
  for (int i = 0; i < 3; ++i) {
    if (!is_finite(centre[i]) || !(std::abs(centre[i]) <= S(1e6L)))
      fail(where, "centre [m] must be finite and below 1e6", static_cast<double>(centre[i]));
  }
}

/// The ratio of half sizes is at most `limit` (and a rounding).
template <Real S>
inline void require_ratio(const Vec3<S>& half, S limit, const char* where, const char* rule) {
  const S ratio = half.maxCoeff() / half.minCoeff();
  if (!(ratio <= limit * (S(1) + S(4) * std::numeric_limits<S>::epsilon())))
    fail(where, rule, static_cast<double>(ratio));
}

/// Widens a separation test by more than its rounding, so that it never claims too much.
template <Real S>
inline constexpr S separation_guard = S(1) + S(16) * std::numeric_limits<S>::epsilon();

/// The answer to a query that is not finite: a point of the surface, as if infinitely far outside.
template <Real S>
[[nodiscard]] inline SurfacePoint<S> nowhere(const Vec3<S>& point, const Vec3<S>& normal) noexcept {
  return {point, normal, (std::numeric_limits<S>::max)()};
}

/// u clamped to [0, 1]; 0 when it is not finite.
template <Real S>
[[nodiscard]] inline S unit_interval(S u) noexcept {
  return is_finite(u) && u > S(0) ? (u < S(1) ? u : S(1)) : S(0);
}

/// Direction of longitude 2 pi u about z and colatitude pi v.
template <Real S>
[[nodiscard]] inline Vec3<S> direction(S u, S v) noexcept {
  constexpr S pi = S(3.14159265358979323846264338327950288L);
  const S longitude = S(2) * pi * unit_interval(u), colatitude = pi * unit_interval(v);
  return Vec3<S>(std::sin(colatitude) * std::cos(longitude), std::sin(colatitude) * std::sin(longitude),
                 std::cos(colatitude));
}

/// t_in <= t_out where the line o + t d meets the unit ball; false when it misses. The discriminant comes
/// from the point of the line closest to the centre and the smaller root from the product of the roots, so
/// neither cancels. V is a fixed 2- or 3-vector, d not zero.
template <class V, Real S = typename V::Scalar>
[[nodiscard]] inline bool unit_ball_interval(const V& o, const V& d, S& t_in, S& t_out) noexcept {
  const S dd = d.dot(d), b = o.dot(d);
  const V nearest = o - (b / dd) * d;
  const S discriminant = S(1) - nearest.dot(nearest);
  if (!is_finite(discriminant) || discriminant < S(0)) return false;
  const S root = std::sqrt(discriminant * dd);
  const S length = o.norm();
  const S c = (length - S(1)) * (length + S(1));
  const S q = b < S(0) ? root - b : -(root + b);
  if (q == S(0)) {
    t_in = t_out = S(0);
    return true;
  }
  const S t_far = q / dd, t_near = c / q;
  t_in = t_far < t_near ? t_far : t_near;
  t_out = t_far < t_near ? t_near : t_far;
  return is_finite(t_in) && is_finite(t_out);
}

/// Where the line o + t d is within the cuboid |x_i| <= half_i, and the axes of the faces it crosses.
template <Real S>
struct Slab {
  S t_in = -(std::numeric_limits<S>::max)(), t_out = (std::numeric_limits<S>::max)();
  int axis_in = 0, axis_out = 0;
  bool empty = false;
};
template <Real S>
[[nodiscard]] inline Slab<S> slab_interval(const Vec3<S>& o, const Vec3<S>& d, const Vec3<S>& half) noexcept {
  Slab<S> slab;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(d[i]) < (std::numeric_limits<S>::min)()) {  // parallel to these two faces
      if (std::abs(o[i]) > half[i]) slab.empty = true;
      continue;
    }
    const S side = d[i] < S(0) ? S(-1) : S(1);
    const S enter = (-side * half[i] - o[i]) / d[i], leave = (side * half[i] - o[i]) / d[i];
    if (enter > slab.t_in) slab.t_in = enter, slab.axis_in = i;
    if (leave < slab.t_out) slab.t_out = leave, slab.axis_out = i;
  }
  if (slab.t_in > slab.t_out) slab.empty = true;
  return slab;
}

/// Greatest entry of |d| when the ray can be followed; 0 when it is zero or anything is not finite.
template <Real S>
[[nodiscard]] inline S ray_scale(const Vec3<S>& origin, const Vec3<S>& d) noexcept {
  if (!is_finite(origin) || !is_finite(d)) return S(0);
  const S scale = d.cwiseAbs().maxCoeff();
  return scale >= (std::numeric_limits<S>::min)() ? scale : S(0);
}

template <Real S>
[[nodiscard]] inline RayHit<S> no_hit() noexcept {
  return {false, Vec3<S>::Zero(), S(0)};
}

/// Principal curvatures and directions of the shape operator `W` (symmetric, 1/m) on the plane across the
/// unit normal n. Umbilic: dir1 is perpendicular(n).
template <Real S>
[[nodiscard]] inline Curvature<S> principal(const Vec3<S>& n, const Mat3<S>& W) noexcept {
  const Vec3<S> e1 = perpendicular(n), e2 = n.cross(e1);
  const Vec3<S> We1 = W * e1, We2 = W * e2;
  const S a = e1.dot(We1), b = e1.dot(We2), c = e2.dot(We2);
  const S mean = (a + c) / S(2), delta = (a - c) / S(2), radius = std::hypot(delta, b);
  if (!(radius > S(8) * std::numeric_limits<S>::epsilon() * std::abs(mean))) return {mean, mean, e1, e2};
  // Eigenvector of the larger curvature; the form that does not cancel.
  const S u = delta >= S(0) ? delta + radius : b, v = delta >= S(0) ? b : radius - delta;
  const S length = std::hypot(u, v);
  const Vec3<S> dir1 = (e1 * u + e2 * v) / length;
  return {mean + radius, mean - radius, dir1, n.cross(dir1)};
}

}  // namespace palpate::detail
