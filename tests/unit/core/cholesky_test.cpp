// SPDX-License-Identifier: MIT
#include <palpate/core/cholesky.hpp>

#include "support/check.hpp"

#include <Eigen/Core>

#include <cmath>

TEST_CASE("one factor, several right sides; what is not positive definite is refused") {
  using System = palpate::detail::SpdSystem<4>;
  // Hilbert's matrix: its inverse consists of whole numbers.
  const double inverse[3][3] = {{9, -36, 30}, {-36, 192, -180}, {30, -180, 180}};
  System hilbert{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c <= r; ++c) hilbert.at(r, c) = 1.0 / double(r + c + 1);
  System once = hilbert;
  REQUIRE(hilbert.factor(3));
  for (std::size_t column = 0; column < 3; ++column) {
    hilbert.b = once.b = {};
    hilbert.b[column] = once.b[column] = 1;
    hilbert.substitute(3);
    System again = once;
    REQUIRE(again.solve(3));
    for (std::size_t r = 0; r < 3; ++r) {
      // Its condition is 524: 1e-13 of the largest entry.
      CHECK_ABSOLUTE(hilbert.b[r], inverse[column][r], 192 * 1e-13);
      CHECK(hilbert.b[r] == again.b[r]);
    }
  }
  // The same as a matrix of that size; its pivots are 1, 1/12 and 1/180.
  Eigen::Matrix3d matrix, inverted;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) matrix(r, c) = 1.0 / (r + c + 1);
  palpate::detail::SpdSystem<3> whole;
  whole.set(matrix);
  REQUIRE(whole.factor(3));
  CHECK_RELATIVE(whole.pivot_ratio(), 1.0 / 180, 1e-13);  // as above
  whole.invert(inverted);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) CHECK_ABSOLUTE(inverted(r, c), inverse[r][c], 192 * 1e-13);

  System indefinite = once;
  indefinite.at(2, 2) = 0;
  CHECK(!indefinite.factor(3));
  indefinite.at(2, 2) = std::nan("");
  CHECK(!indefinite.solve(3));
}
