// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/superellipsoid.hpp>

#include <cmath>
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

TEST_CASE("superellipsoid: the closest point is a foot to rounding, whatever the exponents") {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1), exponent(0.1, 1);
  for (int k = 0; k < 100; ++k) {
    const Vec3<double> a(0.03, 0.02, 0.025);
    const Superellipsoid<double> body({.axes = a, .e1 = exponent(random), .e2 = exponent(random)});
    for (int i = 0; i < 200; ++i) {
      const double scale = i % 3 == 0 ? 1.05 : i % 3 == 1 ? 1.5 : 20;
      const Vec3<double> x =
          scale * a.cwiseProduct(Vec3<double>(uniform(random), uniform(random), uniform(random)));
      const SurfacePoint<double> p = body.closest(x);
      if (p.distance < -0.8 * body.reach()) continue;  // other feet are as near
      // Where the descent ends, 4, and the rounding of a normal by powers, about 10, times the distance.
      CHECK_ABSOLUTE(tangential<double>(x - p.position, p.normal).norm(), 0,
                     test::ulps<double>(64) * std::fmax(0.03, x.norm()));
    }
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

TEST_CASE_TEMPLATE("superellipsoid: penetration of many points is that of each, and leads to the foot", S,
                   float, double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1), exponent(0.1, 1);
  for (int k = 0; k < 60; ++k) {
    const Vec3<S> a(S(0.06), S(0.04), k % 2 == 0 ? S(0.04) : S(0.01)), m(S(0.01), S(-0.02), S(0.03));
    const S e1 = k % 5 == 0 ? S(1) : S(exponent(random)), e2 = k % 7 == 0 ? S(0.1) : S(exponent(random));
    const Superellipsoid<S> body({.axes = a, .e1 = e1, .e2 = e2, .centre = m});
    PointBatch<S> x;
    for (std::size_t i = 0; i < batch_size; ++i) {
      Vec3<S> r = a.cwiseProduct(Vec3<S>(S(uniform(random)), S(uniform(random)), S(uniform(random))));
      if (i % 4 == 1) r[static_cast<int>(i) % 3] = S(0);     // plane of symmetry
      if (i == 2) r = Vec3<S>(S(0), S(0), S(0.99) * a.z());  // next to the end of z, where powers underflow
      if (i % 4 == 3) r = S(0.98) * (body.closest(S(3) * r + m).position - m);  // near the surface
      if (i == 7) r.setZero();
      x.x[i] = r.x() + m.x(), x.y[i] = r.y() + m.y(), x.z[i] = r.z() + m.z();
    }
    x.y[5] = std::numeric_limits<S>::quiet_NaN();
    x.z[9] = std::numeric_limits<S>::infinity();
    x.x[10] = (std::numeric_limits<S>::max)();
    PenetrationBatch<S> in;
    body.penetration(x, in);
    for (std::size_t i = 0; i < batch_size; ++i) {
      const Vec3<S> at(x.x[i], x.y[i], x.z[i]), n(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
      const Penetration<S> one = body.penetration(at);
      const long double rounding = test::ulps<S>(8) * 0.06L;
      CHECK_ABSOLUTE(in.depth[i], one.depth, rounding);
      if (!body.inside(at)) {
        CHECK_ABSOLUTE(in.depth[i], 0, rounding);
        continue;
      }
      const SurfacePoint<S> foot = body.closest(at);
      CHECK_ABSOLUTE(in.depth[i], -foot.distance, rounding);
      if (in.depth[i] > S(0.8) * body.reach()) continue;  // the foot is ill-conditioned beyond
      CHECK_ABSOLUTE(n.norm(), 1, test::ulps<S>(8));
      // By powers of another kind: the foot is on the surface, and its normal is this one. A foot is known to
      // a few ulp of a_max, its normal to that times the curvature, at most 1 / reach.
      const Vec3<S> p = at + in.depth[i] * n;
      CHECK_ABSOLUTE(body.closest(p).distance, 0, 2 * rounding);
      CHECK_ABSOLUTE((body.normal(p) - n).norm(), 0,
                     test::ulps<S>(64) + 4 * rounding / static_cast<long double>(body.reach()));
    }
  }
}

TEST_CASE_TEMPLATE("superellipsoid: the centre has a unit normal and no curvature", S, float, double) {
  const Superellipsoid<S> body({.axes = {S(3), S(2), S(2)}, .e1 = S(0.5), .e2 = S(0.4)});
  CHECK_ABSOLUTE(body.normal(Vec3<S>::Zero()).norm(), 1, test::ulps<S>(4));
  CHECK(body.curvature(Vec3<S>::Zero()).k1 == S(0));
  CHECK(body.curvature(Vec3<S>::Zero()).k2 == S(0));
}

TEST_CASE_TEMPLATE("superellipsoid: a ball over the flat is as far as the flat", S, float, double) {
  const Vec3<S> m(S(1), S(-2), S(3));
  const Superellipsoid<S> body({.axes = Vec3<S>::Constant(S(2)), .e1 = S(0.5), .e2 = S(0.5), .centre = m});
  CHECK(body.separated(Vec3<S>(S(3.1), 0, 0) + m, S(1)));
  CHECK(!body.separated(Vec3<S>(S(2.9), 0, 0) + m, S(1)));
  // Over the corner, at (2, 2, 2) / 3^(1/4): N = 3 at (2, 2, 2) 3^(3/4), 1 + r / a = 2.99 and 3.01.
  const Vec3<S> far = Vec3<S>::Constant(S(2 * std::pow(3.0, 0.75))) + m;
  CHECK(body.separated(far, S(3.98)));
  CHECK(!body.separated(far, S(4.02)));
}

TEST_CASE_TEMPLATE("superellipsoid: coordinates next to zero have a closest point and a depth", S, float,
                   double) {
  const S least = (std::numeric_limits<S>::min)();
  for (const S e1 : {S(0.1), S(0.5), S(1)})
    for (const S e2 : {S(0.1), S(0.3), S(1)}) {
      const Superellipsoid<S> body({.axes = {S(0.3), S(1), S(1)}, .e1 = e1, .e2 = e2});
      for (const S x : {S(0), least / S(1000), least * S(3), least * S(1e9)})
        for (const S y : {least / S(1000), least / S(3), least * S(1e12)})
          for (const S z : {S(-12256), S(-2), S(0.9), S(0)})
            for (const Vec3<S>& at : {Vec3<S>(x, y, z), Vec3<S>(z, x, y), Vec3<S>(y, z, x)}) {
              const auto foot = body.closest(at);
              CHECK(is_finite(foot.position));
              CHECK(is_finite(foot.normal));
              CHECK(is_finite(foot.distance));
              CHECK(is_finite(body.penetration(at).gradient));
            }
    }
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
