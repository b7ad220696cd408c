// SPDX-License-Identifier: MIT
#include <palpate/core/lane_power.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace palpate;

namespace {
// log2 and exp2 have no loops: errors in units of epsilon are those of a few roundings, measured 1.3 and 1.5
// at most.
template <Real S, class F, class Reference>
double worst(const F& f, const Reference& reference, double from, double to, bool logarithmic) {
  using V = detail::LaneRegister<S>;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(from, to);
  double error = 0;
  std::array<S, detail::register_lanes<S>> x, y;
  for (int k = 0; k < 20000; ++k) {
    for (S& v : x) v = static_cast<S>(logarithmic ? std::exp2(uniform(random)) : uniform(random));
    detail::store_vector(y.data(), V(f(detail::load_vector<V>(x.data()))));
    for (std::size_t i = 0; i < x.size(); ++i) {
      const long double exact = reference(static_cast<long double>(x[i]));
      const long double size = logarithmic ? std::max(1.0L, std::abs(exact)) : exact;
      error = std::max(error, static_cast<double>(std::abs(static_cast<long double>(y[i]) - exact) / size));
    }
  }
  return error / static_cast<double>(std::numeric_limits<S>::epsilon());
}
}  // namespace

TEST_CASE_TEMPLATE("logarithms and powers of registers", S, float, double) {
  using V = detail::LaneRegister<S>;
  const double top = std::numeric_limits<S>::max_exponent - 1;
  const auto log2 = [](const V& x) { return detail::log2_of<S>(x); };
  const auto exp2 = [](const V& x) { return detail::exp2_of<S>(x); };
  const auto log2_exact = [](long double x) { return std::log2(x); };
  const auto exp2_exact = [](long double x) { return std::exp2(x); };
  CHECK(worst<S>(log2, log2_exact, -top + 1, top, true) < 2);
  CHECK(worst<S>(log2, log2_exact, -1, 1, true) < 2);
  CHECK(worst<S>(log2, log2_exact, -1e-3, 1e-3, true) < 2);
  CHECK(worst<S>(exp2, exp2_exact, -top + 1, top, false) < 2);
  CHECK(worst<S>(exp2, exp2_exact, -2, 2, false) < 2);

  const auto first = [](const V& x) {
    std::array<S, detail::register_lanes<S>> y;
    detail::store_vector(y.data(), x);
    return y[0];
  };
  // Whole numbers are exact, and 2^x stays within normal numbers.
  for (int n = 1 - static_cast<int>(top); n <= static_cast<int>(top); ++n) {
    REQUIRE(first(log2(detail::all_of<V>(std::ldexp(S(1), n)))) == S(n));
    REQUIRE(first(exp2(detail::all_of<V>(S(n)))) == std::ldexp(S(1), n));
  }
  CHECK(first(exp2(detail::all_of<V>(S(-1e9)))) == std::numeric_limits<S>::min());
  CHECK(first(exp2(detail::all_of<V>(S(1e9)))) == std::ldexp(S(1), static_cast<int>(top)));

  // Powers: the logarithm's error, 2 epsilon at most (above), times the exponent, and 3 roundings more; whole
  // ones by products.
  for (const S e : {S(0), S(1), S(5), S(18), S(-0.7), S(1.3), S(4.6666)}) {
    const detail::LanePower<S> power(e);
    for (S x = S(0.01); x < S(2); x *= S(1.1)) {
      const long double exact = std::pow(static_cast<long double>(x), static_cast<long double>(e));
      const double bound =
          3 + 2 * std::abs(static_cast<double>(e)) * std::max(1.0, std::abs(std::log2(double(x))));
      const long double got = static_cast<long double>(first(power.of(detail::all_of<V>(x))));
      REQUIRE(static_cast<double>(std::abs(got / exact - 1)) <
              bound * static_cast<double>(std::numeric_limits<S>::epsilon()));
      REQUIRE(static_cast<double>(std::abs(static_cast<long double>(power.of(x)) / exact - 1)) <
              bound * static_cast<double>(std::numeric_limits<S>::epsilon()));
    }
  }
}
