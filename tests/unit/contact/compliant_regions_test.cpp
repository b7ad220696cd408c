// SPDX-License-Identifier: MIT
#include <palpate/contact/coupling.hpp>
#include <palpate/contact/detail/tool_patches.hpp>
#include <palpate/core/error.hpp>

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <support/check.hpp>

#include <numbers>
#include <random>
#include <vector>

using namespace palpate;
using V = Vec3<double>;
using detail::ToolPatches;

namespace {

constexpr double a = 3e-3, A_0 = std::numbers::pi * a * a;

/// Points of discs of radius `radius` in y = 0, `spacing` apart, each with the same area.
ToolPoints<double> discs(const std::vector<V>& centres, double radius = a, double spacing = a / 5) {
  std::vector<V> points;
  const int n = static_cast<int>(radius / spacing);
  for (const V& c : centres) {
    for (int i = -n; i <= n; ++i)
      for (int k = -n; k <= n; ++k)
        if (std::hypot(i, k) * spacing <= radius) points.push_back(c + spacing * V(i, 0, k));
  }
  const double area = std::numbers::pi * radius * radius * static_cast<double>(centres.size()) /
                      static_cast<double>(points.size());
  return ToolPoints<double>(points, std::vector<double>(points.size(), area), {.contact_area = A_0});
}
ToolPatches patches(const ToolPoints<double>& tool, double distance = a / 4, bool cuts = true) {
  return {HalfSpaceCompliance{}, tool, ProximityGraph<double>(tool, distance), cuts};
}
Eigen::MatrixXd matrix(const ToolPatches& of) {
  const auto n = static_cast<Eigen::Index>(of.size());
  Eigen::MatrixXd R(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index k = 0; k < n; ++k) R(j, k) = of.ratio(std::size_t(j), std::size_t(k));
  return R;
}
double least_eigenvalue(const ToolPatches& of) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix(of)).eigenvalues().minCoeff();
}

struct Wild {
  double value;
  double ratio(double, double) const noexcept { return value; }
};

}  // namespace

TEST_CASE("half-space: the ratio is the flat punch's surface, and what elasticity takes at 12 and 20 mm") {
  const HalfSpaceCompliance half;
  CHECK(half.ratio(0, a) == 1);
  for (const double r : {3.0, 4.0, 6.0, 10.0, 30.0}) {
    const double punch = 2 / std::numbers::pi * std::asin(1 / r);
    // The next term of both series is of third order: (a/r)^3 (1/6 + 2/pi^2) (2/pi).
    CHECK_ABSOLUTE(half.ratio(r * a, a), punch, 0.24 / (r * r * r));
  }
  // Two patches pressed alike lose R/(1 + R) of what each has alone.
  const auto taken = [&](double r) { return half.ratio(r, a) / (1 + half.ratio(r, a)); };
  CHECK_ABSOLUTE(taken(12e-3), 0.14, 0.005);  // both are known to two digits
  CHECK_ABSOLUTE(taken(20e-3), 0.09, 0.005);
}

TEST_CASE("half-space: the ratio is positive definite for any patches in space") {
  std::mt19937_64 random(34);
  std::uniform_real_distribution<double> along(-0.02, 0.02);
  for (int round = 0; round < 50; ++round) {
    std::vector<V> centres;
    for (int k = 0; k < 20; ++k) centres.emplace_back(along(random), along(random), along(random));
    Eigen::MatrixXd R(20, 20);
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 20; ++k)
        R(j, k) = HalfSpaceCompliance{}.ratio((centres[std::size_t(j)] - centres[std::size_t(k)]).norm(), a);
    CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(R).eigenvalues().minCoeff() > 0);
  }
}

TEST_CASE("patches: a pin's tip is one, and pins have the half-space's ratio of their distance") {
  const auto two = patches(discs({V(-5e-3, 0, 0), V(5e-3, 0, 0)}));
  REQUIRE(two.size() == 2);
  CHECK_RELATIVE(two.ratio(0, 1), HalfSpaceCompliance{}.ratio(10e-3, a), 1e-12);  // centres of sums of 80
  CHECK(patches(discs({V::Zero()}, 1.25 * a)).size() == 1);  // 2.5 a across, as a square of area A_0
  const auto small = patches(discs({V(-5e-3, 0, 0), V(5e-3, 0, 0)}, a / 2, a / 8));
  REQUIRE(small.size() == 2);
  CHECK_RELATIVE(small.ratio(0, 1), HalfSpaceCompliance{}.ratio(10e-3, a) / 4,
                 1e-12);  // a quarter of A_0 each
}

TEST_CASE("patches: what lies within the nominal contact area is not coupled; a wide face is, far apart") {
  const auto face = discs({V::Zero()}, 5 * a);
  const auto cut = patches(face);
  CHECK(cut.size() > 10);
  CHECK(patches(face, a / 4, false).size() == 1);
  CHECK(cut.size() < ToolPatches::max_patches);
  std::vector<V> centre(cut.size(), V::Zero());
  std::vector<double> count(cut.size(), 0);
  for (std::size_t i = 0; i < face.size(); ++i) centre[cut.of(i)] += face.point(i), ++count[cut.of(i)];
  bool has_far = false;
  for (std::size_t j = 0; j < cut.size(); ++j) {
    for (std::size_t k = 0; k < j; ++k) {
      const double r = (centre[j] / count[j] - centre[k] / count[k]).norm();
      if (r < 2 * a) CHECK(cut.ratio(j, k) == 0);
      if (r > 3 * a) CHECK(cut.ratio(j, k) > 0);
      has_far = has_far || r > 3 * a;
    }
  }
  CHECK(has_far);
  CHECK(least_eigenvalue(cut) >= 1e-3);
}

TEST_CASE("patches: many parts and wide tools stay within 64 patches, every point has one, R is definite") {
  std::vector<V> brush;
  for (int i = 0; i < 100; ++i) brush.emplace_back(4 * a * (i % 10), 0, 4 * a * (i / 10));
  for (const ToolPoints<double>& tool : {discs(brush, a, a / 2), discs({V::Zero()}, 40 * a, a),
                                         discs({V::Zero(), V(1e-4, 0, 0)}, a / 5, a / 9)}) {
    const auto of = patches(tool, 1.2 * a);
    CHECK(of.size() <= ToolPatches::max_patches);
    for (std::size_t i = 0; i < tool.size(); ++i) CHECK(of.of(i) < of.size());
    CHECK(least_eigenvalue(of) >= 0.999e-3);
    CHECK(matrix(of).minCoeff() >= 0);
  }
}

TEST_CASE("patches: factors are within 0 and 1, and 1 where nothing else presses") {
  const auto of = patches(discs({V(-5e-3, 0, 0), V(5e-3, 0, 0), V(0, 0, 8e-3)}));
  REQUIRE(of.size() == 3);
  ToolPatches::List energy{}, factor{};
  energy[1] = 2e-3;
  of.relieve(energy, factor);
  for (std::size_t j = 0; j < 3; ++j) CHECK(factor[j] == 1);
  std::mt19937_64 random(35);
  std::uniform_real_distribution<double> exponent(-12, 0);
  for (int round = 0; round < 1000; ++round) {
    for (std::size_t j = 0; j < 3; ++j) energy[j] = std::pow(10, exponent(random));
    of.relieve(energy, factor);
    for (std::size_t j = 0; j < 3; ++j) {
      CHECK(factor[j] >= 0);
      CHECK(factor[j] <= 1);
    }
  }
}

TEST_CASE("patches: a ratio below 0, above 1 or NaN is refused at set-up") {
  const auto tool = discs({V(-5e-3, 0, 0), V(5e-3, 0, 0)});
  const ProximityGraph<double> graph(tool, a / 4);
  for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(ToolPatches(Wild{bad}, tool, graph, true), SetupError);
  // Fully coupled: not definite, and so a little less.
  const ToolPatches stiff(Wild{1}, tool, graph, true);
  CHECK(stiff.ratio(0, 1) < 1);
  CHECK(stiff.ratio(0, 1) >= 0.9);
}
