// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/law/force/duffing.hpp>

#include <random>

using namespace palpate;
using palpate::test::ulps;

namespace {

// Wide floating point for the fold, where 1 - F/F_max is what counts.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Wide;
constexpr int wide_digits = 113;
#else
using Wide = long double;
constexpr int wide_digits = std::numeric_limits<long double>::digits;
#endif

// Error of D as a root of c1 D + c3 D^3 = F for these very numbers, relative to the root: Newton in wide
// arithmetic.
template <Real S>
long double error_of_root(S c1, S c3, S force, S depth) {
  const Wide a = c1, b = c3, f = force;
  Wide d = depth;
  for (int i = 0; i < 60; ++i) {
    const Wide step = ((a + b * d * d) * d - f) / (a + 3 * b * d * d);
    d -= step;
    if ((step < 0 ? -step : step) <= d * Wide(1e-30L)) break;
  }
  const Wide error = (Wide(depth) - d) / d;
  return std::fabs(static_cast<long double>(error));
}

// What the docstring promises of the inverse.
template <Real S>
constexpr long double inverse_promise = ulps<S>(2.5L);

template <Real S>
S power_of_ten(std::mt19937_64& random, double range) {
  return static_cast<S>(std::pow(10.0, std::uniform_real_distribution<double>(-range, range)(random)));
}

}  // namespace

TEST_CASE_TEMPLATE("duffing: force against long double over many decades", S, float, double) {
  std::mt19937_64 random(3);  // fixed seed
  const double range = std::is_same_v<S, float> ? 8 : 70;
  const long double promise = std::is_same_v<S, float> ? 1e-6L : 1e-14L;
  for (int i = 0; i < 20000; ++i) {
    const S c1 = power_of_ten<S>(random, range), c3 = power_of_ten<S>(random, range),
            d = power_of_ten<S>(random, range);
    const DuffingForce<S> hardening({.c1 = c1, .c3 = c3});
    const long double a = c1, b = c3, x = d;
    const long double reference = a * x + b * x * x * x;
    if (reference < static_cast<long double>(std::numeric_limits<S>::max()) &&
        reference > static_cast<long double>(std::numeric_limits<S>::min())) {
      CHECK_RELATIVE(hardening.force(d), reference, promise);
    }
    const DuffingForce<S> softening({.c1 = c1, .c3 = -c3});
    const S share = softening.max_depth() * static_cast<S>(i) / S(20000);
    const long double y = share;
    if (is_finite(softening.max_force()) && softening.force(share) > std::numeric_limits<S>::min()) {
      CHECK_RELATIVE(softening.force(share), a * y - b * y * y * y, promise);
      CHECK_RELATIVE(softening.forces(share), a * y - b * y * y * y, promise);
    }
  }
}

TEST_CASE_TEMPLATE("duffing inverse, hardening: exact to a few units of rounding at any ratio of the terms",
                   S, float, double) {
  std::mt19937_64 random(32);  // fixed seed
  long double worst = 0;
  int failures = 0;
  for (const double range : {1.0, 4.0, std::is_same_v<S, float> ? 9.0 : 90.0}) {
    for (int i = 0; i < 20000; ++i) {
      const S c1 = power_of_ten<S>(random, range), c3 = power_of_ten<S>(random, range),
              f = power_of_ten<S>(random, range);
      const long double error = error_of_root(c1, c3, f, DuffingForce<S>({.c1 = c1, .c3 = c3}).depth(f));
      if (!(error <= inverse_promise<S>)) ++failures;  // counts NaN too
      worst = std::fmax(worst, error);
    }
  }
  MESSAGE("worst error of the hardening inverse: ", static_cast<double>(worst / ulps<S>(1)), " epsilon");
  CHECK(failures == 0);
}

TEST_CASE_TEMPLATE("duffing inverse, softening: exact up to the fold", S, float, double) {
  std::mt19937_64 random(33);  // fixed seed
  std::uniform_real_distribution<double> uniform(0, 1);
  long double worst = 0;
  int failures = 0;
  for (int i = 0; i < 20000; ++i) {
    const S c1 = power_of_ten<S>(random, 8), c3 = -power_of_ten<S>(random, 8);
    const DuffingForce<S> law({.c1 = c1, .c3 = c3});
    const S share = static_cast<S>(i % 2 == 0 ? uniform(random) : 1 - std::pow(10.0, -16 * uniform(random)));
    const S f = share * law.max_force();
    if (!(f > S(0)) || !(f < law.max_force())) continue;
    const long double error = error_of_root(c1, c3, f, law.depth(f));
    if (!(error <= inverse_promise<S>)) ++failures;  // counts NaN too
    worst = std::fmax(worst, error);
  }
  MESSAGE("worst error of the softening inverse: ", static_cast<double>(worst / ulps<S>(1)), " epsilon");
  // Half the digits are lost at the fold, so the reference needs twice the scalar's.
  if (wide_digits >= 2 * std::numeric_limits<S>::digits) CHECK(failures == 0);
}

TEST_CASE("duffing inverse, softening: known roots at the fold") {
  // c1 = 3, c3 = -1: D_max = 1, F_max = 2 and F(1 - e) = 2 - 3 e^2 + e^3, exact in binary for e = 2^-k, k <=
  // 17.
  const DuffingForce<double> law({.c1 = 3, .c3 = -1});
  CHECK(law.max_depth() == 1);
  CHECK(law.max_force() == 2);
  for (int k = 1; k <= 17; ++k) {
    const double e = std::ldexp(1.0, -k);
    CHECK_RELATIVE(law.depth(2 - 3 * e * e + e * e * e), 1 - e, ulps<double>(1));
  }
  CHECK(law.depth(std::nextafter(2.0, 0.0)) < 1);
  CHECK(law.depth(2) == 1);
  CHECK(law.depth(1e300) == 1);
  CHECK(law.force(1.5) == 2);
  CHECK(law.stiffness(1.5) == 0);
  CHECK_RELATIVE(law.energy(1.5), 1.25 + 2 * 0.5, ulps<double>(2));  // 3/2 - 1/4, then 2 N over 0.5 m
  // F_max = (2/3) c1 sqrt(c1 / (3 |c3|)) within half a unit, also where c1^3 would overflow or underflow.
  for (const double scale : {1.0, 1e-200, 1e200}) {
    const DuffingForce<double> other({.c1 = 40 * scale, .c3 = -7e4 * scale});
    const long double d =
        std::sqrt(static_cast<long double>(40 * scale) / (3 * static_cast<long double>(7e4 * scale)));
    CHECK_RELATIVE(other.max_depth(), d, ulps<double>(1));
    CHECK_RELATIVE(other.max_force(), static_cast<long double>(40 * scale) * d * 2 / 3, ulps<double>(0.51L));
  }
}

TEST_CASE("duffing inverse: extremes that break closed forms") {
  struct Row {
    double c1, c3, force, depth;
  };
  // Roots to 20 digits; where one term is negligible, by that of the other.
  const Row rows[] = {
      {1e-300, 1, 1, 1},
      {1, 1e-300, 1, 1},
      {1, 1e-300, 1e300, 1e200},
      {1, 1, 1e300, 1e100},
      {1e150, 1e-150, 1e200, 1e50},
      {1, 1, 1e-310, 1e-310},  // a subnormal force gives a subnormal depth
      {0, 1, 1, 1},
      {0, 8, 1e-9, 5e-4},
      {2, 0, 1, 0.5},
      {1, 0, 1e-310, 1e-310},
      {1e-310, 1e-310, 1, 2.1544346900318843e103},  // subnormal coefficients
      {5e-324, 1, 27, 3},
      {1, 5e-324, 1, 1},
      {1e-300, 5e-324, (std::numeric_limits<double>::max)(), 3.3136779738342708e210},
      {1e308, 1e-308, 1e308, 1},
      {1e-308, 1e308, 1e-308, 4.6415888336127788924e-206},
      {1, 1, 2, 1},
      {1, 1, 10, 2},
      {40, 3e8, 0.34, 1e-3},  // the paper, 1 mm deep
  };
  for (const Row& row : rows) {
    INFO("c1 ", row.c1, " c3 ", row.c3, " F ", row.force);
    CHECK_RELATIVE(DuffingForce<double>({.c1 = row.c1, .c3 = row.c3}).depth(row.force), row.depth,
                   ulps<double>(4));
  }
  CHECK(DuffingForce<double>({.c1 = 1e308, .c3 = 1e308}).depth(1e-308) == 0);  // 1e-616
  const double tiny = DuffingForce<double>({.c1 = 0, .c3 = 1}).depth(1e-310);
  CHECK_RELATIVE(tiny, 4.6415888336127788924e-104, 1e-13);  // a subnormal F has 13 digits
}

TEST_CASE("duffing: the paper's parameters") {
  // m = 1 kg, omega_0 = 0.2, beta_0^2 epsilon = 0.4, D in mm, F in N: F = 0.04 D + 0.3 D^3.
  using Law = DuffingForce<double>;
  const auto law =
      Law::from_oscillator({.mass = 1, .omega0 = 0.2, .beta0_squared_epsilon = 0.4, .length_unit = 1e-3});
  CHECK_RELATIVE(law.params().c1, 40, ulps<double>(4));
  CHECK_RELATIVE(law.params().c3, 3e8, ulps<double>(4));
  CHECK_RELATIVE(law.force(1e-3), 0.34, ulps<double>(4));
  const auto exact = Law::from_oscillator(
      {.mass = 1, .omega0 = 0.2, .beta0_squared_epsilon = 0.4, .length_unit = 1e-3, .factor = 1});
  CHECK_RELATIVE(exact.force(1e-3), 0.44, ulps<double>(4));
  // kg mm/s^2 taken at its word is a millinewton.
  const auto consistent = Law::from_oscillator(
      {.mass = 1, .omega0 = 0.2, .beta0_squared_epsilon = 0.4, .length_unit = 1e-3, .force_unit = 1e-3});
  CHECK_RELATIVE(consistent.force(1e-3), 0.34e-3, ulps<double>(4));
  // The same spring described in SI: one oscillator, one force.
  const auto si =
      Law::from_oscillator({.mass = 1, .omega0 = 0.2, .beta0_squared_epsilon = 0.4e6, .length_unit = 1});
  CHECK_RELATIVE(si.force(1e-3), consistent.force(1e-3), ulps<double>(4));
}

TEST_CASE("duffing: force and static root of tabulated oscillators") {
  struct Row {
    double m, w0, b2, eps, force_depth, three_quarters, one;
  };
  // Rows of duffing_force_law.csv (mass, omega0, beta0^2, epsilon, D, F with 3/4, F with 1), computed
  // independently by the project's reference data set; ten printed digits, hence 1e-9.
  const Row forces[] = {
      {0.2, 30, 900, 0.05, 0.001, 0.1800000068, 0.180000009},
      {0.2, 30, 20000, 0.5, 0.016, 2.886144, 2.888192},
      {0.1, 60, 500000, 1, 0.012, 4.3848, 4.4064},
      {0.05, 100, 1000000, 2, 0.016, 8.3072, 8.4096},
  };
  const auto law = [](const Row& r, double factor) {
    return DuffingForce<double>::from_oscillator({.mass = r.m,
                                                  .omega0 = r.w0,
                                                  .beta0_squared_epsilon = r.b2 * r.eps,
                                                  .length_unit = 1,
                                                  .factor = factor});
  };
  for (const Row& r : forces) {
    CHECK_RELATIVE(law(r, 0.75).force(r.force_depth), r.three_quarters, 1e-9);
    CHECK_RELATIVE(law(r, 1).force(r.force_depth), r.one, 1e-9);
  }
  // Rows of duffing_static.csv (mass, omega0, beta0^2, epsilon, F, root with 3/4, root with 1).
  const Row roots[] = {
      {0.2, 30, 20000, 0.5, 20, 0.102212361, 0.1},
      {0.1, 60, 500000, 1, 0.1, 0.0002777755452, 0.000277774801},
      {0.1, 60, 500000, 1, 20, 0.04564761985, 0.04384724195},
      {0.05, 100, 1000000, 2, 5, 0.009856370921, 0.009811120089},
  };
  for (const Row& r : roots) {
    CHECK_RELATIVE(law(r, 0.75).depth(r.force_depth), r.three_quarters, 1e-9);
    CHECK_RELATIVE(law(r, 1).depth(r.force_depth), r.one, 1e-9);
  }
}

TEST_CASE("duffing: fits keep their stated error") {
  const double depth = 0.005, force = 2;
  const auto worst = [&](const DuffingForce<double>& law, auto target) {
    double error = 0;
    for (int i = 0; i <= 1000; ++i) {
      const double u = i / 1000.0;
      error = std::fmax(error, std::fabs(law.force(u * depth) / force - target(u)));
    }
    return error;
  };
  using Law = DuffingForce<double>;
  // Upper bounds from the docstrings, lower ones so that they are not idle.
  const double hertz = worst(Law::hertz_fit(depth, force), [](double u) { return u * std::sqrt(u); });
  const double parabolic = worst(Law::parabolic_fit(depth, force), [](double u) { return u * u; });
  const double fung =
      worst(Law::fung_fit(depth, force), [](double u) { return std::expm1(3 * u) / std::expm1(3.0); });
  CHECK(hertz < 0.0395);
  CHECK(hertz > 0.038);
  CHECK(parabolic < 0.0425);
  CHECK(parabolic > 0.041);
  CHECK(fung < 0.0345);
  CHECK(fung > 0.033);
  CHECK_RELATIVE(Law::hertz_fit(depth, force).params().c1 * depth / force, 0.5844,
                 1e-4);  // four digits known
  CHECK_RELATIVE(Law::hertz_fit(depth, force).params().c3 * depth * depth * depth / force, 0.4545, 2e-4);
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("duffing: bad parameters are refused by name and value") {
  using Law = DuffingForce<double>;
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH_AS(Law({.c1 = -3}), "DuffingForce: c1 [N/m] must be >= 0 and finite, got -3", SetupError);
  CHECK_THROWS_WITH_AS(Law({.c1 = nan}), "DuffingForce: c1 [N/m] must be >= 0 and finite, got nan",
                       SetupError);
  CHECK_THROWS_WITH_AS(Law({.c1 = 1, .c3 = infinity}), "DuffingForce: c3 [N/m^3] must be finite, got inf",
                       SetupError);
  CHECK_THROWS_WITH_AS(Law({.c1 = 0, .c3 = 0}),
                       "DuffingForce: c3 [N/m^3] must be > 0 where c1 [N/m] is 0, got 0", SetupError);
  CHECK_THROWS_AS(Law({.c1 = 0, .c3 = -1}), SetupError);
  const Law::Oscillator no_unit{.mass = 1, .omega0 = 0.2, .beta0_squared_epsilon = 0.4, .length_unit = 0};
  CHECK_THROWS_WITH_AS(static_cast<void>(Law::from_oscillator(no_unit)),
                       "DuffingForce::from_oscillator: length_unit [m] must be > 0 and finite, got 0",
                       SetupError);
  CHECK_THROWS_AS(static_cast<void>(Law::hertz_fit(0, 1)), SetupError);
}
#endif
