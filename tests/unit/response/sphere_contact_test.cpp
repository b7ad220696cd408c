// SPDX-License-Identifier: MIT
#include <palpate/response/tick/sphere_contact.hpp>

#include "support/check.hpp"

namespace {
using namespace palpate;
}

TEST_CASE("sphere: Hertz for shallow contact, series compliance softens, stiffness is the slope") {
  const double R = 0.015, modulus = 2e6, d = 1e-6;
  // Hertz is the limit; the exact sphere differs by O(d/R) = 7e-5.
  CHECK_RELATIVE(sphere_force(d, R, modulus, 0.0).force, 4.0 / 3 * modulus * std::sqrt(R) * std::pow(d, 1.5),
                 1e-4);
  const auto f = sphere_force(4e-3, R, modulus, 5e-6), up = sphere_force(4e-3 + 1e-7, R, modulus, 5e-6),
             down = sphere_force(4e-3 - 1e-7, R, modulus, 5e-6);
  CHECK(f.force < sphere_force(4e-3, R, modulus, 0.0).force);
  CHECK_RELATIVE(f.stiffness, (up.force - down.force) / 2e-7, 1e-6);  // central difference
  // What a stiff layer takes from the depth; bounded by half of it, where the force is that of twice the
  // depth. Newton's last step is up to 4 epsilon of the radius, of which the force is a power of 3 or a
  // little more.
  const double own = sphere_force(4e-3, R, modulus, 0.0).force,
               stiff = sphere_force(4e-3, R, modulus, -5e-6).force;
  CHECK_RELATIVE(sphere_force(4e-3 + 5e-6 * stiff, R, modulus, 0.0).force, stiff, test::ulps<double>(64));
  CHECK(stiff > own);
  CHECK_RELATIVE(sphere_force(4e-3, R, modulus, -1.0).force, sphere_force(8e-3, R, modulus, 0.0).force,
                 test::ulps<double>(64));
  // Without the gap's fourth power (a paraboloid, to s^4) the same depth is a larger force, with softening a
  // smaller one.
  CHECK(sphere_force(4e-3, R, modulus, 0.0, 1.0).force > own);
  CHECK(sphere_force(4e-3, R, modulus, 0.0, 0.0, 0.05).force < own);
  // A surface that is drawn in gives the force of a depth that is larger by x a/R.
  const auto drawn_in = sphere_force(4e-3, R, modulus, 0.0, 0.0, 0.0, 0.2);
  const double deeper = 4e-3 * (1 + 0.2 * drawn_in.radius / R);
  CHECK_RELATIVE(drawn_in.force, sphere_force(deeper, R, modulus, 0.0).force, test::ulps<double>(64));
  for (const double softening : {0.05, -0.1}) {
    const auto at = [&](double depth) { return sphere_force(depth, R, modulus, 5e-6, 0.5, softening, 0.2); };
    CHECK_RELATIVE(at(4e-3).stiffness, (at(4e-3 + 1e-7).force - at(4e-3 - 1e-7).force) / 2e-7, 1e-6);
    for (double depth = 1e-5; depth < 0.1; depth *= 1.1) CHECK(at(1.1 * depth).force >= at(depth).force);
  }
  CHECK(sphere_force(-1.0, R, modulus, 0.0).force == 0);
  CHECK(sphere_force(std::numeric_limits<double>::quiet_NaN(), R, modulus, 0.0).force == 0);
}
