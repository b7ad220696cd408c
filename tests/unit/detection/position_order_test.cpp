// SPDX-License-Identifier: MIT

/// @file The order of points that rounding does not change.

#include <palpate/detection/detail/position_order.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <vector>

using namespace palpate;

namespace {
using V = Vec3<double>;
}

TEST_CASE("position order: coordinates that differ by rounding alone are equal, and the next axis decides") {
  const std::vector<V> points{V(0, 1, 0), V(1e-13, 0, 0), V(1, 0.5, 0.2), V(0, 1, 0)};
  const std::vector<double> areas{1, 1, 1, 2};
  const detail::PositionOrder<double> order(points, areas);
  // Along x the first two are equal; along y the second comes first.
  CHECK(order.less(1, 0, 0));
  CHECK_FALSE(order.less(0, 1, 0));
  CHECK(order.less(0, 2, 0));  // along x there is no doubt
  CHECK(order.less(2, 0, 1));
  // In one position: by area, last by number.
  CHECK(order.less(0, 3, 0));
  CHECK_FALSE(order.less(3, 0, 0));
  CHECK_FALSE(order.less(0, 0, 0));
}

TEST_CASE("position order: the longest axis is the one of the largest extent, the first of equal ones") {
  const std::vector<V> points{V(0, 0, 0), V(1, 2, 2), V(0.5, 0.5, 2.001)};
  const std::vector<double> areas{1, 1, 1};
  const detail::PositionOrder<double> order(points, areas);
  const std::array<std::uint32_t, 2> two{0, 1}, other{0, 2};
  CHECK(order.longest_axis(two) == 1);
  CHECK(order.longest_axis(other) == 2);
}
