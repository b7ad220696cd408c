// SPDX-License-Identifier: MIT
#include <palpate/calibrate/duffing_fit.hpp>
#include <palpate/calibrate/response_curve.hpp>

#include "support/check.hpp"
#include "support/response_meshes.hpp"

using namespace palpate;
using V = Vec3<double>;

TEST_CASE(
    "a response field's own curve, and Duffing's law fitted to it: it softens, and starts with the linear "
    "stiffness") {
  const ResponseField field(test::ellipsoid_mesh(V(0.06, 0.04, 0.04), 8),
                            [](const V& p) { return p.y() <= -0.03; },
                            {.E = 1e5, .nu = 0.5, .mesh = {.vertices = 60}, .threads = 1});
  const ResponseContact<double> contact{
      .position = V(0, 0.04, 0), .normal = V::UnitY(), .radius = 0.005, .displacement = V(0, -0.005, 0)};
  const std::vector<CurvePoint> curve = response_curve(field, contact, 30);
  CHECK(curve.size() == 30);
  CHECK(curve.back().depth == 0.005);
  const DuffingFit fit = fit_duffing(curve);
  CHECK(fit.params.c3 < 0);  // F = F1 d - k d^2
  CHECK(fit.fit.relative_rms <
        0.02);  // a quadratic by a cubic: the best fit of s^2 by s and s^3 leaves 2 % of it, and it is a part
  ResponseTick<1> linear(field, {.second_order = false});
  V F;
  linear.solve(&contact, 1, &F);
  CHECK_RELATIVE(fit.params.c1, -F.y() / 0.005, 0.1);  // ditto, at the end of the range
  CHECK_THROWS_AS((void)response_curve(field, ResponseContact<double>{.radius = 0.005}), SetupError);
  CHECK_THROWS_AS(
      (void)response_curve(field, ResponseContact<double>{.radius = -1, .displacement = V(0, 0, 1)}),
      SetupError);
  CHECK_THROWS_AS((void)response_curve(field, contact, 1), SetupError);
  // A frictionless ball: its own ticks, each point weighted by 1/F^2.
  const SphereContact<double> ball{
      .position = V(0, 0.04, 0), .normal = V::UnitY(), .radius = 0.01, .depth = 0.002};
  const std::vector<CurvePoint> pressed = response_curve(field, ball, 4);
  REQUIRE(pressed.size() == 4);
  CHECK(pressed.back().depth == 0.002);
  CHECK(pressed.back().force == ResponseTick<1>(field).solve(ball).force);
  for (const CurvePoint& p : pressed) CHECK_RELATIVE(p.weight * p.force * p.force, 1, 1e-14);
  for (std::size_t i = 1; i < 4; ++i) CHECK(pressed[i].force > pressed[i - 1].force);
  CHECK_THROWS_AS((void)response_curve(field, SphereContact<double>{.radius = 0.01}), SetupError);
  CHECK_THROWS_AS((void)response_curve(field, SphereContact<double>{.depth = 0.001}), SetupError);
}
