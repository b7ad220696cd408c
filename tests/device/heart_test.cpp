// SPDX-License-Identifier: MIT
// The example's own surface against brute force: an exact surface of a user's is held to the same promises.

#include "touch/heart.hpp"

#include <doctest/doctest.h>

#include <random>

using touch::Heart;
using V = palpate::Vec3<double>;

namespace {
constexpr std::uint64_t seed = 20261121;
}

static_assert(palpate::ParametricSurface<Heart> && palpate::HasExtremalPoints<Heart>);

TEST_CASE("heart: closest point against all points of a fine mesh") {
  MESSAGE("seed ", seed);
  const Heart heart({});
  const auto mesh = heart.mesh(40000);
  double longest = 0;  // edge
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest = (std::max)(longest, (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm());
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.3, 1.3);
  int inside = 0;
  for (int i = 0; i < 600; ++i) {
    const V x = 0.5 * (heart.lower() + heart.upper()) +
                0.5 * (heart.upper() - heart.lower())
                          .cwiseProduct(V(uniform(random), uniform(random), uniform(random)));
    const auto p = heart.closest(x);
    if (p.distance < -heart.reach()) continue;  // the answer may be a local minimum there
    inside += p.distance < 0;
    double nearest = 1;
    for (const V& v : mesh.vertices) nearest = (std::min)(nearest, (v - x).norm());
    // Far outside the cleft the answer may be a local minimum: only points near the body are promised.
    if (p.distance < heart.reach()) CHECK(std::abs(p.distance) <= nearest + 1e-12);
    // A vertex is within an edge of every point of the surface.
    CHECK(std::abs(p.distance) >= nearest - longest);
    // A step is taken only where the distance falls, and rounding hides that below the root of epsilon.
    CHECK((x - p.position - p.distance * p.normal).norm() <=
          std::sqrt(2.2e-16) * (x.norm() + heart.params().size));
    CHECK((heart.on_ray(p.position) - p.position).norm() <= 1e-12 * heart.params().size);
    const auto in = heart.penetration(x);
    CHECK((in.depth > 0) == (p.distance < 0));
    if (in.depth > 0) CHECK(in.depth == -p.distance);
  }
  CHECK(inside > 20);
}

TEST_CASE("heart: separated() never claims too much, and rays end on the surface") {
  const Heart heart({});
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int apart = 0, hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const V c = 0.08 * V(uniform(random), uniform(random), uniform(random));
    const double r = 0.02 * std::abs(uniform(random));
    if (heart.separated(c, r)) {
      ++apart;
      CHECK(heart.closest(c).distance > r);
    }
    const V from = 0.2 * V(uniform(random), uniform(random), uniform(random)).normalized();
    const auto hit =
        heart.raycast(from, V(0.02 * V(uniform(random), uniform(random), uniform(random)) - from));
    if (!hit.hit) continue;
    ++hits;
    // The last bisection's interval.
    CHECK((heart.on_ray(hit.position) - hit.position).norm() <= 1e-9 * heart.params().size);
  }
  CHECK(apart > 200);
  CHECK(hits > 1000);
}
