// SPDX-License-Identifier: MIT
// Compiled once per set of vector flags. Constants only: no function that another object could pick up.
#include "sizes.hpp"

#include <palpate/contact/contact_state.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/geometry/concept.hpp>

using namespace palpate;

#define ROW(...) \
  { #__VA_ARGS__, sizeof(__VA_ARGS__), alignof(__VA_ARGS__) }
#define ROWS(T) ROW(T<float>), ROW(T<double>)

constexpr Size PALPATE_TEST_SIZES[] = {
    ROWS(Vec3),
    ROWS(Mat3),
    ROWS(Pose),
    ROWS(Wrench),
    ROWS(SurfacePoint),
    ROWS(Penetration),
    ROWS(RayHit),
    ROWS(Curvature),
    ROWS(MeshData),
    ROWS(ContactState),
    ROWS(PointBatch),
    ROWS(PenetrationBatch),
    ROWS(LeafSum),
    ROW(FixedVector<ContactState<float>, 4>),
    ROW(FixedVector<ContactState<double>, 4>),
    {nullptr, 0, 0},
};
