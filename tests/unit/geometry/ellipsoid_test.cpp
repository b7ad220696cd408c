// SPDX-License-Identifier: MIT

#include "support/check.hpp"
#include "support/ray_checks.hpp"

#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

using namespace palpate;

namespace {

constexpr std::uint64_t seed = 20250712;

struct Foot {
  long double p[3], distance;
};

// Closest point by plain bisection in log w, long double; independent of the method under test. For a point
// in the plane across the smallest axis the + side is taken, as the class says.
template <Real S>
Foot reference(const Vec3<S>& x, const Vec3<S>& axes) {
  const long double a_min = axes.minCoeff();
  long double z[3], r[3], gap[3];
  bool first = true;
  for (int i = 0; i < 3; ++i) {
    const long double a = axes[i];
    z[i] = std::fabs(static_cast<long double>(x[i])) / a;
    r[i] = (a / a_min) * (a / a_min);
    gap[i] = (a - a_min) * (a + a_min) / (a_min * a_min);
    if (gap[i] == 0 && first) {
      first = false;
      z[i] = std::max(z[i], 1e-1000L);
    }
  }
  const auto q = [&](int i, long double w) { return r[i] * z[i] / (w + gap[i]); };
  const auto excess = [&](long double w) {
    return q(0, w) * q(0, w) + q(1, w) * q(1, w) + q(2, w) * q(2, w) - 1;
  };
  long double low = -2400, high = 60;  // log w
  for (int k = 0; k < 90; ++k) {
    const long double middle = (low + high) / 2;
    (excess(std::exp(middle)) > 0 ? low : high) = middle;
  }
  const long double w = std::exp((low + high) / 2), length = std::sqrt(excess(w) + 1);
  Foot foot{};
  long double slope = 0;
  for (int i = 0; i < 3; ++i) {
    const long double unit = q(i, w) / length;
    foot.p[i] = (x[i] < 0 ? -1 : 1) * axes[i] * unit;
    slope += (unit * a_min / axes[i]) * (unit * a_min / axes[i]);
  }
  foot.distance = (w - 1) * a_min * std::sqrt(slope);
  return foot;
}

template <Real S>
std::vector<Vec3<S>> shapes() {
  return {{S(0.03), S(0.02), S(0.02)}, {S(0.03), S(0.025), S(0.02)}, {S(1), S(0.03), S(0.001)},
          {S(0.001), S(1), S(0.001)},  {S(1), S(1), S(0.001)},       {S(0.02), S(0.02), S(0.02)}};
}

}  // namespace

TEST_CASE_TEMPLATE("ellipsoid: closest point equals the long double reference, ratios to 1 : 1000", S, float,
                   double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const Vec3<S>& a : shapes<S>()) {
    const Ellipsoid<S> body({.axes = a});
    long double worst_distance = 0, worst_surface = 0, worst_foot = 0;
    for (int i = 0; i < 3000; ++i) {
      const double scale = i % 3 == 0 ? std::pow(10.0, 6 * uniform(random)) : 1.3;
      Vec3<S> x;
      for (int k = 0; k < 3; ++k) {
        double v = uniform(random);
        if (i % 7 == 2 && k == i / 7 % 3) v = 0;  // planes of symmetry: focal disc, axes
        if (i % 11 == 3 && k != i / 11 % 3) v = 0;
        if (i % 5 == 1 && k == i % 3) v *= 1e-12;  // next to them
        x[k] = static_cast<S>(v * scale) * a[k];
      }
      const SurfacePoint<S> p = body.closest(x);
      const Foot foot = reference(x, a);
      const long double size =
          std::max(static_cast<long double>(a.maxCoeff()), x.template cast<long double>().norm());
      worst_distance = std::max(worst_distance, std::fabs(p.distance - foot.distance) / size);
      long double surface = 0, gap = 0;
      for (int k = 0; k < 3; ++k) {
        const long double u = static_cast<long double>(p.position[k]) / a[k];
        surface += u * u;
        gap = std::max(gap, std::fabs(static_cast<long double>(p.position[k]) +
                                      static_cast<long double>(p.distance) * p.normal[k] - x[k]));
      }
      worst_surface = std::max(worst_surface, std::fabs(surface - 1));
      worst_foot = std::max(worst_foot, gap / size);
    }
    INFO("axes ", a.x(), " ", a.y(), " ", a.z());
    // The solver stops at a residual of 8 ulp; the rest is the rounding of about ten operations.
    CHECK(worst_distance <= test::ulps<S>(12));
    CHECK(worst_surface <= test::ulps<S>(8));
    CHECK(worst_foot <= test::ulps<S>(16));
  }
}

TEST_CASE_TEMPLATE("ellipsoid: near the surface the foot point itself is accurate", S, float, double) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3<S> a(S(0.03), S(0.025), S(0.02));
  const Ellipsoid<S> body({.axes = a});
  for (int i = 0; i < 2000; ++i) {
    const Vec3<S> d = Vec3<S>(S(uniform(random)), S(uniform(random)), S(uniform(random))).normalized();
    const Vec3<S> x = static_cast<S>(1 - 0.2 * std::fabs(uniform(random))) * a.cwiseProduct(d);
    const SurfacePoint<S> p = body.closest(x);
    const Foot foot = reference(x, a);
    for (int k = 0; k < 3; ++k) {
      // Depth up to 0.4 of the smallest radius of curvature lets the foot move by 1 / 0.6 of x.
      CHECK_ABSOLUTE(p.position[k], foot.p[k], test::ulps<S>(16) * 0.03L);
    }
  }
}

TEST_CASE_TEMPLATE("ellipsoid: centre, axes and focal disc go to the stated side", S, float, double) {
  const Ellipsoid<S> body({.axes = {S(3), S(1), S(2)}});
  const SurfacePoint<S> centre = body.closest(Vec3<S>::Zero());
  CHECK(centre.position == Vec3<S>(0, 1, 0));
  CHECK(centre.normal == Vec3<S>(0, 1, 0));
  CHECK(centre.distance == S(-1));
  CHECK(body.closest(Vec3<S>(S(-0.0), S(-0.0), S(-0.0))).position == centre.position);

  // Equal smallest axes: the first of them.
  CHECK(Ellipsoid<S>({.axes = {S(2), S(1), S(1)}}).closest(Vec3<S>::Zero()).position == Vec3<S>(0, 1, 0));
  CHECK(Ellipsoid<S>({.axes = {S(1), S(1), S(1)}}).closest(Vec3<S>::Zero()).position == Vec3<S>(1, 0, 0));

  // On the long axis inside the focal disc: x = (9 - 1) / 3 * c, p = (3 c, sqrt(1 - c^2), 0), the + side.
  const SurfacePoint<S> disc = body.closest(Vec3<S>(S(4) / S(3), 0, 0));
  CHECK_ABSOLUTE(disc.position.x(), 1.5L, test::ulps<S>(8));
  CHECK_ABSOLUTE(disc.position.y(), std::sqrt(0.75L), test::ulps<S>(8));
  CHECK(std::abs(disc.position.z()) == S(0));
  // Beyond the focus: the end of the axis.
  const SurfacePoint<S> end = body.closest(Vec3<S>(S(-2.9), 0, 0));
  CHECK_ABSOLUTE(end.position.x(), -3.0L, test::ulps<S>(2) * 3);
  CHECK_ABSOLUTE(end.distance, static_cast<long double>(S(-2.9)) * -1 - 3, test::ulps<S>(16) * 3);
  // A thousandth of an ulp off the plane decides the side.
  CHECK(body.closest(Vec3<S>(S(1), S(-1e-12), 0)).position.y() < S(0));
}

TEST_CASE_TEMPLATE("ellipsoid: equal axes agree with the sphere", S, float, double) {
  const Ellipsoid<S> body({.axes = Vec3<S>::Constant(S(0.03))});
  const Sphere<S> sphere({.radius = S(0.03)});
  const Vec3<S> x(S(0.01), S(-0.02), S(0.005));
  CHECK((body.closest(x).position - sphere.closest(x).position).norm() <=
        static_cast<S>(test::ulps<S>(8)) * S(0.03));
  CHECK_RELATIVE(body.volume(), sphere.volume(), test::ulps<S>(8));
  CHECK_RELATIVE(body.curvature(sphere.point(S(0.1), S(0.3))).k2, 1 / 0.03L, test::ulps<S>(32));
}

TEST_CASE_TEMPLATE("ellipsoid: a ray beside the centre meets it where Pythagoras has it", S, float, double) {
  test::check_ray_beside_middle<S>(Ellipsoid<S>({.axes = {S(5), S(7), S(5)}}));
}

TEST_CASE_TEMPLATE("exact surfaces: elsewhere it is the same body", S, float, double) {
  const Vec3<S> m(S(4), S(-8), S(2)), axes(S(3), S(1), S(2));
  const Ellipsoid<S> here({.axes = axes}), there({.axes = axes, .centre = m});
  const Vec3<S> p = here.point(S(0.1), S(0.3));
  const long double moved = test::ulps<S>(64);  // p + m is rounded to an ulp of 8, the least axis is 1
  CHECK_ABSOLUTE((there.normal(p + m) - here.normal(p)).norm(), 0, moved);
  CHECK_ABSOLUTE((there.closest(S(2) * p + m).position - m - here.closest(S(2) * p).position).norm(), 0,
                 moved);
  CHECK_ABSOLUTE(there.curvature(p + m).k1, here.curvature(p).k1, 8 * moved);  // at most 9 in 1/m
  CHECK_ABSOLUTE(there.raycast(m, p).t, 1, moved);
}

TEST_CASE_TEMPLATE("exact surfaces: sizes of 1e-6 and of 1e6 m are still taken", S, float, double) {
  for (const S size : {S(1e-6L), S(1e6L)}) {
    CHECK(Sphere<S>({.radius = size}).params().radius == size);
    CHECK(Ellipsoid<S>({.axes = Vec3<S>::Constant(size)}).reach() > S(0));
  }
  CHECK_THROWS_AS(Sphere<S>({.radius = S(0.99e-6L)}), SetupError);
  CHECK_THROWS_AS(Sphere<S>({.radius = S(1.01e6L)}), SetupError);
}

TEST_CASE_TEMPLATE("ellipsoid: curvatures at the ends of the axes, ratio 1 : 1000", S, float, double) {
  const long double a = 1, b = 0.03L, c = 0.001L;
  const Ellipsoid<S> body({.axes = {S(a), S(b), S(c)}});
  const Curvature<S> x = body.curvature(Vec3<S>(S(a), 0, 0)), z = body.curvature(Vec3<S>(0, 0, S(c)));
  // Sizes are rounded to S first: a few ulp for each power of them.
  CHECK_RELATIVE(x.k1, a / (c * c), test::ulps<S>(16));
  CHECK_RELATIVE(x.k2, a / (b * b), test::ulps<S>(32));
  CHECK(std::abs(x.dir1.z()) == S(1));
  CHECK_RELATIVE(z.k1, c / (b * b), test::ulps<S>(16));
  CHECK_RELATIVE(z.k2, c / (a * a), test::ulps<S>(32));
  CHECK(std::abs(z.dir1.y()) == S(1));
  CHECK_RELATIVE(body.reach(), c * c / a, test::ulps<S>(8));
}

TEST_CASE_TEMPLATE("ellipsoid: separation is not lost in a thin body's long direction", S, float, double) {
  const Ellipsoid<S> body({.axes = {S(1), S(1), S(0.001)}});
  CHECK(body.separated(Vec3<S>(0, 0, S(0.0021)), S(0.001)));
  CHECK(!body.separated(Vec3<S>(0, 0, S(0.0019)), S(0.001)));
  CHECK(body.separated(Vec3<S>(S(1.1), 0, 0), S(0.05)));
  CHECK(!body.separated(Vec3<S>(S(1.1), 0, 0), S(0.11)));
}

TEST_CASE("exact surfaces: bad parameters are refused by name and value") {
  const auto refused = [](auto make, const char* message) {
    try {
      make();
      FAIL("accepted");
    } catch (const SetupError& error) {
      CHECK_MESSAGE(std::string(error.what()) == message, error.what());
    }
  };
  refused(
      [] {
        Ellipsoid<double>({.axes = {1, -2, 1}});
      },
      "Ellipsoid: axes [m] must be in [1e-6, 1e6], got -2");
  refused(
      [] {
        Ellipsoid<double>({.axes = {1, 1, 0}});
      },
      "Ellipsoid: axes [m] must be in [1e-6, 1e6], got 0");
  refused(
      [] {
        Ellipsoid<double>({.axes = {1, 1, 1001}});
      },
      "Ellipsoid: ratio of axes must be at most 1000, got 1001");
  refused(
      [] {
        Ellipsoid<double>({.axes = {1, std::numeric_limits<double>::quiet_NaN(), 1}});
      },
      "Ellipsoid: axes [m] must be in [1e-6, 1e6], got nan");
  refused(
      [] {
        Ellipsoid<double>({.centre = {0, 2e6, 0}});
      },
      "Ellipsoid: centre [m] must be finite and below 1e6, got 2000000");
  refused([] { Sphere<double>({.radius = -0.5}); }, "Sphere: radius [m] must be in [1e-6, 1e6], got -0.5");
  refused([] { Sphere<double>({.radius = std::numeric_limits<double>::infinity()}); },
          "Sphere: radius [m] must be in [1e-6, 1e6], got inf");
}

TEST_CASE_TEMPLATE("many points at once are the same as one by one, from outside to the centre", S, float,
                   double) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), logarithm(-8, 0.3);
  for (const Vec3<S>& axes : {Vec3<S>(S(0.06), S(0.04), S(0.04)), Vec3<S>(S(0.03), S(0.02), S(0.01)),
                              Vec3<S>(S(0.02), S(0.02), S(0.02)), Vec3<S>(S(1), S(0.02), S(0.001))}) {
    const Ellipsoid<S> body({.axes = axes, .centre = Vec3<S>(S(0.01), S(-0.02), S(0.005))});
    for (int k = 0; k < 500; ++k) {
      PointBatch<S> x;
      const S shrink = S(1) - S(std::pow(10.0, logarithm(random)));  // near the surface, deep, and outside
      for (std::size_t i = 0; i < batch_size; ++i) {
        const Vec3<S> q = Vec3<S>(S(unit(random)), S(unit(random)), S(unit(random))).normalized();
        const Vec3<S> p = body.params().centre + axes.cwiseProduct(q) * (i == 7 ? S(1.5) : shrink);
        x.x[i] = p.x(), x.y[i] = p.y(), x.z[i] = p.z();
      }
      if (k % 100 == 0) x.y[3] = std::numeric_limits<S>::quiet_NaN();
      PenetrationBatch<S> in;
      body.penetration(x, in);
      for (std::size_t i = 0; i < batch_size; ++i) {
        const Penetration<S> one = body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
        // The same formula, in which a compiler may contract products and sums in another way: a few ulp.
        const S ulps = S(16) * std::numeric_limits<S>::epsilon() * axes.maxCoeff();
        CHECK_ABSOLUTE(in.depth[i], one.depth, ulps);
        const Vec3<S> gradient(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
        if (one.depth <= ulps) continue;  // on the surface to rounding: in or out
        // A foot moved by those ulp turns the normal by as much over the smallest radius of curvature.
        CHECK((gradient - one.gradient).norm() <= S(4) * ulps / body.reach());
      }
    }
  }
}
