// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>

#include <random>
#include <string>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE("power law friction: K F^beta above the chord, against long double", S, float, double) {
  std::mt19937_64 random(1953);  // fixed seed
  std::uniform_real_distribution<double> decade(-12, 12), exponent(2.0 / 3, 1.0);
  for (int i = 0; i < 3000; ++i) {
    const S beta = static_cast<S>(exponent(random)), normal = static_cast<S>(std::pow(10.0, decade(random)));
    const PowerLawFriction<S> law(
        {.K = S(0.562), .beta = beta, .mu_dynamic = S(0.4), .linear_below = S(0.01)});
    const auto K = static_cast<long double>(S(0.562)), N = static_cast<long double>(normal),
               b = static_cast<long double>(beta), N0 = static_cast<long double>(S(0.01));
    const long double reference = N >= N0 ? K * std::pow(N, b) : K * std::pow(N0, b - 1) * N;
    CHECK_RELATIVE(law.static_limit(normal), reference, ulps<S>(4));  // pow() and two products
    CHECK_RELATIVE(law.sliding_limit(normal), std::fmin(static_cast<long double>(S(0.4)) * N, reference),
                   ulps<S>(4));
  }
}

TEST_CASE_TEMPLATE("power law friction: the paper's 3/4 by roots; sliding is never above sticking", S, float,
                   double) {
  std::mt19937_64 random(1953);  // fixed seed
  std::uniform_real_distribution<double> decade(-2, 12), exponent(2.0 / 3, 1.0), coefficient(0.1, 1.0),
      close(-64, 64);
  for (int i = 0; i < 3000; ++i) {
    const S K = static_cast<S>(coefficient(random)), mu = static_cast<S>(coefficient(random));
    const PowerLawFriction<S> paper({.K = K, .beta = S(0.75), .mu_dynamic = mu});
    const S normal = static_cast<S>(std::pow(10.0, decade(random)));
    CHECK_RELATIVE(paper.static_limit(normal),
                   static_cast<long double>(K) * std::pow(static_cast<long double>(normal), 0.75L),
                   ulps<S>(4));
    const S beta = i % 2 == 0 ? S(0.75) : static_cast<S>(exponent(random));
    const PowerLawFriction<S> law({.K = K, .beta = beta, .mu_dynamic = mu});
    const S meet = std::pow(K / mu, S(1) / (S(1) - beta));  // to rounding
    const S near = meet * (S(1) + static_cast<S>(close(random)) * std::numeric_limits<S>::epsilon());
    if (is_finite(near)) CHECK(law.sliding_limit(near) <= law.static_limit(near));
  }
}

TEST_CASE_TEMPLATE("power law friction: beta = 1 is Coulomb to the bit", S, float, double) {
  const PowerLawFriction<S> power({.K = S(0.6), .beta = S(1), .mu_dynamic = S(0.4)});
  const CoulombFriction<S> coulomb({.mu_static = S(0.6), .mu_dynamic = S(0.4)});
  for (int i = -60; i <= 60; ++i) {
    const S normal = S(0.37) * std::pow(S(10), S(i) / S(5));
    CHECK(power.static_limit(normal) == coulomb.static_limit(normal));
    CHECK(power.sliding_limit(normal) == coulomb.sliding_limit(normal));
  }
  CHECK(power.max_coefficient() == coulomb.max_coefficient());
}

TEST_CASE("power law friction: unit of K") {
  using Law = PowerLawFriction<double>;
  // The paper's K = 10 at beta = 0.75, were it in dyn or in millinewtons: 0.562 and 1.78 N^0.25 by hand.
  CHECK_RELATIVE(Law::si_coefficient(10, 0.75, 1e-5), 0.5623413251903491, ulps<double>(8));
  CHECK_RELATIVE(Law::si_coefficient(10, 0.75, 1e-3), 1.778279410038923, ulps<double>(8));
  CHECK(Law::si_coefficient(10, 0.75, 1) == 10);
  CHECK_RELATIVE(Law::si_coefficient(0.6, 1, 1e-5), 0.6, 0);  // a coefficient has no unit
  // The same friction in dyn: f_dyn = K_dyn N_dyn^beta.
  const Law law({.K = Law::si_coefficient(10, 0.75, 1e-5), .beta = 0.75, .mu_dynamic = 0.4});
  CHECK_RELATIVE(law.static_limit(2.0), 10 * std::pow(2.0e5L, 0.75L) * 1e-5L, ulps<double>(8));
  CHECK_RELATIVE(law.static_limit(1.0), 0.5623413251903491, ulps<double>(8));  // effective coefficient at 1 N
  CHECK_RELATIVE(law.static_limit(5.0) / 5.0, 0.376, 1e-3);  // 0.38 at 5 N; three digits known
}

TEST_CASE("power law friction: below (K/mu_D)^(1/(1-beta)) sliding is mu_D F, above it f_max") {
  const PowerLawFriction<double> law({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.4});
  const double crossing = std::pow(0.562 / 0.4, 4.0);  // 3.9 N
  CHECK(law.sliding_limit(0.99 * crossing) < law.static_limit(0.99 * crossing));
  CHECK(law.sliding_limit(0.99 * crossing) == 0.4 * (0.99 * crossing));
  CHECK(law.sliding_limit(1.01 * crossing) == law.static_limit(1.01 * crossing));
}

TEST_CASE("power law friction: the printed law has no bound on f_max / F") {
  const PowerLawFriction<double> literal({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.4, .linear_below = 0});
  CHECK_FALSE(is_finite(literal.max_coefficient()));
  CHECK_RELATIVE(literal.static_limit(1e-12), 0.562 * 1e-9, ulps<double>(8));
  const PowerLawFriction<double> chord({.K = 0.562, .beta = 0.75, .mu_dynamic = 0.4});
  CHECK_RELATIVE(chord.max_coefficient(), 0.562 * std::pow(0.01L, -0.25L), ulps<double>(4));  // 1.78
}

#if PALPATE_HAS_EXCEPTIONS
TEST_CASE("friction laws: bad parameters are refused by name and value") {
  using Power = PowerLawFriction<double>;
  using Coulomb = CoulombFriction<double>;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto power = [](double K, double beta, double mu, double low) {
    try {
      Power({.K = K, .beta = beta, .mu_dynamic = mu, .linear_below = low});
    } catch (const SetupError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(power(10, 0.75, 0.4, 0.01).empty());
  CHECK(power(10, 2.0 / 3.0, 0.4, 0).empty());
  CHECK(power(-1, 0.75, 0.4, 0.01) == "PowerLawFriction: K [N^(1-beta)] must be > 0 and finite, got -1");
  CHECK(power(nan, 0.75, 0.4, 0.01) == "PowerLawFriction: K [N^(1-beta)] must be > 0 and finite, got nan");
  CHECK(power(10, 0.6, 0.4, 0.01) == "PowerLawFriction: beta [-] must be in [2/3, 1], got 0.6");
  CHECK(power(10, 1.01, 0.4, 0.01) == "PowerLawFriction: beta [-] must be in [2/3, 1], got 1.01");
  CHECK(power(10, 0.75, 0, 0.01) == "PowerLawFriction: mu_dynamic [-] must be > 0 and finite, got 0");
  CHECK(power(10, 0.75, 0.4, -2) == "PowerLawFriction: linear_below [N] must be >= 0 and finite, got -2");
  CHECK_THROWS_WITH_AS(Coulomb({.mu_static = 0.3, .mu_dynamic = 0.4}),
                       "CoulombFriction: mu_dynamic [-] must be <= mu_static, got 0.4", SetupError);
  CHECK_THROWS_WITH_AS(Coulomb({.mu_static = 0, .mu_dynamic = 0}),
                       "CoulombFriction: mu_static [-] must be > 0 and finite, got 0", SetupError);
  CHECK_THROWS_AS(Coulomb({.mu_static = 0.3, .mu_dynamic = nan}), SetupError);
  CHECK_THROWS_AS(static_cast<void>(Power::si_coefficient(10, 0.75, 0)), SetupError);
}
#endif

TEST_CASE("power law friction: where the limits meet below F_0 sliding is not above sticking either") {
  // (K/mu_D)^4 = 1.6 mN, F_0 = 10 mN: on the chord 0.1 F_0^(-1/4) = 0.316 is below mu_D everywhere.
  const PowerLawFriction<double> friction({.K = 0.1, .beta = 0.75, .mu_dynamic = 0.5, .linear_below = 0.01});
  for (const double F : {1e-9, 1e-3, 1.5e-3, 5e-3, 0.1})
    CHECK(friction.sliding_limit(F) == friction.static_limit(F));
}
