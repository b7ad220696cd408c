// SPDX-License-Identifier: MIT
#include "support/check.hpp"

#include <palpate/luo_xiao/detail/local_shape.hpp>
#include <palpate/luo_xiao/neighbourhood.hpp>

#include <doctest/doctest.h>

#include <array>

using namespace palpate;
using palpate::test::ulps;

TEST_CASE_TEMPLATE("factor by area: 1 up to the reference, then 1/(1 + ln(A/A_ref))", S, float, double) {
  const AreaNeighbourhood<S> n({.reference_area = S(2e-6)});
  ContactDisplacement<S> c;
  for (const double ratio : {0.0, 1e-9, 0.5, 1.0}) {
    c.area = S(2e-6 * ratio);
    CHECK(n.factor(c) == S(1));
  }
  for (const double ratio : {1.0000001, 2.0, 2.718281828459045, 10.0, 1e6}) {
    c.area = S(2e-6) * S(ratio);
    const long double exact =
        1.0L / (1 + std::log(static_cast<long double>(c.area) / static_cast<long double>(S(2e-6))));
    CHECK_RELATIVE(n.factor(c), exact, ulps<S>(4));  // one division, one logarithm, one more division
  }
  CHECK_RELATIVE(n.factor([&] {
    c.area = S(2e-6) * S(2.718281828459045);
    return c;
  }()),
                 0.5, ulps<S>(4));
}

TEST_CASE("factor by count: the paper's w = 1/(1 + ln n)") {
  const CountNeighbourhood<double> n({.radius = 0.01});
  ContactDisplacement<double> c;
  for (const double points : {1.0, 2.0, 10.0, 1000.0}) {
    c.points = points;
    CHECK_RELATIVE(n.factor(c), 1.0L / (1 + std::log(static_cast<long double>(points))), ulps<double>(4));
  }
  c.points = 0;
  CHECK(n.factor(c) == 1.0);
  CHECK(n.radius(c) == 0.01);
}

TEST_CASE("the printed form has the same w and R; a user chooses it by name") {
  using Paper = Printed<CountNeighbourhood<double>>;
  static_assert(Paper::form == NeighbourhoodForm::printed);
  static_assert(CountNeighbourhood<double>::form == NeighbourhoodForm::tool_face);
  const CountNeighbourhood<double> n({.radius = 0.01});
  const Paper printed({.radius = 0.01});
  ContactDisplacement<double> c;
  c.points = 7;
  CHECK(printed.factor(c) == n.factor(c));
  CHECK(printed.radius(c) == n.radius(c));
  CHECK_THROWS_WITH(Paper({.radius = -2}), "CountNeighbourhood: radius [m] must be >= 0, got -2");
}

TEST_CASE("radius: as given, else twice the region's") {
  ContactDisplacement<double> c;
  c.area = 3.14159265358979323846e-6;
  CHECK_RELATIVE(AreaNeighbourhood<double>({}).radius(c), 2e-3, ulps<double>(4));
  CHECK(AreaNeighbourhood<double>({.radius = 0.004}).radius(c) == 0.004);
  c.area = 0;
  CHECK(AreaNeighbourhood<double>({}).radius(c) == 0.0);
}

TEST_CASE_TEMPLATE("under the tool's face a vertex ends on the face, at whatever height it began", S, float,
                   double) {
  // A face of radius 10 mm pressed 4 mm into a level surface at y = 0.
  const S depth = S(4e-3), flat = S(10e-3), rho = S(9.9e-3);
  const detail::LocalShape<S, NeighbourhoodForm::tool_face> shape{
      .target = Vec3<S>(0, -depth, 0), .depth = depth, .flat = flat, .radius = S(20e-3)};
  constexpr std::size_t count = detail::simd_group<S>::size();
  std::array<std::array<S, count>, 3> rest{};
  for (std::size_t i = 0; i < count; ++i) {  // from just above the face's end to as high above the surface
    rest[0][i] = rho;
    rest[1][i] = depth * (S(1.9) * static_cast<S>(i) / static_cast<S>(count) - S(0.9));
  }
  auto x = rest;
  shape.apply({rest[0].data(), rest[1].data(), rest[2].data()}, count,
              {x[0].data(), x[1].data(), x[2].data()});
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(x[0][i] == rho);
    if (rest[1][i] <= S(0)) CHECK_ABSOLUTE(x[1][i], -depth, ulps<S>(8) * static_cast<long double>(depth));
    // Above the surface, as a bulge is, it goes down by as much as the surface.
    if (rest[1][i] > S(0))
      CHECK_ABSOLUTE(x[1][i], rest[1][i] - depth, ulps<S>(8) * static_cast<long double>(depth));
  }
}

TEST_CASE("areas that are not finite or negative: no reduction") {
  const AreaNeighbourhood<double> n({});
  ContactDisplacement<double> c;
  for (const double area :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    c.area = area;
    CHECK(n.factor(c) == 1.0);
    CHECK(n.radius(c) == 0.0);
  }
}

TEST_CASE("set-up refuses what cannot be") {
  CHECK_THROWS_WITH(AreaNeighbourhood<double>({.reference_area = 0}),
                    "AreaNeighbourhood: reference_area [m^2] must be > 0, got 0");
  CHECK_THROWS_WITH(AreaNeighbourhood<double>({.radius = -1}),
                    "AreaNeighbourhood: radius [m] must be >= 0, got -1");
  CHECK_THROWS_WITH(CountNeighbourhood<double>({.radius = -2}),
                    "CountNeighbourhood: radius [m] must be >= 0, got -2");
}
