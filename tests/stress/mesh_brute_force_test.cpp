// SPDX-License-Identifier: MIT

/// @file A mesh as the elastic object against brute force, in double: 100,000 random queries on five meshes
/// for distance, closest point, inside, and depth.

#include <palpate/geometry/mesh_surface.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <string>

using namespace palpate;

TEST_CASE("stress: 100,000 queries of five meshes equal brute force") {
  constexpr std::uint64_t seed = 20240703;
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  for (const auto& [name, mesh] : test::five_meshes<double>(100)) {
    const MeshSurface<double> body{TriangleMesh<double>(mesh)};
    // A few operations on coordinates, each rounded to epsilon of the size.
    const long double rounding =
        test::ulps<double>(8) * static_cast<long double>(body.upper().cwiseAbs().maxCoeff());
    long double worst = 0, off = 0;
    int wrong_side = 0, wrong_depth = 0, inside = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3<double> x = test::random_position(mesh, random);
      const long double expected = test::brute_force_distance(mesh, x);
      const auto found = body.closest(x);
      const double depth = body.penetration(x).depth;
      worst = std::fmax(worst, std::fabs(static_cast<long double>(found.distance) - expected));
      // The closest point may be another of equally close ones; it must lie on the mesh, as far away as it
      // says.
      const long double there = std::fabs(test::brute_force_distance(mesh, found.position));
      off = std::fmax(off, std::fmax(there, std::fabs(static_cast<long double>((found.position - x).norm()) -
                                                      std::fabs(expected))));
      wrong_side += std::fabs(expected) > rounding && body.inside(x) != (expected < 0);
      wrong_depth += std::fabs(static_cast<long double>(depth) - std::fmax(-expected, 0.0L)) > rounding;
      inside += expected < 0;
    }
    std::printf(
        "%-9s %zu triangles: 20000 queries, %d inside, largest error of distance %.1e m, of the point %.1e "
        "m\n",
        name, mesh.triangles.size(), inside, static_cast<double>(worst), static_cast<double>(off));
    INFO(std::string(name));
    CHECK(worst <= rounding);
    CHECK(off <= rounding);
    CHECK(wrong_side == 0);
    CHECK(wrong_depth == 0);
    CHECK(inside > 1000);
  }
}
