// SPDX-License-Identifier: MIT
#include <palpate/elasticity/point_load.hpp>

#include "support/check.hpp"

#include <random>

namespace {
using namespace palpate;
using V = Vec3<double>;
constexpr double pi = std::numbers::pi;
}  // namespace

TEST_CASE("point load: traction is the stress of the displacement, and none on the free plane") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (double nu : {0.0, 0.3, 0.45}) {
    const V r(unit(random), unit(random), 0.4 + std::abs(unit(random))),
        n = V(unit(random), unit(random), unit(random)).normalized(), m = V::UnitZ();
    const double h = 1e-5;
    Mat3<double> expected;
    for (int k = 0; k < 3; ++k) {
      Mat3<double> G;
      for (int j = 0; j < 3; ++j)
        G.col(j) = (point_load<double>(r + h * V::Unit(j), m, V::Unit(k), nu) -
                    point_load<double>(r - h * V::Unit(j), m, V::Unit(k), nu)) /
                   (8 * pi * h);
      expected.col(k) = (G + G.transpose()) * n + 2 * nu / (1 - 2 * nu) * G.trace() * n;
    }
    // Central differences with h = 1e-5: 1e-9.
    CHECK_ABSOLUTE((point_load_traction(r, m, n, nu) - expected).norm() / expected.norm(), 0.0, 1e-7);
    const Mat3<double> free = point_load_traction(V(r.x(), r.y(), 0), m, -m, nu);
    CHECK_ABSOLUTE(free.norm(), 0.0, 1e-12);
  }
}
