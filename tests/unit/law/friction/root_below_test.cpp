// SPDX-License-Identifier: MIT
#include <palpate/law/friction/detail/root_below.hpp>

#include <support/check.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace palpate;

namespace {
template <class G>
void root(double high, double expected, int most, const G& g) {
  int calls = 0;
  const double x = detail::root_below(high, [&](double t) {
    ++calls;
    return g(t);
  });
  CHECK_RELATIVE(x, expected, 4e-16 * high / expected);  // an epsilon of the bracket
  CHECK(calls <= most);
}
}  // namespace

// False position alone creeps along the flat side of these.
TEST_CASE("root below: steep powers and exponentials are found in some tens of steps") {
  root(1, 0.1, 60, [](double x) { return std::pow(x, 9) - 1e-9; });
  root(1, std::pow(1e-12, 1.0 / 21), 60, [](double x) { return std::pow(x, 21) - 1e-12; });
  root(1, 30.0 / 700, 60, [](double x) { return std::exp(700 * x) - std::exp(30); });
}

// Where nothing but halving helps: four steps for each of 52 halvings.
TEST_CASE("root below: a step is bracketed to rounding within the bound") {
  root(1, 0.3, 240, [](double x) { return x > 0.3 ? 1e30 : -1e-30; });
  root(1, 0.3, 240, [](double x) { return x > 0.3 ? 1e-30 : -1.0; });
  root(7, 2, 240, [](double x) { return x > 2 ? 1.0 : -1e-30; });
}
