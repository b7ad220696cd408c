// SPDX-License-Identifier: MIT

// Continuity in time: while a contact wanders over faces, edges and corners, no vertex moves further in one
// tick than a stated factor times the contact's step.

#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/luo_xiao/interpolation/smooth.hpp>

#include <doctest/doctest.h>

using namespace palpate;

namespace {

using S = double;

/// Max |change of u| / max displacement, per step / body size, over 10,000 paths of short straight
/// steps; half of the paths start on an edge or a corner of the partition.
template <BlockInterpolation I, class Body>
double steepest(const I& interpolation, const Body& body) {
  std::mt19937_64 random(10000);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3<S>(unit(random), unit(random), unit(random)); };
  const auto& partition = interpolation.partition();
  const Vec3<S> middle = (body.lower() + body.upper()) / 2;
  const double size = (body.upper() - body.lower()).norm() / 2;
  std::vector<Vec3<S>> corners(partition.points().size());
  std::vector<Vec3<S>> before, after;
  double worst = 0;
  for (int path = 0; path < 10000; ++path) {
    for (auto& u : corners) u = vector();
    ContactDisplacement<S> contact;
    contact.displacement = vector();
    Vec3<S> start = vector().normalized();
    if (path % 2 == 1) {  // on an edge; every eighth path on a corner, exactly
      const Face<S>& face = partition.faces()[static_cast<std::size_t>(path) % partition.faces().size()];
      const double along = path % 8 == 1 ? 0.0 : (1 + unit(random)) / 2;
      start = (1 - along) * (partition.points()[face.corner[0]].position - middle) +
              along * (partition.points()[face.corner[1]].position - middle);
    }
    const double step = size * std::pow(10.0, -3.5 + 1.5 * unit(random));  // 1e-5 to 1e-2 of the body
    const Vec3<S> heading = vector().normalized();
    Vec3<S> p = body.raycast(middle, start).position, last;
    for (int tick = 0; tick < 4; ++tick) {
      if (tick > 0) {
        last = p;
        p = body.closest(p + step * heading).position;
      }
      contact.position = p;
      contact.normal = shading_normal(body, p);
      after = test::field_of(interpolation, corners, contact);
      const double moved = tick > 0 ? (p - last).norm() : 0.0;
      if (moved > 1e-9 * size) {
        for (std::size_t slot = 0; slot < after.size(); ++slot)
          worst = std::max(worst, (after[slot] - before[slot]).norm() / 1.7320508 * size / moved);
      }
      before.swap(after);
    }
  }
  return worst;
}

template <BlockInterpolation I, class Body>
void check_paths(const Body& body, double limit) {
  const auto mesh = body.mesh(60);
  const double worst = steepest(I(make_partition(body, mesh)), body);
  MESSAGE("seed 10000, steepest slope ", worst, " of ", limit);
  CHECK(worst <= limit);
}

const Ellipsoid<S> ellipsoid({.axes = {0.03, 0.02, 0.02}});
const Box<S> box({.half = {0.02, 0.02, 0.02}});

}  // namespace

// d mu / d P <= 1/fade = 10, and weights turn over 2 to 4 times faster than the position in units of the
// body; corners and contact may each be as large as the unit of displacement.
TEST_CASE("linear field under 10,000 wandering contacts: ellipsoid") {
  check_paths<LinearInterpolation<S>>(ellipsoid, 40);
}
TEST_CASE("linear field under 10,000 wandering contacts: box") {
  check_paths<LinearInterpolation<S>>(box, 40);
}
// Directions turn up to 4 times faster than the vectors where they nearly cancel.
TEST_CASE("Phong field under 10,000 wandering contacts: ellipsoid") {
  check_paths<PhongInterpolation<S>>(ellipsoid, 160);
}
TEST_CASE("Phong field under 10,000 wandering contacts: box") {
  check_paths<PhongInterpolation<S>>(box, 160);
}
// The spline overshoots where the contact is near a corner that moves otherwise.
TEST_CASE("smooth field under 10,000 wandering contacts: ellipsoid") {
  check_paths<SmoothInterpolation<S>>(ellipsoid, 40);
}
TEST_CASE("smooth field under 10,000 wandering contacts: box") {
  check_paths<SmoothInterpolation<S>>(box, 40);
}
