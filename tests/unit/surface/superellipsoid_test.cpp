// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/surface/ellipsoid.hpp>
#include <palpate/surface/superellipsoid.hpp>

#include <random>
#include <string>

using namespace palpate;

namespace {
constexpr std::uint64_t seed = 20250714;
}

TEST_CASE_TEMPLATE("superellipsoid: exponents 1 give the ellipsoid", S, float, double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3<S> a(S(0.03), S(0.02), S(0.025));
  const Superellipsoid<S> body({.axes = a, .e1 = S(1), .e2 = S(1)});
  const Ellipsoid<S> same({.axes = a});
  CHECK_RELATIVE(body.volume(), same.volume(), test::ulps<S>(32));
  CHECK_RELATIVE(body.reach(), same.reach(), 0.011L);  // lowered by 1 %
  for (int i = 0; i < 500; ++i) {
    const double scale = i % 2 == 0 ? 1.5 : 5000;
    const Vec3<S> x =
        a.cwiseProduct(Vec3<S>(S(uniform(random)), S(uniform(random)), S(uniform(random)))) * S(scale);
    const SurfacePoint<S> p = body.closest(x), q = same.closest(x);
    const long double size = std::fmax(0.03L, x.template cast<long double>().norm());
    CHECK_ABSOLUTE(p.distance, q.distance, test::ulps<S>(64) * size);
    CHECK(body.inside(x) == same.inside(x));
    if (p.distance < -S(0.8) * body.reach()) continue;  // the foot is ill-conditioned beyond
    // From afar lengths stop telling points apart before directions do: hundreds of ulp in the foot.
    CHECK_ABSOLUTE((p.position - q.position).norm(), 0, test::ulps<S>(4096) * size);
    const Curvature<S> c = body.curvature(q.position), e = same.curvature(q.position);
    CHECK_RELATIVE(c.k1, e.k1, test::ulps<S>(1024));  // powers, then a cancelling eigenvalue
    CHECK_ABSOLUTE(c.k2, e.k2, static_cast<long double>(e.k1) * test::ulps<S>(1024));
  }
}

TEST_CASE_TEMPLATE("superellipsoid: between its box and its ellipsoid; flats are flat", S, float, double) {
  const Superellipsoid<S> body({.axes = Vec3<S>::Constant(S(0.02)), .e1 = S(0.1), .e2 = S(0.1)});
  CHECK(body.volume() > S(0.9) * S(64e-6));
  CHECK(body.volume() < S(64e-6));
  CHECK(body.inside(Vec3<S>::Constant(S(0.0185))));
  CHECK(!body.inside(Vec3<S>::Constant(S(0.0195))));
  const Curvature<S> top = body.curvature(Vec3<S>(0, 0, S(0.02)));
  CHECK(top.k1 == S(0));
  CHECK(top.k2 == S(0));
  const Penetration<S> p = body.penetration(Vec3<S>(S(0.001), S(0.002), S(0.019)));
  CHECK_ABSOLUTE(p.depth, 0.001L, test::ulps<S>(32) * 0.02L);
  CHECK_ABSOLUTE(p.gradient.z(), 1.0L, test::ulps<S>(8));
}

TEST_CASE("superellipsoid: bad exponents and ratios are refused by name and value") {
  const auto refusal = [](const Superellipsoid<double>::Params& params) -> std::string {
    try {
      Superellipsoid<double> body(params);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal({.e1 = 1.5}) == "Superellipsoid: exponent e1 must be in [0.1, 1], got 1.5");
  CHECK(refusal({.e2 = 0.05}) == "Superellipsoid: exponent e2 must be in [0.1, 1], got 0.05");
  CHECK(refusal({.axes = {1, 1, 0.01}}) == "Superellipsoid: ratio of axes must be at most 20, got 100");
  CHECK(refusal({.e1 = 0.1, .e2 = 0.1}) == "accepted");
}
