// SPDX-License-Identifier: MIT
#pragma once

/// @file Templates that many tests use, compiled once: in instances.cpp. Parsed before every test where
/// several are compiled together (tests/CMakeLists.txt); a third of a test's machine code was one of these.

#include <palpate/contact/pressure_sum.hpp>
#include <palpate/contact/region_sum.hpp>
#include <palpate/detection/candidates_from.hpp>
#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/mesh_surface.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>
#include <palpate/luo_xiao/displacement_field.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>

// PALPATE_TEST_INSTANCES(extern template) declares them, PALPATE_TEST_INSTANCES(template) compiles them.
#define PALPATE_TEST_INSTANCES_OF(instance, S)                                                             \
  instance class Box<S>;                                                                                   \
  instance class Cylinder<S>;                                                                              \
  instance class Ellipsoid<S>;                                                                             \
  instance class Sphere<S>;                                                                                \
  instance class Superellipsoid<S>;                                                                        \
  instance void Superellipsoid<S>::near_surface<1>(const S*, const S*, const S*, S*, S*, S*, S*)           \
      const noexcept;                                                                                      \
  instance void Superellipsoid<S>::near_surface<int(batch_size)>(const S*, const S*, const S*, S*, S*, S*, \
                                                                 S*) const noexcept;                       \
  instance void Superellipsoid<S>::near_surface<int(2 * batch_size)>(const S*, const S*, const S*, S*, S*, \
                                                                     S*, S*) const noexcept;               \
  instance Moved<S> DisplacementField<PhongInterpolation<S>, AreaNeighbourhood<S>>::write(                 \
      std::span<const ContactDisplacement<S>>, std::span<const Vec3<S>>, const VertexBuffer<S>&) noexcept; \
  instance class TriangleBvh<S>;                                                                           \
  instance class LeafSum<S>;                                                                               \
  instance class PressureSum<S>;                                                                           \
  instance class DisplacementField<PhongInterpolation<S>, AreaNeighbourhood<S>>;
#define PALPATE_TEST_INSTANCES(instance)     \
  PALPATE_TEST_INSTANCES_OF(instance, float) \
  PALPATE_TEST_INSTANCES_OF(instance, double)

namespace palpate {
PALPATE_TEST_INSTANCES(extern template)
}
