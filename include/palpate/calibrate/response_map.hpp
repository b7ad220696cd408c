// SPDX-License-Identifier: MIT
#pragma once

/// @file  A response field's force as the force law of the contact solver: Duffing's coefficients over the whole object,
/// fitted to what the field answers. Set-up only.

#include <palpate/calibrate/duffing_fit.hpp>
#include <palpate/calibrate/response_curve.hpp>
#include <palpate/solver/duffing_map.hpp>
#include <palpate/surface/sampled_surface.hpp>

namespace palpate {

template <Real S>
struct ResponseMapParams {
  S radius;  ///< a [m] > 0: of the patch that the tool presses, sqrt(A/pi) of its contact area
  S depth;   ///< [m] > 0: the law is fitted from 0 to here
  S spacing;  ///< [m] > 0: of the map's nodes; a third to a half of `field.mesh().length`, the solve edge, is apt
};

/// What was fitted, and how well.
template <Real S>
struct ResponseMap {
  DuffingMap<S> map;                ///< for ContactSolver
  double worst_rms = 0;             ///< of all fits: root mean square residual over the curve's own, relative
  Vec3<S> where = Vec3<S>::Zero();  ///< the place of that fit on the surface [m]
};

/// The law F(D) that `field` has for a patch pressed along the normal, at the nodes of a grid over the body, each for the
/// surface's point closest to it. Friction and stick-slip work on top as on any law. Left out: the field's own tangential
/// stiffness (the solver takes the normal law's), pushes off the normal, what several contacts do to each other, and
/// contacts that grow with depth (`ResponseTick::solve` has the sphere's). Reports bad parameters, and a place whose curve
/// Duffing's law does not fit.
template <SampledBody B>
[[nodiscard]] ResponseMap<typename B::Scalar> response_map(
    const ResponseField& field, const B& body, const ResponseMapParams<typename B::Scalar>& params) {
  using S = typename B::Scalar;
  require_positive(params.radius, "response_map", "radius [m] must be > 0");
  require_positive(params.depth, "response_map", "depth [m] must be > 0");
  double worst = 0;
  Vec3<S> where = Vec3<S>::Zero();
  DuffingMap<S> map({.spacing = params.spacing, .lower = body.lower(), .upper = body.upper()},
                    [&](const Vec3<S>& node) {
                      const SurfacePoint<S> at = body.closest(node);
                      const DuffingFit fitted =
                          fit_duffing(response_curve<S>(field, {.place = at.position,
                                                                .normal = at.normal,
                                                                .radius = params.radius,
                                                                .displacement = -params.depth * at.normal}));
                      if (fitted.fit.relative_rms > worst) {
                        worst = fitted.fit.relative_rms;
                        where = at.position;
                      }
                      return typename DuffingForce<S>::Params{static_cast<S>(fitted.params.c1),
                                                              static_cast<S>(fitted.params.c3)};
                    });
  return {std::move(map), worst, where};
}

}  // namespace palpate
