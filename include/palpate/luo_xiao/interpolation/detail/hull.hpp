// SPDX-License-Identifier: MIT
#pragma once

/// @file  The flat facets of the convex hull of a few points on the unit sphere. Set-up only.

#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

using Polygon = std::vector<std::uint32_t>;  // corners, counter-clockwise seen from outside

/// The corners of one facet in order of their angle about the facet's normal, lowest index first.
inline Polygon ordered_facet(std::span<const Vec3<double>> points, std::uint64_t members,
                             const Vec3<double>& normal) {
  const Vec3<double> u = perpendicular(normal), v = normal.cross(u);
  Vec3<double> middle = Vec3<double>::Zero();
  Polygon polygon;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if ((members >> i & 1u) == 0) continue;
    polygon.push_back(i);
    middle += points[i];
  }
  middle /= static_cast<double>(polygon.size());
  const auto angle = [&](std::uint32_t i) {
    const Vec3<double> r = points[i] - middle;
    return std::atan2(r.dot(v), r.dot(u));
  };
  std::sort(polygon.begin(), polygon.end(),
            [&](std::uint32_t a, std::uint32_t b) { return angle(a) < angle(b); });
  std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  return polygon;
}

/// True when the polygons close up: every directed edge once, and once the other way.
inline bool is_closed(std::span<const Polygon> facets, std::size_t points) {
  std::vector<int> uses(points * points, 0);
  for (const Polygon& facet : facets) {
    for (std::size_t k = 0; k < facet.size(); ++k) ++uses[facet[k] * points + facet[(k + 1) % facet.size()]];
  }
  for (std::size_t a = 0; a < points; ++a) {
    for (std::size_t b = 0; b < points; ++b) {
      const int there = uses[a * points + b], back = uses[b * points + a];
      if (there > 1 || there != back) return false;
    }
  }
  return true;
}

/// Facets of the convex hull of at most 64 unit vectors that surround the origin, in order of their lowest
/// corners. Corners within `tolerance` of a facet's plane belong to it, so a cube gives six quadrilaterals.
/// Every triple is tried, O(n^4) of very little: 10 ms at n = 64. Reports points that do not surround the
/// origin.
inline std::vector<Polygon> hull_facets(std::span<const Vec3<double>> points, double tolerance,
                                        const char* where) {
  std::vector<std::uint64_t> found;
  std::vector<Polygon> facets;
  const auto count = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t j = i + 1; j < count; ++j) {
      for (std::uint32_t k = j + 1; k < count; ++k) {
        Vec3<double> normal = (points[j] - points[i]).cross(points[k] - points[i]);
        const double length = normal.norm();
        if (!(length > 0)) continue;
        normal /= length;
        if (normal.dot(points[i]) < 0) normal = -normal;
        const double height = normal.dot(points[i]);
        std::uint64_t members = 0;
        bool supporting = height > tolerance;
        for (std::uint32_t m = 0; m < count && supporting; ++m) {
          const double above = normal.dot(points[m]) - height;
          supporting = above <= tolerance;
          if (above >= -tolerance) members |= std::uint64_t{1} << m;
        }
        if (!supporting || std::find(found.begin(), found.end(), members) != found.end()) continue;
        found.push_back(members);
        facets.push_back(ordered_facet(points, members, normal));
      }
    }
  }
  if (facets.size() < 4 || !is_closed(facets, points.size()))
    fail(where, "extremal points must lie on all sides of the centre, and no four almost in one plane");
  return facets;
}

}  // namespace palpate::detail
