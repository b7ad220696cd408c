// SPDX-License-Identifier: MIT

#include "support/check.hpp"
#include "support/ray_checks.hpp"

#include <palpate/geometry/cylinder.hpp>

#include <cmath>
#include <limits>
#include <string>

using namespace palpate;

TEST_CASE_TEMPLATE("cylinder: side, cap and rim regions outside", S, float, double) {
  const Cylinder<S> body({.radius = S(2), .half_height = S(1)});
  CHECK(body.closest(Vec3<S>(0, S(0.5), -5)).position == Vec3<S>(0, S(0.5), -2));
  CHECK(body.closest(Vec3<S>(1, 4, 1)).position == Vec3<S>(1, 1, 1));
  const SurfacePoint<S> rim = body.closest(Vec3<S>(5, -5, 0));
  CHECK(rim.position == Vec3<S>(2, -1, 0));
  CHECK_ABSOLUTE(rim.distance, 5.0L, test::ulps<S>(8) * 5);
  CHECK_ABSOLUTE(rim.normal.x(), 0.6L, test::ulps<S>(4));
}

TEST_CASE_TEMPLATE("cylinder: ties on the axis and at the centre", S, float, double) {
  const Cylinder<S> tall({.radius = S(1), .half_height = S(3)}), flat({.radius = S(3), .half_height = S(1)});
  CHECK(tall.closest(Vec3<S>::Zero()).position == Vec3<S>(1, 0, 0));
  CHECK(flat.closest(Vec3<S>::Zero()).position == Vec3<S>(0, 1, 0));
  CHECK(Cylinder<S>({.radius = S(1), .half_height = S(1)}).closest(Vec3<S>::Zero()).position ==
        Vec3<S>(1, 0, 0));
}

TEST_CASE_TEMPLATE("cylinder: depth is exact to half the radius and smooth on the axis", S, float, double) {
  const Cylinder<S> body({.radius = S(1), .half_height = S(10)});
  const Penetration<S> shallow = body.penetration(Vec3<S>(0, 0, S(-0.75)));
  CHECK(shallow.depth == S(0.25));
  CHECK(shallow.gradient == Vec3<S>(0, 0, -1));
  const Penetration<S> half = body.penetration(Vec3<S>(S(0.5), 0, 0));
  CHECK(half.depth == S(0.5));
  CHECK_ABSOLUTE(half.gradient.x(), 1.0L, test::ulps<S>(4));
  CHECK(body.penetration(Vec3<S>::Zero()).depth == S(0.75));
  CHECK(body.penetration(Vec3<S>::Zero()).gradient == Vec3<S>(0, 0, 0));
  CHECK(body.penetration(Vec3<S>(S(1e-6), 0, 0)).gradient.norm() <= S(3e-6));  // slope 2 rho / R
}

TEST_CASE_TEMPLATE("cylinder: rays through caps, side and along the axis", S, float, double) {
  const Cylinder<S> body({.radius = S(2), .half_height = S(1)});
  CHECK(body.raycast(Vec3<S>(1, 3, 0), Vec3<S>(0, -2, 0)).t == S(1));
  CHECK(!body.raycast(Vec3<S>(S(2.1), 3, 0), Vec3<S>(0, -2, 0)).hit);
  CHECK(body.raycast(Vec3<S>(-6, 0, 0), Vec3<S>(4, 0, 0)).position == Vec3<S>(-2, 0, 0));
  CHECK(!body.raycast(Vec3<S>(-6, S(1.5), 0), Vec3<S>(4, 0, 0)).hit);
  CHECK(body.raycast(Vec3<S>::Zero(), Vec3<S>(0, 0, 1)).position == Vec3<S>(0, 0, 2));
}

TEST_CASE_TEMPLATE("cylinder: a ball over the rim is as far as the rim", S, float, double) {
  const Cylinder<S> body({.radius = S(2), .half_height = S(1)});
  CHECK(body.separated(Vec3<S>(0, 5, -5), S(4.99)));  // 3 and 4 beyond the rim
  CHECK(!body.separated(Vec3<S>(0, 5, -5), S(5.01)));
}

TEST_CASE_TEMPLATE("cylinder: a ray beside the axis meets the side where Pythagoras has it", S, float,
                   double) {
  test::check_ray_beside_middle<S>(Cylinder<S>({.radius = S(5), .half_height = S(1)}));
}

TEST_CASE_TEMPLATE("cylinder: the closest point to the corner of all numbers is on the rim", S, float,
                   double) {
  constexpr S most = (std::numeric_limits<S>::max)();
  const Cylinder<S> body({.radius = S(2), .half_height = S(1)});
  const SurfacePoint<S> at = body.closest(Vec3<S>(most, most, most));
  CHECK_ABSOLUTE((at.position - Vec3<S>(std::sqrt(S(2)), 1, std::sqrt(S(2)))).norm(), 0, test::ulps<S>(16));
  CHECK(at.distance == most);
  CHECK_ABSOLUTE(at.normal.norm(), 1, test::ulps<S>(8));
  CHECK(at.normal.minCoeff() > S(0.49));  // across is out of range: not 1/sqrt(3) each
}

TEST_CASE("cylinder: bad parameters are refused by name and value") {
  std::string message;
  try {
    Cylinder<double>({.radius = 1, .half_height = -1});
  } catch (const SetupError& error) {
    message = error.what();
  }
  CHECK(message == "Cylinder: half_height [m] must be in [1e-6, 1e6], got -1");
}
