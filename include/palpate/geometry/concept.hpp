// SPDX-License-Identifier: MIT
#pragma once

/// @file What an elastic object's undeformed surface must offer. Read this before writing one.
///
/// | shipped          | shape                                   | use it when                                        |
/// |------------------|-----------------------------------------|----------------------------------------------------|
/// | `Sphere`         | ball                                    | closed form everywhere                             |
/// | `Ellipsoid`      | three semi-axes, ratios to 1 : 1000     | the paper's body                                   |
/// | `Box`            | cuboid                                  | flat faces; force rounds off over the edges        |
/// | `Cylinder`       | solid with flat caps, axis y            | ditto                                              |
/// | `Superellipsoid` | between box, ellipsoid and cylinder     | rounded boxes and pills                            |
/// | `MeshSurface`    | any closed triangle mesh                | a shape from a file; exact distance to it          |
/// | `SampledSurface` | samples of one of the others            | a mesh or superellipsoid in a fast tick            |
///
/// Coordinates are the object's own [m]; give the tool's pose in them. A surface holds no state that a query
/// changes, uses no heap in a query, and gives the same bits for the same input.

#include <palpate/config.hpp>
#include <palpate/core/vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace palpate {

/// The point of the surface closest to a query point.
template <Real S>
struct SurfacePoint {
  Vec3<S> position;  ///< on the surface [m]
  Vec3<S> normal;    ///< outward, unit
  S distance;        ///< signed [m]: > 0 outside, < 0 inside
};

/// How deep a point is inside, for the force. `gradient` is the outward direction of steepest exit, gradient
/// = -d(depth)/dx; it is the outward unit normal except over a box's or cylinder's edge, where depth is
/// blended so that the force turns instead of jumping, and |gradient| < 1.
template <Real S>
struct Penetration {
  S depth;           ///< > 0 inside [m]; <= 0: not touching
  Vec3<S> gradient;  ///< [-]
};

/// So many points are worked on at once: two to eight vector registers' worth, whose operations do not wait
/// for each other.
inline constexpr std::size_t lane_count = 16;

/// Points, coordinate by coordinate. By the cache line, so that no register's worth lies in two of them.
template <Real S, std::size_t N = lane_count>
struct alignas(64) PointLanes {
  std::array<S, N> x, y, z;  ///< [m]
};

/// Their penetration.
template <Real S, std::size_t N = lane_count>
struct alignas(64) PenetrationLanes {
  std::array<S, N> depth;                               ///< [m]
  std::array<S, N> gradient_x, gradient_y, gradient_z;  ///< [-]

  void set(std::size_t i, const Penetration<S>& one) noexcept {
    depth[i] = one.depth;
    gradient_x[i] = one.gradient.x();
    gradient_y[i] = one.gradient.y();
    gradient_z[i] = one.gradient.z();
  }
};

namespace detail {
/// One number per lane as whole vector registers, whatever a compiler makes of loops. Not aligned: its layout
/// is the same in files compiled with other vector flags.
template <Real S, int N = static_cast<int>(lane_count)>
using LaneArray = Eigen::Array<S, N, 1, Eigen::DontAlign>;
template <Real S>
[[nodiscard]] PALPATE_INLINE Eigen::Map<const LaneArray<S>> lane_array(
    const std::array<S, lane_count>& a) noexcept {
  return Eigen::Map<const LaneArray<S>>(a.data());
}
template <Real S>
[[nodiscard]] PALPATE_INLINE Eigen::Map<LaneArray<S>> lane_array(std::array<S, lane_count>& a) noexcept {
  return Eigen::Map<LaneArray<S>>(a.data());
}

/// 1 for lanes > 0, 0 for the others. Lanes that are > 0 are at least epsilon / 2 times `size` there: they
/// are differences of numbers of that size. By arithmetic, because Eigen chooses between vectors one number
/// at a time.
template <class V, Real S>
[[nodiscard]] PALPATE_INLINE V one_if_positive(const V& x, S size) noexcept {
  return (x * (S(4) / (std::numeric_limits<S>::epsilon() * size))).max(S(0)).min(S(1));
}

/// Penetration of the first `count` points with the surface's function for one.
template <class B, Real S>
inline void penetrate_one_by_one(const B& body, const PointLanes<S>& x, std::size_t count,
                                 PenetrationLanes<S>& in) noexcept {
  for (std::size_t i = 0; i < count; ++i) in.set(i, body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i])));
}
}  // namespace detail

/// Where a ray first meets the surface.
template <Real S>
struct RayHit {
  bool hit;
  Vec3<S> position;  ///< valid when hit
  S t;               ///< position = origin + t direction [m]
};

/// Principal curvatures [1/m] and directions at a surface point; positive where the surface is convex.
template <Real S>
struct Curvature {
  S k1, k2;            ///< k1 >= k2
  Vec3<S> dir1, dir2;  ///< unit, tangent, perpendicular to each other
};

/// A closed triangle mesh as plain arrays: the common coin of set-up, files and displays.
/// Triangles are counter-clockwise seen from outside.
template <Real S>
struct MeshData {
  std::vector<Vec3<S>> vertices;                        ///< n x 3 [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< m x 3, indices of vertices
};

template <class B>  // the surface point closest to x, and the signed distance; defined for every finite x
concept HasClosest = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.closest(x) } noexcept -> std::same_as<SurfacePoint<typename B::Scalar>>;
};

template <class B>  // depth and exit direction of x for the force law; cheap when x is outside
concept HasPenetration = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.penetration(x) } noexcept -> std::same_as<Penetration<typename B::Scalar>>;
};

template <
    class B,
    std::size_t N =
        lane_count>  // optional: the same for N points at once, to rounding; the solver uses it where it
concept HasPenetrationLanes =  // is there, for `lane_count` points or for twice as many
    requires(const B& body, const PointLanes<typename B::Scalar, N>& x,
             PenetrationLanes<typename B::Scalar, N>& in) {
      { body.penetration(x, in) } noexcept;
    };

template <class B>  // true only if no point of the ball (centre, radius) can be inside: a cheap, safe test
concept HasSeparated = requires(const B& body, const Vec3<typename B::Scalar>& x, typename B::Scalar r) {
  { body.separated(x, r) } noexcept -> std::same_as<bool>;
};

template <class B>  // first hit of the ray origin + t direction, t >= 0
concept HasRaycast = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.raycast(x, x) } noexcept -> std::same_as<RayHit<typename B::Scalar>>;
};

template <class B>  // principal curvatures at a surface point
concept HasCurvature = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.curvature(x) } noexcept -> std::same_as<Curvature<typename B::Scalar>>;
};

template <class B>  // parametrisation over [0,1] x [0,1]
concept HasPoint = requires(const B& body, typename B::Scalar u, typename B::Scalar v) {
  { body.point(u, v) } noexcept -> std::same_as<Vec3<typename B::Scalar>>;
};

template <class B>  // depth [m] down to which the closest point is unique and depth is differentiable
concept HasReach = requires(const B& body) {
  { body.reach() } noexcept -> std::same_as<typename B::Scalar>;
};

template <class B>  // closed triangle mesh with about `vertices` vertices; set-up only
concept HasMesh = requires(const B& body, std::size_t vertices) {
  { body.mesh(vertices) } -> std::same_as<MeshData<typename B::Scalar>>;
};

/// What the force needs of the elastic object.
template <class B>
concept ContactSurface = Real<typename B::Scalar> && HasClosest<B> && HasPenetration<B> && HasSeparated<B> &&
                         HasReach<B> && std::move_constructible<B>;

/// An exact surface: all of that in closed form or to rounding, with its differential geometry.
template <class B>
concept ParametricSurface =
    ContactSurface<B> && HasRaycast<B> && HasCurvature<B> && HasPoint<B> && HasMesh<B>;

}  // namespace palpate
