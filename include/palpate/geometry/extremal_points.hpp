// SPDX-License-Identifier: MIT
#pragma once

/// @file Curvature extremal points: where the skeleton's beams end (V.A).
///
/// | surface          | points                                | why these                                  |
/// |------------------|---------------------------------------|--------------------------------------------|
/// | `Box`            | 8 vertices                            | curvature is infinite there                |
/// | `Ellipsoid`      | 6 ends of the axes                    | the extrema of both principal curvatures   |
/// | same, axes equal | the same 6                            | a choice: curvature is constant on curves   |
/// | `Sphere`         | 6 ends of the coordinate axes         | that does not jump as axes become equal    |
/// | `Cylinder`       | 8: on each rim the ends of x and z    | the rims are extremal all along            |
/// | `Superellipsoid` | 14: ends of the axes, and the points  | flattest and sharpest points for every     |
/// |                  | towards its box's vertices            | pair of exponents                          |
/// | `MeshSurface`    | estimated: mesh_extremal_points.hpp   | any mesh                                   |
///
/// Each choice has every mirror symmetry of its body. Points are in object coordinates [m], set-up only.
///
/// Customisation: a free function `extremal_points(const Body&)` returning `std::vector<ExtremalPoint<S>>`,
/// beside your surface's class, gives the points of a surface of your own; `shading_normal(const Body&, x)`
/// as well where its normal jumps. For one scene only, hand your own list to `FacePartition`. Absent on
/// purpose: inflection curves; the exact surfaces shipped here are convex and have none.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>

#include <cmath>
#include <vector>

namespace palpate {

/// Most extremal points a skeleton and a partition may have.
inline constexpr std::size_t max_extremal_points = 64;

template <Real S>
struct ExtremalPoint {
  Vec3<S> position;  ///< on the undeformed surface [m]
  Vec3<S> normal;    ///< outward, unit; where the surface has none, that of `shading_normal`
};

/// Outward unit normal for interpolation at the surface point x. On a smooth surface it is the surface's own.
template <HasClosest B>
[[nodiscard]] inline Vec3<typename B::Scalar> shading_normal(const B& body,
                                                             const Vec3<typename B::Scalar>& x) {
  return body.closest(x).normal;
}

namespace detail {

/// Direction of the gradient of sum r_i^8 at r = (x - m) / h: close to the face's normal inside a face, and
/// it turns over edges and corners without a jump. The power 8 is our own choice: it tilts less than 1 degree
/// up to half way.
template <Real S>
[[nodiscard]] inline Vec3<S> rounded_normal(const Vec3<S>& x, const Vec3<S>& lower, const Vec3<S>& upper,
                                            bool round_xz) {
  const Vec3<S> half = (upper - lower) / S(2);
  const Vec3<S> r = (x - (lower + upper) / S(2)).cwiseQuotient(half);
  const auto power7 = [](S a) { return a * a * a * a * a * a * a; };
  Vec3<S> n;
  if (round_xz) {
    const S rho = std::sqrt(r.x() * r.x() + r.z() * r.z()), side = power7(rho) / half.x();
    n = Vec3<S>(rho > S(0) ? side * r.x() / rho : S(0), power7(r.y()) / half.y(),
                rho > S(0) ? side * r.z() / rho : S(0));
  } else {
    n = Vec3<S>(power7(r.x()), power7(r.y()), power7(r.z())).cwiseQuotient(half);
  }
  return unit_or<S>(n, Vec3<S>::UnitY());
}

/// The ends of the axes of the body's bounding box, -x, +x, -y, +y, -z, +z.
template <class B, Real S = typename B::Scalar>
inline void add_axis_ends(const B& body, std::vector<ExtremalPoint<S>>& points) {
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      Vec3<S> position = middle;
      position[axis] = high ? body.upper()[axis] : body.lower()[axis];
      points.push_back({position, high ? Vec3<S>(Vec3<S>::Unit(axis)) : Vec3<S>(-Vec3<S>::Unit(axis))});
    }
  }
}

/// Vertex number 0..7 of the body's bounding box: bit 0 is x, bit 1 is y, bit 2 is z.
template <class B, Real S = typename B::Scalar>
[[nodiscard]] inline Vec3<S> box_vertex(const B& body, unsigned number) {
  const Vec3<S> low = body.lower(), high = body.upper();
  return Vec3<S>((number & 1u) ? high.x() : low.x(), (number & 2u) ? high.y() : low.y(),
                 (number & 4u) ? high.z() : low.z());
}

}  // namespace detail

/// A box's normal jumps at its edges; this one turns over them, so that what is interpolated does not jump.
template <Real S>
[[nodiscard]] inline Vec3<S> shading_normal(const Box<S>& body, const Vec3<S>& x) {
  return detail::rounded_normal<S>(x, body.lower(), body.upper(), false);
}
/// The same over a cylinder's rims.
template <Real S>
[[nodiscard]] inline Vec3<S> shading_normal(const Cylinder<S>& body, const Vec3<S>& x) {
  return detail::rounded_normal<S>(x, body.lower(), body.upper(), true);
}

/// The 8 vertices, x fastest.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const Box<S>& body) {
  std::vector<ExtremalPoint<S>> points;
  for (unsigned number = 0; number < 8; ++number) {
    const Vec3<S> position = detail::box_vertex(body, number);
    points.push_back({position, shading_normal(body, position)});
  }
  return points;
}

/// The 6 ends of the axes, -x first.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const Ellipsoid<S>& body) {
  std::vector<ExtremalPoint<S>> points;
  detail::add_axis_ends(body, points);
  return points;
}

/// The 6 ends of the coordinate axes, -x first.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const Sphere<S>& body) {
  std::vector<ExtremalPoint<S>> points;
  detail::add_axis_ends(body, points);
  return points;
}

/// On the lower and then the upper rim: -x, +x, -z, +z.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const Cylinder<S>& body) {
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  std::vector<ExtremalPoint<S>> points;
  for (const S y : {body.lower().y(), body.upper().y()}) {
    for (const int axis : {0, 2}) {
      for (const S end : {body.lower()[axis], body.upper()[axis]}) {
        Vec3<S> position(middle.x(), y, middle.z());
        position[axis] = end;
        points.push_back({position, shading_normal(body, position)});
      }
    }
  }
  return points;
}

/// The 6 ends of the axes, -x first, then the surface points in the directions of its box's 8 vertices, x
/// fastest.
template <Real S>
[[nodiscard]] inline std::vector<ExtremalPoint<S>> extremal_points(const Superellipsoid<S>& body) {
  std::vector<ExtremalPoint<S>> points;
  detail::add_axis_ends(body, points);
  const Vec3<S> middle = (body.lower() + body.upper()) / S(2);
  for (unsigned number = 0; number < 8; ++number) {
    const Vec3<S> position = body.raycast(middle, detail::box_vertex(body, number) - middle).position;
    points.push_back({position, shading_normal(body, position)});
  }
  return points;
}

/// A surface with extremal points of its own choice.
template <class B>
concept HasExtremalPoints = requires(const B& body) {
  { extremal_points(body) } -> std::same_as<std::vector<ExtremalPoint<typename B::Scalar>>>;
};

}  // namespace palpate
