// SPDX-License-Identifier: MIT
#include <palpate/core/complementarity.hpp>

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <limits>
#include <random>
#include <vector>

using palpate::detail::solve_complementarity;

namespace {

constexpr std::uint64_t seed = 34;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A compliance: positive definite with unit diagonal; `pulls`: some entries below 0.
Matrix random_matrix(std::mt19937_64& random, int n, bool pulls) {
  std::normal_distribution<double> normal;
  Matrix B(n, n + 1);
  for (int i = 0; i < B.size(); ++i) B.data()[i] = pulls ? normal(random) : std::abs(normal(random));
  Matrix M = B * B.transpose() + 0.02 * n * Matrix::Identity(n, n);
  const Vector d = M.diagonal().cwiseSqrt().cwiseInverse();
  return d.asDiagonal() * M * d.asDiagonal();
}
Vector random_vector(std::mt19937_64& random, int n) {
  std::normal_distribution<double> normal(0.3, 1);
  Vector q(n);
  for (double& each : q) each = normal(random);
  return q;
}

/// M(i, j) as the solver asks for it.
auto entries(const Matrix& M) {
  return [&M](std::size_t i, std::size_t j) { return M(Eigen::Index(i), Eigen::Index(j)); };
}

template <std::size_t N = 64>
Vector solved(const Matrix& M, const Vector& q, bool& ok) {
  std::array<double, N> b{}, x{};
  const auto n = static_cast<std::size_t>(q.size());
  for (std::size_t i = 0; i < n; ++i) b[i] = q[Eigen::Index(i)];
  ok = solve_complementarity<N>(entries(M), b, n, x);
  return Eigen::Map<const Vector>(x.data(), q.size());
}

/// Every set of free rows is tried.
Vector by_trying_all(const Matrix& M, const Vector& q) {
  const int n = static_cast<int>(q.size());
  for (int set = 0; set < 1 << n; ++set) {
    std::vector<int> free;
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) free.push_back(i);
    Vector x = Vector::Zero(n);
    if (!free.empty()) {
      const Vector part = M(free, free).ldlt().solve(q(free));
      for (std::size_t a = 0; a < free.size(); ++a) x[free[a]] = part[Eigen::Index(a)];
    }
    if (x.minCoeff() >= 0 && (M * x - q).minCoeff() >= -1e-13) return x;
  }
  return Vector::Constant(n, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

TEST_CASE("complementarity: one to eight rows as by trying all sets of free ones") {
  std::mt19937_64 random(seed);
  double worst = 0;
  for (int n = 1; n <= 8; ++n) {
    for (int round = 0; round < 100; ++round) {
      const Matrix M = random_matrix(random, n, round % 2 == 1);
      const Vector q = random_vector(random, n);
      bool ok = false;
      const Vector x = solved(M, q, ok);
      REQUIRE(ok);
      worst = (std::max)(worst, (x - by_trying_all(M, q)).norm() / q.norm());
    }
  }
  CHECK(worst <= 1e-11);  // the tolerance on signs, 1e-12, times the condition number, some tens
}

TEST_CASE("complementarity: up to 64 rows meet the three conditions, without heap") {
  std::mt19937_64 random(seed + 1);
  for (int n = 9; n <= 64; n += 5) {
    for (int round = 0; round < 40; ++round) {
      const Matrix M = random_matrix(random, n, round % 2 == 1);
      const Vector q = random_vector(random, n);
      bool ok = false;
      const palpate::test::HeapCount heap;
      const Vector x = solved(M, q, ok);
      REQUIRE(ok);
      CHECK(heap.allocations() <= 1);  // the returned Vector
      const Vector w = M * x - q;
      const double size = q.maxCoeff();
      CHECK(x.minCoeff() >= 0);
      CHECK(w.minCoeff() >= -1e-11 * size);  // the solver's 1e-12 and the rounding of 64 products
      CHECK(std::abs(x.dot(w)) <= 1e-9 * size * size * n);  // w of free rows is rounding times condition
    }
  }
}

TEST_CASE("complementarity: continuous where rows become free and are held again, degenerate rows included") {
  std::mt19937_64 random(seed + 2);
  for (int round = 0; round < 20; ++round) {
    const int n = 6;
    const Matrix M = random_matrix(random, n, round % 2 == 1);
    const Vector from = random_vector(random, n), to = random_vector(random, n);
    const double stiffness = 1 / M.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
    bool ok = false;
    Vector before = solved(M, from, ok);
    for (int i = 1; i <= 2000; ++i) {
      const Vector now = solved(M, from + (to - from) * (i / 2000.0), ok);
      REQUIRE(ok);
      // x is Lipschitz in q with the reciprocal of the least eigenvalue.
      CHECK((now - before).norm() <= 1.0001 * stiffness * (to - from).norm() / 2000);
      before = now;
    }
  }
  // Rows that just touch: x = 0 and w = 0.
  Matrix M = Matrix::Identity(3, 3);
  M(0, 1) = M(1, 0) = 0.5;
  bool ok = false;
  CHECK(solved(M, Vector{{1, 0.5, 0}}, ok) == Vector{{1, 0, 0}});
  CHECK(ok);
}

TEST_CASE("complementarity: a matrix that is not definite or not finite is refused; x is never below 0") {
  Matrix M = Matrix::Ones(2, 2);
  M(0, 1) = M(1, 0) = 2;
  bool ok = true;
  CHECK(solved(M, Vector{{1, 1}}, ok).minCoeff() >= 0);
  CHECK(!ok);
  M(0, 0) = std::numeric_limits<double>::quiet_NaN();
  ok = true;
  CHECK(solved(M, Vector{{1, 1}}, ok).minCoeff() >= 0);
  CHECK(!ok);
}

TEST_CASE(
    "complementarity: a row that is held is 0 whatever stood there, and small right sides are as good as "
    "large") {
  Matrix M(2, 2);
  M << 1, 0.9, 0.9, 1;  // the second row is within the first one's dent
  for (const double size : {1e-30, 1e-7, 1.0, 1e20}) {
    std::array<double, 2> x{7, 7};
    CHECK(solve_complementarity(entries(M), std::array<double, 2>{size, 0.5 * size}, 2, x));
    CHECK_RELATIVE(x[0], size, 1e-15);
    CHECK(x[1] == 0);
    x = {7, 7};
    CHECK(solve_complementarity(entries(M), std::array<double, 2>{size, -size}, 2, x));
    CHECK(x[1] == 0);
  }
}
