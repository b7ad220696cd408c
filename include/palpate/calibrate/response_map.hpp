// SPDX-License-Identifier: MIT
#pragma once

/// @file A response field's force as the force law of the contact solver: a law's coefficients over the whole
/// object, fitted to what the field answers. Set-up only.

#include <palpate/calibrate/detail/fit_map.hpp>
#include <palpate/calibrate/duffing_fit.hpp>
#include <palpate/calibrate/hertz_fit.hpp>
#include <palpate/calibrate/response_curve.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/map/duffing_map.hpp>
#include <palpate/law/map/hertz_map.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace palpate {

template <Real S>
struct ResponseMapParams {
  S radius;  ///< > 0 [m]: a of the patch that the tool presses, sqrt(A/pi) of its contact area; or the ball's
  S depth;   ///< [m] > 0: the law is fitted from 0 to here
  S spacing;  ///< [m] > 0: of the map's nodes; a third to a half of `field.mesh().length` is apt
  std::size_t points = 20;  ///< of each curve that is fitted, >= 4
  unsigned threads = 1;     ///< the map is the same, bit for bit, with any number
};

/// What was fitted, and how well.
template <ForceMap Map>
struct ResponseMap {
  using S = typename Map::Scalar;
  Map map;                          ///< for ContactSolver
  double worst_rms = 0;             ///< of all fits: root mean square residual over the curve's own, relative
  Vec3<S> where = Vec3<S>::Zero();  ///< the point of that fit on the surface [m]
};

namespace detail {
template <ForceMap Map, SampledBody B, class Fit>
[[nodiscard]] ResponseMap<Map> fit_response(const B& body,
                                            const ResponseMapParams<typename B::Scalar>& params,
                                            const char* where, const Fit& fit) {
  require_positive(params.radius, where, "radius [m] must be > 0");
  require_positive(params.depth, where, "depth [m] must be > 0");
  if (params.points < 4) fail(where, "points must be >= 4", static_cast<double>(params.points));
  FittedMap<Map> made = fit_map<Map>(body, params.spacing, params.threads, fit);
  return {std::move(made.map), made.worst_rms, made.where};
}

/// Hertz's law in series with the body, fitted to what the field answers to a ball up to its depth; to half
/// of it, a quarter ... where that is no such law: a part that is pushed away by more than it is thick, or
/// has too few elements. Where it is none at any depth, Hertz's law of the half-space, and a residual of 1.
template <Real S>
[[nodiscard]] HertzFit fit_ball(const ResponseField& field, SphereContact<S> contact, std::size_t points) {
  constexpr double worst_rms = 1;  // within the fixed region curves have kinks: reported, not refused
  constexpr int halvings = 5;      // chosen: to 3 % of the depth
  for (int i = 0; i <= halvings; ++i, contact.depth /= 2) {
    const std::vector<CurvePoint> curve = response_curve<S>(field, contact, points);
    const auto finite = [](const CurvePoint& p) { return is_finite(p.force); };
    const auto pushes = [](const CurvePoint& p) { return p.force > 0; };
    if (!std::ranges::all_of(curve, finite) || std::ranges::none_of(curve, pushes)) continue;
    HertzFit fit = fit_hertz(curve, {.worst_rms = std::numeric_limits<double>::infinity()});
    if (fit.fit.relative_rms <= worst_rms) return fit;
  }
  const double bend = 1 / double(contact.radius) + double(contact.curvature) / 2;
  const double radius = bend > 0 ? 1 / bend : double(contact.radius);
  const auto half_space = PowerLawForce<double>::hertz_sphere(field.E(), field.nu(), radius);
  HertzFit none{.params = {.k = half_space.params().k}, .fit = {}};
  none.fit.relative_rms = worst_rms;
  return none;
}
}  // namespace detail

/// The law F(D) that `field` has for a patch pressed along the normal, at the nodes of a grid over the body,
/// each for the surface's point closest to it. Friction and stick-slip work on top as on any law. Left out:
/// the field's own tangential stiffness (the solver takes the normal law's), pushes off the normal, and what
/// several contacts do to each other. Reports bad parameters, and a point whose curve Duffing's law does not
/// fit.
template <SampledBody B>
[[nodiscard]] ResponseMap<DuffingMap<typename B::Scalar>> response_map(
    const ResponseField& field, const B& body, const ResponseMapParams<typename B::Scalar>& params) {
  using S = typename B::Scalar;
  return detail::fit_response<DuffingMap<S>>(body, params, "response_map", [&](const SurfacePoint<S>& at) {
    return fit_duffing(response_curve<S>(field,
                                         {.position = at.position,
                                          .normal = at.normal,
                                          .radius = params.radius,
                                          .displacement = -params.depth * at.normal},
                                         params.points));
  });
}

/// The same for a contact that grows with depth: a ball of `params.radius`, or another smooth tool with that
/// radius of curvature, as one point (`SinglePoint`, D its depth). A body without curvature() counts as flat:
/// right while the ball is small beside the body's own radii. Where a part is pushed away by more than it is
/// thick the law is fitted to less than `depth` (`fit_ball`).
template <SampledBody B>
[[nodiscard]] ResponseMap<HertzMap<typename B::Scalar>> ball_response_map(
    const ResponseField& field, const B& body, const ResponseMapParams<typename B::Scalar>& params) {
  using S = typename B::Scalar;
  return detail::fit_response<HertzMap<S>>(body, params, "ball_response_map", [&](const SurfacePoint<S>& at) {
    S curvature = S(0);
    if constexpr (HasCurvature<B>) {
      const Curvature<S> k = body.curvature(at.position);
      curvature = k.k1 + k.k2;
    }
    return detail::fit_ball<S>(field,
                               {.position = at.position,
                                .normal = at.normal,
                                .radius = params.radius,
                                .curvature = curvature,
                                .depth = params.depth},
                               params.points);
  });
}

}  // namespace palpate
