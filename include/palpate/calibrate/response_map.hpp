// SPDX-License-Identifier: MIT
#pragma once

/// @file A response field's force as the force law of the contact solver: a law's coefficients over the whole
/// object, fitted to what the field answers. Set-up only.

#include <palpate/calibrate/detail/fit_map.hpp>
#include <palpate/calibrate/duffing_fit.hpp>
#include <palpate/calibrate/hertz_fit.hpp>
#include <palpate/calibrate/response_curve.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/map/duffing_map.hpp>
#include <palpate/law/map/hertz_map.hpp>

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
/// right while the ball is small beside the body's own radii.
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
    return fit_hertz(response_curve<S>(field,
                                       SphereContact<S>{.position = at.position,
                                                        .normal = at.normal,
                                                        .radius = params.radius,
                                                        .curvature = curvature,
                                                        .depth = params.depth},
                                       params.points),
                     {.worst_rms = 1});  // within the fixed region curves have kinks: reported, not refused
  });
}

}  // namespace palpate
