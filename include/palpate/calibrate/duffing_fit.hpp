// SPDX-License-Identifier: MIT
#pragma once

/// @file  Duffing's c1 and c3 from a curve, softening allowed where the curve softens.

#include <palpate/calibrate/curve_fit.hpp>
#include <palpate/law/force/duffing.hpp>

namespace palpate {

struct DuffingFit {
  DuffingForce<double>::Params params;  ///< for DuffingForce
  CurveFit<2> fit;           ///< value: slopes at D = 0 and at the largest depth, times that depth [N]
  double c1_half_width = 0;  ///< 95 % confidence [N/m]
  double c3_half_width = 0;  ///< ditto, at least: as if c1 and the end slope were independent [N/m^3]
};

/// F = c1 D + c3 D^3 over 0 < D <= D_m, the largest depth among the points, with neither slope below 0:
///
///     F = y_0 (s - s^3/3) + y_1 s^3/3,   s = D / D_m
///     y_0 = c1 D_m >= 0,   y_1 = (c1 + 3 c3 D_m^2) D_m >= 0
///
/// so the fold of a softening law is never within the curve. Reports what fit_curve reports, and points
/// without depth > 0.
[[nodiscard]] inline DuffingFit fit_duffing(std::span<const CurvePoint> points,
                                            const CurveFitParams& params = {}) {
  double deepest = 0, strongest = 0;
  for (const CurvePoint& p : points) {
    deepest = (std::max)(deepest, p.depth);
    strongest = (std::max)(strongest, p.force);
  }
  if (!(deepest > 0) || !(strongest > 0))
    fail("fit_duffing", "some point must have a depth [m] and a force [N] > 0");
  const auto law = [deepest](const std::array<double, 2>& y, double depth) {
    const double s = (std::max)(depth, 0.0) / deepest, cube = s * s * s / 3;
    return y[0] * (s - cube) + y[1] * cube;
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  DuffingFit out;
  out.fit = fit_curve<2>(points, law, {strongest, strongest}, {0, 0}, {infinity, infinity}, params);
  const double cube = 3 * deepest * deepest * deepest;
  const auto& y = out.fit.value;
  out.params = {.c1 = y[0] / deepest, .c3 = (y[1] - y[0]) / cube};
  out.c1_half_width = out.fit.half_width[0] / deepest;
  out.c3_half_width = std::hypot(out.fit.half_width[0], out.fit.half_width[1]) / cube;
  return out;
}

}  // namespace palpate
