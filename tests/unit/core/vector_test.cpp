// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/core/vector.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE(
    "length of a vector: against long double over the scalar's range, and not finite where it is not", S,
    float, double) {
  std::mt19937_64 random(3);
  INFO("seed 3");
  std::uniform_real_distribution<double> unit(-1, 1);
  using Limits = std::numeric_limits<S>;
  const int most = Limits::max_exponent - 2, least = Limits::min_exponent;
  for (int exponent = least; exponent <= most; ++exponent) {
    const Vec3<S> v = Vec3<S>(S(unit(random)), S(unit(random)), S(unit(random))) * std::ldexp(S(1), exponent);
    const auto x = static_cast<long double>(v.x()), y = static_cast<long double>(v.y()),
               z = static_cast<long double>(v.z());
    // Two epsilon, and the roundings of what is below the normal numbers.
    CHECK_ABSOLUTE(stable_norm(v), std::sqrt(x * x + y * y + z * z),
                   2 * static_cast<long double>(Limits::epsilon()) * std::sqrt(x * x + y * y + z * z) +
                       4 * static_cast<long double>(Limits::denorm_min()));
  }
  CHECK(stable_norm(Vec3<S>(Vec3<S>::Zero())) == S(0));
  CHECK(stable_norm(Vec3<S>(S(0), -Limits::denorm_min(), S(0))) == Limits::denorm_min());
  for (const S bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<S> v = Vec3<S>::Zero();
      v[axis] = bad;
      CHECK(!is_finite(stable_norm(v)));
      CHECK(!is_finite(stable_norm(Vec3<S>(v + Vec3<S>::Ones()))));
    }
  }
}

TEST_CASE_TEMPLATE(
    "length of a vector: the same bits wherever it lies, and twice as much for twice the vector", S, float,
    double) {
  std::mt19937_64 random(5);
  INFO("seed 5");
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3<S> v(S(unit(random)), S(unit(random)), S(unit(random)));
    alignas(64) std::array<Vec3<S>, 16>
        list;  // 12 or 24 bytes apart: at every position that a register may begin
    list.fill(v);
    for (const Vec3<S>& here : list) CHECK(stable_norm(here) == stable_norm(list[0]));
    CHECK(stable_norm(Vec3<S>(S(2) * v)) == S(2) * stable_norm(v));
  }
}

TEST_CASE_TEMPLATE("is_positive and is_finite: signs, zeros, the smallest, the largest, infinity and NaN", S,
                   float, double, long double) {
  using Limits = std::numeric_limits<S>;
  for (const S x : {Limits::denorm_min(), Limits::min(), S(1), Limits::max()}) {
    CHECK(is_positive(x));
    CHECK_FALSE(is_positive(-x));
    CHECK(is_finite(x));
    CHECK(is_finite(-x));
  }
  for (const S zero : {S(0), S(-0.0)}) {
    CHECK_FALSE(is_positive(zero));
    CHECK(is_finite(zero));
  }
  CHECK(is_positive(Limits::infinity()));
  CHECK_FALSE(is_positive(-Limits::infinity()));
  CHECK_FALSE(is_positive(Limits::quiet_NaN()));
  for (const S bad : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()})
    CHECK_FALSE(is_finite(bad));
}
