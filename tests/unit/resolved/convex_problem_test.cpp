// SPDX-License-Identifier: MIT
// The solve for pressures alone, on a few points whose answer is known.
#include <palpate/resolved/detail/convex_problem.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <array>

using namespace palpate;

namespace {

constexpr std::size_t n = 6;
constexpr std::array<float, n> own{1, 20, 40, 60, 80, 100};

// Points with a compliance of their own each, and a common one.
void apply(const float* q, float* y) {
  float sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += q[i];
  for (std::size_t i = 0; i < n; ++i) y[i] = own[i] * q[i] + 0.1f * sum;
}

detail::Remainder solve(detail::PressureLists& lists, const std::array<float, n>& q) {
  std::array<float, n> d{};
  apply(q.data(), d.data());
  lists.resize(n);
  for (std::size_t i = 0; i < n; ++i) lists.q[i] = 0;
  return detail::solve_pressures(n, lists, d.data(), 1e-3f, 100, apply);
}

}  // namespace

TEST_CASE("pressures: as many conjugate directions as points, however different their compliance") {
  detail::PressureLists lists;
  const auto result = solve(lists, {1, 1, 1, 1, 1, 1});
  CHECK(result.norm <= 1e-3f);
  // One step in which the points come in, n directions, and two for what rounding leaves of them. Steepest
  // descent at a ratio of 100 takes hundreds.
  CHECK(result.iterations <= static_cast<int>(n) + 3);
  // The norm over the least compliance, and the rounding of displacements of 100.
  for (std::size_t i = 0; i < n; ++i) CHECK_ABSOLUTE(lists.q[i], 1, 1e-3 + test::ulps<float>(200));
}
