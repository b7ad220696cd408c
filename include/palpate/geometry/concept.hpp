// SPDX-License-Identifier: MIT
#pragma once

/// @file What an elastic object's undeformed surface must offer. Read this before writing one.
///
/// | shipped          | shape                               | use it when                                   |
/// |------------------|-------------------------------------|-----------------------------------------------|
/// | `Sphere`         | ball                                | closed form everywhere                        |
/// | `Ellipsoid`      | three semi-axes, ratios to 1 : 1000 | the paper's body                              |
/// | `Box`            | cuboid                              | flat faces; force rounds off over the edges   |
/// | `Cylinder`       | solid with flat caps, axis y        | ditto                                         |
/// | `Superellipsoid` | between box, ellipsoid and cylinder | rounded boxes and pills                       |
/// | `MeshSurface`    | any closed triangle mesh            | a shape from a file; exact distance to it     |
/// | `SampledSurface` | samples of one of the others        | a mesh or superellipsoid in a fast tick       |
/// | `GrownSurface`   | one of the others, grown by r       | the tool is a ball: its centre alone is asked |
/// | `SharedSurface`  | handle to one of the others         | several solvers or samplers on one body       |
///
/// Coordinates are the object's own [m]; give the tool's pose in them. A surface holds no state that a query
/// changes, uses no heap in a query, and gives the same bits for the same input.

#include <palpate/config.hpp>
#include <palpate/core/simd_vec3.hpp>
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

/// Points that are worked on at once: two to eight vector registers' worth, whose operations do not wait for
/// each other.
inline constexpr std::size_t batch_size = 16;

/// Positions of N points, coordinate by coordinate. By the cache line, so that no register's worth lies in
/// two of them; in memory, so that the layout is the same in files compiled with other vector flags.
template <Real S, std::size_t N = batch_size>
struct alignas(64) PointBatch {
  std::array<S, N> x, y, z;  ///< [m]
};

/// Their penetration.
template <Real S, std::size_t N = batch_size>
struct alignas(64) PenetrationBatch {
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
/// Each position less s.
template <Real S>
[[nodiscard]] inline PointBatch<S> less(const PointBatch<S>& from, const Vec3<S>& s) noexcept {
  PointBatch<S> x = from;
  for (std::size_t i = 0; i < batch_size; ++i) x.x[i] -= s.x(), x.y[i] -= s.y(), x.z[i] -= s.z();
  return x;
}

/// In what a batch's formulas are worked out, by counts of instructions: a register with AVX, whose
/// instructions take a third operand and repeat a number from memory; four without.
#if defined(__AVX__)
template <Real S>
using batch_simd = simd_at_most<S, static_cast<int>(batch_size)>;
#else
template <Real S>
using batch_simd = simd_group<S>;
#endif

/// Is every coordinate finite?
template <Real S, std::size_t N>
[[nodiscard]] PALPATE_INLINE bool all_finite(const PointBatch<S, N>& x) noexcept {
  using V = simd_at_most<S, static_cast<int>(N)>;
  V sum{};
  for (std::size_t i = 0; i < N; i += V::size())
    sum += load<V>(&x.x[i]) + load<V>(&x.y[i]) + load<V>(&x.z[i]);
  return is_finite(reduce(sum));
}
/// Penetration of points `first` .. first + count - 1 with the surface's function for one.
template <class B, Real S, std::size_t N>
inline void penetrate_one_by_one(const B& body, const PointBatch<S, N>& x, PenetrationBatch<S, N>& in,
                                 std::size_t first = 0, std::size_t count = N) noexcept {
  for (std::size_t i = first; i < first + count; ++i)
    in.set(i, body.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i])));
}
/// Stores one Simd of a batch from point i on.
template <class V, Real S, std::size_t N>
PALPATE_INLINE void store(PenetrationBatch<S, N>& in, std::size_t i, const V& depth,
                          const SimdVec3<V>& gradient) noexcept {
  store(&in.depth[i], depth);
  store(&in.gradient_x[i], gradient.x);
  store(&in.gradient_y[i], gradient.y);
  store(&in.gradient_z[i], gradient.z);
}
/// Positions of one Simd of a batch from point i on, less `origin` [m].
template <class V, Real S, std::size_t N>
[[nodiscard]] PALPATE_INLINE SimdVec3<V> load_from(const PointBatch<S, N>& x, std::size_t i,
                                                   const Vec3<S>& origin) noexcept {
  return {load<V>(&x.x[i]) - origin.x(), load<V>(&x.y[i]) - origin.y(), load<V>(&x.z[i]) - origin.z()};
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

/// The mesh in another scalar.
template <Real T, Real S>
[[nodiscard]] inline MeshData<T> mesh_cast(const MeshData<S>& mesh) {
  MeshData<T> out{{}, mesh.triangles};
  out.vertices.reserve(mesh.vertices.size());
  for (const Vec3<S>& v : mesh.vertices) out.vertices.push_back(v.template cast<T>());
  return out;
}

template <class B>  // the surface point closest to x, and the signed distance; defined for every finite x
concept HasClosest = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.closest(x) } noexcept -> std::same_as<SurfacePoint<typename B::Scalar>>;
};

template <class B>  // depth and exit direction of x for the force law; cheap when x is outside
concept HasPenetration = requires(const B& body, const Vec3<typename B::Scalar>& x) {
  { body.penetration(x) } noexcept -> std::same_as<Penetration<typename B::Scalar>>;
};

template <class B, std::size_t N = batch_size>  // optional: the same of N points at once, to rounding. The
concept HasPenetrationBatch =                   // solver uses it for batch_size points or twice as many.
    requires(const B& body, const PointBatch<typename B::Scalar, N>& x,
             PenetrationBatch<typename B::Scalar, N>& in) {
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
