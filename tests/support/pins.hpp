// SPDX-License-Identifier: MIT
#pragma once

/// @file  Pins with flat tips, for tests of what contacts do to each other.

#include <palpate/detection/tool_points.hpp>

#include <numbers>
#include <vector>

namespace palpate::test {

/// Pins of radius a [m] with flat tips in y = 0, at these positions along x [m]; the nominal contact area is
/// one pin's.
inline ToolPoints<double> pins(double a, const std::vector<double>& at) {
  std::vector<Vec3<double>> points;
  for (const double x : at)
    for (int i = -5; i <= 5; ++i)
      for (int k = -5; k <= 5; ++k)
        if (i * i + k * k <= 25) points.emplace_back(x + a / 5 * i, 0, a / 5 * k);
  const double area = std::numbers::pi * a * a * double(at.size()) / double(points.size());
  return ToolPoints<double>(points, std::vector<double>(points.size(), area),
                            {.contact_area = std::numbers::pi * a * a});
}

}  // namespace palpate::test
