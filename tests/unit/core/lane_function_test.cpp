// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/core/lane_group.hpp>
#include <palpate/core/lane_sine.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace palpate;
using palpate::test::ulps;

namespace {
template <Real S>
std::array<S, detail::register_lanes<S>> entries(const detail::LaneRegister<S>& x) {
  std::array<S, detail::register_lanes<S>> result;
  detail::store_vector(result.data(), x);
  return result;
}
}  // namespace

TEST_CASE_TEMPLATE("sine, cosine and inverse root, of numbers and of registers, against long double", S,
                   float, double) {
  using V = detail::LaneRegister<S>;
  for (int i = 0; i <= 2000; ++i) {
    const S y = S(-1.5707963267948966 + 3.1415926535897931 * i / 2000);
    S sine, cosine;
    detail::sine_and_cosine<S>(y, sine, cosine);
    CHECK_ABSOLUTE(cosine, std::cos(static_cast<long double>(y)), ulps<S>(2));
    CHECK_ABSOLUTE(sine, std::sin(static_cast<long double>(y)), ulps<S>(2));
    V sines, cosines;
    detail::sine_and_cosine<S>(detail::all_of<V>(y), sines, cosines);
    // A product and a sum may be one operation in one of them.
    CHECK_ABSOLUTE(entries<S>(cosines).back(), cosine, ulps<S>(2));
    CHECK_ABSOLUTE(entries<S>(sines).back(), sine, ulps<S>(2));

    const S x = static_cast<S>(std::pow(10.0L, (i - 1000) / 1000.0L * (sizeof(S) == 4 ? 30 : 290)));
    const long double exact = 1 / std::sqrt(static_cast<long double>(x));
    CHECK_RELATIVE(detail::inverse_root(x), exact, ulps<S>(4));
    CHECK_RELATIVE(entries<S>(detail::inverse_root(detail::all_of<V>(x))).back(), exact, ulps<S>(4));
  }
  CHECK(is_finite(detail::inverse_root(S(0))));
  CHECK(is_finite(entries<S>(detail::inverse_root(V{})).front()));
}

TEST_CASE_TEMPLATE("extremes and tests of registers", S, float, double) {
  using V = detail::LaneRegister<S>;
  constexpr std::size_t n = detail::register_lanes<S>;
  std::array<S, n> a, b;
  for (std::size_t i = 0; i < n; ++i) {
    a[i] = S(i) - S(1);
    b[i] = S(1) - S(i);
  }
  const V x = detail::load_register(a.data()), y = detail::load_register(b.data());
  const auto low = entries<S>(detail::smaller(x, y)), high = entries<S>(detail::larger(x, y));
  for (std::size_t i = 0; i < n; ++i) {
    CHECK(low[i] == std::min(a[i], b[i]));
    CHECK(high[i] == std::max(a[i], b[i]));
    std::array<S, n> one{};
    one[i] = S(1);
    CHECK(detail::any<S>(detail::load_register(one.data()) > V{}));  // whichever entry it is
  }
  CHECK(!detail::any<S>(V{} > V{}));
}

TEST_CASE_TEMPLATE("a group of registers: every entry is what the formula gives for a number", S, float,
                   double) {
  using V = detail::LaneGroup<S>;
  std::array<S, V::lanes> a, b, result;
  for (std::size_t i = 0; i < V::lanes; ++i) {
    a[i] = S(1) + S(i) / S(8);
    b[i] = S(3) - S(i) / S(4);  // all of these, their sums and products are exact
  }
  const V x(a.data()), y(b.data());
  const detail::LaneFactor<S> two = detail::lane_factor(S(2));
  const auto check = [&](const V& group, const auto& expected) {
    group.store(result.data());
    for (std::size_t i = 0; i < V::lanes; ++i) CHECK(result[i] == expected(a[i], b[i]));
  };
  check(x + y, [](S p, S q) { return p + q; });
  check(x - y * two, [](S p, S q) { return p - q * S(2); });
  check(two - x * y, [](S p, S q) { return S(2) - p * q; });
  check(S(0.5) * x - S(1), [](S p, S) { return S(0.5) * p - S(1); });
  check(y / x, [](S p, S q) { return q / p; });
  check(S(1) / x, [](S p, S) { return S(1) / p; });
  check(-y, [](S, S q) { return -q; });
  check(larger(x, y), [](S p, S q) { return std::max(p, q); });
  check(smaller(x, y), [](S p, S q) { return std::min(p, q); });
  check(V{}, [](S, S) { return S(0); });
  auto sum = a;
  detail::add_group(sum.data(), y);
  for (std::size_t i = 0; i < V::lanes; ++i) {
    CHECK(sum[i] == a[i] + b[i]);
    std::array<S, V::lanes> one{};
    CHECK(!any_positive(V(one.data())));
    one[i] = S(1);
    CHECK(any_positive(V(one.data())));  // whichever entry it is
    CHECK(!any_positive(-V(one.data())));
  }
}
