// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/core/simd_math.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace palpate;
using palpate::test::ulps;

namespace {
// log2 and exp2 have no loops: errors in units of epsilon are those of a few roundings, measured 1.3 and 1.5
// at most.
template <Real S, class F, class Reference>
double worst(const F& f, const Reference& reference, double from, double to, bool logarithmic) {
  using V = detail::native_simd<S>;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(from, to);
  double error = 0;
  std::array<S, V::size()> x, y;
  for (int k = 0; k < 20000; ++k) {
    for (S& v : x) v = static_cast<S>(logarithmic ? std::exp2(uniform(random)) : uniform(random));
    f(V(x.data())).copy_to(y.data());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = reference(static_cast<long double>(x[i]));
      const long double size = logarithmic ? std::max(1.0L, std::abs(exact)) : exact;
      error = std::max(error, static_cast<double>(std::abs(static_cast<long double>(y[i]) - exact) / size));
    }
  }
  return error / static_cast<double>(std::numeric_limits<S>::epsilon());
}
}  // namespace

TEST_CASE_TEMPLATE("logarithms and powers", S, float, double) {
  using V = detail::native_simd<S>;
  const double top = std::numeric_limits<S>::max_exponent - 1;
  const auto log2 = [](const V& x) { return detail::log2(x); };
  const auto exp2 = [](const V& x) { return detail::exp2(x); };
  const auto log2_exact = [](long double x) { return std::log2(x); };
  const auto exp2_exact = [](long double x) { return std::exp2(x); };
  CHECK(worst<S>(log2, log2_exact, -top + 1, top, true) < 2);
  CHECK(worst<S>(log2, log2_exact, -1, 1, true) < 2);
  CHECK(worst<S>(log2, log2_exact, -1e-3, 1e-3, true) < 2);
  CHECK(worst<S>(exp2, exp2_exact, -top + 1, top, false) < 2);
  CHECK(worst<S>(exp2, exp2_exact, -2, 2, false) < 2);

  // Whole numbers are exact, and 2^x stays within normal numbers.
  for (int n = 1 - static_cast<int>(top); n <= static_cast<int>(top); ++n) {
    REQUIRE(log2(V(std::ldexp(S(1), n)))[0] == S(n));
    REQUIRE(exp2(V(S(n)))[0] == std::ldexp(S(1), n));
  }
  CHECK(exp2(V(S(-1e9)))[0] == std::numeric_limits<S>::min());
  CHECK(exp2(V(S(1e9)))[0] == std::ldexp(S(1), static_cast<int>(top)));

  // Powers: the logarithm's error, 2 epsilon at most (above), times the exponent, and 3 roundings more; whole
  // ones by products.
  for (const S e : {S(0), S(1), S(5), S(18), S(-0.7), S(1.3), S(4.6666)}) {
    const detail::Power<S> power(e);
    for (S x = S(0.01); x < S(2); x *= S(1.1)) {
      const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(e));
      const double bound =
          3 + 2 * std::abs(static_cast<double>(e)) * std::max(1.0, std::abs(std::log2(double(x))));
      const long double got = static_cast<long double>(power(V(x))[0]);
      REQUIRE(static_cast<double>(std::abs(got / exact - 1)) <
              bound * static_cast<double>(std::numeric_limits<S>::epsilon()));
      REQUIRE(static_cast<double>(std::abs(static_cast<long double>(power(x)) / exact - 1)) <
              bound * static_cast<double>(std::numeric_limits<S>::epsilon()));
    }
  }
}

TEST_CASE_TEMPLATE("sine, cosine and inverse root, of a number and of a Simd, against long double", S, float,
                   double) {
  using V = detail::native_simd<S>;
  for (int i = 0; i <= 2000; ++i) {
    const S y = S(-1.5707963267948966 + 3.1415926535897931 * i / 2000);
    S sine, cosine;
    detail::sine_and_cosine(y, sine, cosine);
    CHECK_ABSOLUTE(cosine, std::cos(static_cast<long double>(y)), ulps<S>(2));
    CHECK_ABSOLUTE(sine, std::sin(static_cast<long double>(y)), ulps<S>(2));
    V sines, cosines;
    detail::sine_and_cosine(V(y), sines, cosines);
    // A product and a sum may be one operation in one of them.
    CHECK_ABSOLUTE(cosines[V::size() - 1], cosine, ulps<S>(2));
    CHECK_ABSOLUTE(sines[V::size() - 1], sine, ulps<S>(2));

    const S x = static_cast<S>(std::pow(10.0L, (i - 1000) / 1000.0L * (sizeof(S) == 4 ? 30 : 290)));
    const long double exact = 1 / std::sqrt(static_cast<long double>(x));
    CHECK_RELATIVE(detail::inverse_sqrt(x), exact, ulps<S>(4));
    CHECK_RELATIVE(detail::inverse_sqrt(V(x))[V::size() - 1], exact, ulps<S>(4));
  }
  CHECK(is_finite(detail::inverse_sqrt(S(0))));
  CHECK(is_finite(detail::inverse_sqrt(V{})[0]));
}
