// SPDX-License-Identifier: MIT
#pragma once

/// @file  What the tests of the solver press on what.

#include <support/solvers.hpp>

#include <vector>

namespace palpate::test {

using V = Vec3<double>;

inline const DuffingForce<double> law({.c1 = 40, .c3 = 3e8});
inline const CoulombFriction<double> dry({.mu_static = 0.5, .mu_dynamic = 0.3});
inline const Ellipsoid<double> egg({.axes = V(0.06, 0.04, 0.04)});
inline const Box<double> block({.half = V(0.05, 0.02, 0.05)});

inline Pose<double> at(double x, double y, double z) {
  Pose<double> X;
  X.translation = V(x, y, z);
  return X;
}

/// A flat square face of n x n points, `spacing` [m] apart, facing down.
inline ToolPoints<double> face(int n, double spacing, double contact_area) {
  std::vector<V> points;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      points.emplace_back(spacing * (i - 0.5 * (n - 1)), 0, spacing * (j - 0.5 * (n - 1)));
  return ToolPoints<double>(points, std::vector<double>(points.size(), spacing * spacing),
                            {.contact_area = contact_area, .centre_of_mass = V(0, 0.03, 0)});
}

}  // namespace palpate::test
