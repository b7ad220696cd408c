// SPDX-License-Identifier: MIT
#pragma once

/// @file  k and C of Hertz's law in series with the body, from a curve.

#include <palpate/calibrate/curve_fit.hpp>
#include <palpate/law/force/hertz.hpp>

namespace palpate {

struct HertzFit {
  HertzForce<double>::Params params;  ///< for HertzForce
  CurveFit<2> fit;                    ///< value: depths of contact and body at the largest force [m]
};

/// D = h (F/F_m)^(2/3) + b F/F_m over 0 < F <= F_m, the largest force among the points, with the contact's
/// depth h > 0 and the body's b, < 0 for a layer on something stiff; residuals are of the force. Reports what
/// fit_curve reports, and points without depth > 0.
[[nodiscard]] inline HertzFit fit_hertz(std::span<const CurvePoint> points,
                                        const CurveFitParams& params = {}) {
  double deepest = 0, strongest = 0;
  for (const CurvePoint& p : points) {
    deepest = (std::max)(deepest, p.depth);
    strongest = (std::max)(strongest, p.force);
  }
  if (!(deepest > 0) || !(strongest > 0))
    fail("fit_hertz", "some point must have a depth [m] and a force [N] > 0");
  const auto known = [strongest](const std::array<double, 2>& y) {
    return HertzForce<double>::Params{.k = strongest / (y[0] * std::sqrt(y[0])),
                                      .compliance = y[1] / strongest};
  };
  HertzFit out;
  // A contact of a thousandth of the depth is none.
  out.fit = fit_curve<2>(
      points,
      [&known](const std::array<double, 2>& y, double depth) {
        return HertzForce<double>(known(y)).force(depth);
      },
      {deepest / 2, deepest / 2}, {1e-3 * deepest, -deepest / 2}, {2 * deepest, 2 * deepest}, params);
  out.params = known(out.fit.value);
  return out;
}

}  // namespace palpate
