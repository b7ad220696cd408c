// SPDX-License-Identifier: MIT
#pragma once

/// @file How many points a contact needs, and by how much too few of them spoil its force.

#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/contact_points.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace palpate {

namespace detail {
/// Error of the force, largest at many positions, where n points carry load and `across` would on a disc as
/// wide as the contact is narrow. Found on balls and elliptic contacts 2:1 to 10:1, half-space, closed forms.
[[nodiscard]] inline double error_of_points(double n, double across) noexcept {
  return 2 / (across * std::sqrt(n));
}
}  // namespace detail

/// Estimate of the force's error by the number of points, over the force; 0 without points. From above: 1 to
/// 3 times the largest error found at any position, 5 times the mean. Of a single contact: several that touch
/// at once are each as coarse as by themselves.
///
///     e = 2/(n_w sqrt(n)),   n_w = 5 pi (l/A + 1/12) <= n + 1,   l: least variance of positions by load
///
/// A: mean area of a cell; n_w: points on a disc as wide as the contact is narrow. Range: 5 points and more;
/// with fewer the force is off by 20 to 100 %. Second order in depth and the body's own error are not in it.
template <Real S>
[[nodiscard]] inline S resolution_error(std::span<const PointContact<S>> points) noexcept {
  S load = S(0), area = S(0);
  Vec3<S> middle = Vec3<S>::Zero(), normal = Vec3<S>::Zero();
  for (const PointContact<S>& p : points) {
    const S f = p.force.dot(p.normal);
    load += f, area += f / p.pressure;
    middle += f * p.position, normal += f * p.normal;
  }
  if (!(load > S(0)) || !(area > S(0))) return S(0);
  const auto n = static_cast<S>(points.size());
  middle /= load, normal.normalize(), area /= n;
  const Vec3<S> x = perpendicular<S>(normal), y = normal.cross(x);
  S xx = S(0), xy = S(0), yy = S(0);
  for (const PointContact<S>& p : points) {
    const S f = p.force.dot(p.normal) / load;
    const Vec3<S> r = p.position - middle;
    xx += f * r.dot(x) * r.dot(x), xy += f * r.dot(x) * r.dot(y), yy += f * r.dot(y) * r.dot(y);
  }
  const S least = (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy);
  const S across = 5 * std::numbers::pi_v<S> * (least / area + S(1) / 12);
  return static_cast<S>(detail::error_of_points(n, (std::min)(across, n + 1)));
}

/// The spacing of `contact_samples` with which a round contact of `area` [m^2] has an error of at most
/// `error`, as above: 34 points for 1 %. Reports an area or error that is not positive.
[[nodiscard]] inline double spacing_for(double area, double error) {
  require_positive(area, "spacing_for", "area [m^2] must be > 0");
  require_positive(error, "spacing_for", "error must be > 0");
  return std::sqrt(area / std::pow(2 / error, 2. / 3));
}

}  // namespace palpate
