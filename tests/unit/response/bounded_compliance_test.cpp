// SPDX-License-Identifier: MIT
#include <palpate/response/tick/bounded_compliance.hpp>
#include <palpate/response/tick/stages.hpp>

#include "support/check.hpp"

#include <random>

namespace {
using namespace palpate;

template <int N>
using Square = Eigen::Matrix<double, N, N>;

// Columns: N perpendicular unit vectors (Gram and Schmidt, twice).
template <int N>
Square<N> turned(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Square<N> Q;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) Q(j, i) = normal(random);
    for (int pass = 0; pass < 2; ++pass)
      for (int j = 0; j < i; ++j) Q.col(i) -= Q.col(j).dot(Q.col(i)) * Q.col(j);
    Q.col(i).normalize();
  }
  return Q;
}

// Largest difference between what is bounded and the eigenvalues bounded one by one, over the largest
// eigenvalue.
template <int N>
double worst_of_known(int tries) {
  std::mt19937 random(N);
  std::uniform_real_distribution<double> size(-1, 1);
  double worst = 0;
  for (int k = 0; k < tries; ++k) {
    const Square<N> Q = turned<N>(random);
    Eigen::Matrix<double, N, 1> lambda, kept;
    for (int i = 0; i < N; ++i) lambda[i] = k % 3 == 0 ? std::pow(10, 6 * size(random)) : size(random);
    if (k % 2 == 0) lambda[1] = lambda[0];  // vectors that are not unique
    const double least = 0.2 * lambda.cwiseAbs().maxCoeff();
    for (int i = 0; i < N; ++i) kept[i] = (std::max)(std::abs(lambda[i]), least);
    Square<N> C = Q * lambda.asDiagonal() * Q.transpose();
    C = (0.5 * (C + C.transpose())).eval();
    detail::bound_below(C, least);
    const Square<N> expected = Q * kept.asDiagonal() * Q.transpose();
    worst = (std::max)(worst, (C - expected).cwiseAbs().maxCoeff() / lambda.cwiseAbs().maxCoeff());
  }
  return worst;
}
}  // namespace

TEST_CASE("bounded compliance: eigenvalues one by one, whatever their vectors") {
  // The rotations stop at 1e-9 of the diagonal.
  CHECK(worst_of_known<3>(300) < 1e-8);
  CHECK(worst_of_known<5>(300) < 1e-8);
  CHECK(worst_of_known<12>(300) < 1e-8);
}

TEST_CASE("bounded compliance: to the bit what it was where nothing is too small; diagonal; not a number") {
  std::mt19937 random(1);
  const Square<5> Q = turned<5>(random);
  Eigen::Matrix<double, 5, 1> lambda;
  lambda << 1, 2, 3, 4, 5;
  const Square<5> C = Q * lambda.asDiagonal() * Q.transpose();
  Square<5> bounded = C;
  detail::bound_below(bounded, 0.5);
  CHECK(bounded == C);

  Mat3<double> diagonal = Vec3<double>(4, -3, 0).asDiagonal();
  detail::bound_below(diagonal, 1.0);
  CHECK(diagonal == Mat3<double>(Vec3<double>(4, 3, 1).asDiagonal()));

  Mat3<double> none = Mat3<double>::Constant(std::numeric_limits<double>::quiet_NaN());
  detail::bound_below(none, 1.0);  // ends
  CHECK(!(none(0, 0) == none(0, 0)));
}

TEST_CASE("the size of two displacements is the sum of their sizes, whatever their signs") {
  for (const double dipole : {3.0, -3.0})
    CHECK(detail::size_of_both(2, dipole, 4, Vec3<double>(0, -3, 4)) == 26);
}

TEST_CASE("smooth limit: its series and its roots agree with the power to the last digit") {
  for (double size2 = 1e-4; size2 < 100; size2 *= 1.01) {
    const long double exact = std::pow(1 + std::pow(static_cast<long double>(size2 / 3), 4), -0.125L);
    CHECK_ABSOLUTE(detail::smooth_limit(size2, 3), double(exact), test::ulps<double>(2));
  }
}
