// SPDX-License-Identifier: MIT
#pragma once

/// @file  How tests compare numbers. doctest's own Approx is not used: its default tolerance hides errors.

#include <palpate/core/vector.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace palpate::test {

/// |a - b| / max(|b|, floor): the relative error of a against the reference b.
template <class A, class B>
[[nodiscard]] inline long double relative_error(A a, B b, long double floor = 0) {
  const auto x = static_cast<long double>(a), y = static_cast<long double>(b);
  const long double scale = std::fmax(std::fabs(y), floor);
  return scale == 0 ? std::fabs(x - y) : std::fabs(x - y) / scale;
}

/// `factor` units in the last place of S: the unit in which a rounding tolerance is stated.
template <Real S>
[[nodiscard]] constexpr long double ulps(long double factor) {
  return factor * static_cast<long double>(std::numeric_limits<S>::epsilon());
}

}  // namespace palpate::test

/// Relative error of `value` against `reference` is at most `tolerance`. NaN fails.
#define CHECK_RELATIVE(value, reference, tolerance)                                                      \
  do {                                                                                                   \
    const auto palpate_value = (value);                                                                  \
    const auto palpate_reference = (reference);                                                          \
    const long double palpate_error = ::palpate::test::relative_error(palpate_value, palpate_reference); \
    INFO(#value " = ", palpate_value, ", reference ", palpate_reference, ", relative error ",            \
         static_cast<double>(palpate_error));                                                            \
    CHECK(palpate_error <= static_cast<long double>(tolerance));                                         \
  } while (false)

/// |value - reference| <= tolerance, in the unit of the value. NaN fails.
#define CHECK_ABSOLUTE(value, reference, tolerance)                                                       \
  do {                                                                                                    \
    const auto palpate_value = (value);                                                                   \
    const auto palpate_reference = (reference);                                                           \
    INFO(#value " = ", palpate_value, ", reference ", palpate_reference);                                 \
    CHECK(std::fabs(static_cast<long double>(palpate_value) -                                             \
                    static_cast<long double>(palpate_reference)) <= static_cast<long double>(tolerance)); \
  } while (false)
