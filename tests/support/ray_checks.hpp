// SPDX-License-Identifier: MIT
#pragma once

/// @file Rays through bodies of different kinds that are alike where the rays are.

#include "support/check.hpp"

#include <palpate/geometry/concept.hpp>

namespace palpate::test {

/// A ray beside the middle of a body that the plane y = 0 cuts in a circle of radius 5 around the origin.
template <Real S, class Body>
void check_ray_beside_middle(const Body& body) {
  const RayHit<S> in = body.raycast(Vec3<S>(-10, 0, 3), Vec3<S>(1, 0, 0)),
                  out = body.raycast(Vec3<S>(0, 0, 3), Vec3<S>(1, 0, 0));
  CHECK_ABSOLUTE(in.t, 6.0L, ulps<S>(8) * 10);
  CHECK_ABSOLUTE((in.position - Vec3<S>(-4, 0, 3)).norm(), 0, ulps<S>(8) * 10);
  CHECK_ABSOLUTE(out.t, 4.0L, ulps<S>(8) * 10);
  CHECK(!body.raycast(Vec3<S>(-10, 0, S(5.001)), Vec3<S>(1, 0, 0)).hit);
}

}  // namespace palpate::test
