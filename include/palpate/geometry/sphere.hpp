// SPDX-License-Identifier: MIT
#pragma once

/// @file  Ball: every query in closed form.

#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>

namespace palpate {

/// Sphere |x - m| = R. No equation: elementary geometry.
///
/// | symbol | name     | unit | range             |
/// |--------|----------|------|-------------------|
/// | R      | `radius` | m    | [1e-6, 1e6]       |
/// | m      | `centre` | m    | finite, below 1e6 |
///
/// Tie: from the centre, the closest point is the end of +x. Accuracy: a few ulp of max(R, |x|).
/// A query that is not finite: closest() gives the end of +x at the largest finite distance, penetration() no
/// contact, separated() false, raycast() no hit. Constructor reports a bad radius or centre.
template <Real S>
class Sphere {
 public:
  using Scalar = S;

  struct Params {
    S radius{S(0.03)};                 ///< R [m]
    Vec3<S> centre = Vec3<S>::Zero();  ///< m [m]
  };

  explicit Sphere(const Params& params) : p_(params) {
    detail::require_size(p_.radius, "Sphere", "radius [m] must be in [1e-6, 1e6]");
    detail::require_centre(p_.centre, "Sphere");
  }

  /// Closest point of the surface; no iteration.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!is_finite(r)) return detail::nowhere<S>(p_.centre + p_.radius * Vec3<S>::UnitX(), Vec3<S>::UnitX());
    // A far point is brought near first: |r| may overflow where r does not. Chosen: 1e12
    // of the largest radius have a square that is finite in float.
    const S size = r.cwiseAbs().maxCoeff(), limit = p_.radius * S(1e12L);
    if (size > limit) {
      const Vec3<S> n = (r / size).normalized();
      const S distance = size * (r / size).norm() - p_.radius;
      return {p_.centre + p_.radius * n, n, is_finite(distance) ? distance : (std::numeric_limits<S>::max)()};
    }
    const Vec3<S> n = unit_or<S>(r, Vec3<S>::UnitX());
    return {p_.centre + p_.radius * n, n, stable_norm(r) - p_.radius};
  }

  /// Depth R - |x - m| and outward normal; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    const S square = r.squaredNorm();
    if (!is_finite(square) || !(square < p_.radius * p_.radius)) return {S(0), Vec3<S>::Zero()};
    if (square <
        (std::numeric_limits<S>::min)() / std::numeric_limits<S>::epsilon())  // the centre, or next to it
      return {p_.radius - stable_norm(r), unit_or<S>(r, Vec3<S>::UnitX())};
    const S length = std::sqrt(square);
    return {p_.radius - length, r / length};
  }

  /// The same of a batch.
  void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    using V = detail::batch_simd<S>;
    constexpr S smallest = (std::numeric_limits<S>::min)() / std::numeric_limits<S>::epsilon();
    V sum{}, least = (std::numeric_limits<S>::max)();
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const detail::SimdVec3<V> r = detail::load_from<V>(x, i, p_.centre);
      const V square = dot(r, r), length = sqrt(square), depth = p_.radius - length;
      sum += square, least = (detail::min)(least, square);
      const auto inside = depth > V{};
      detail::store(in, i, select(inside, depth, V{}), select(inside, S(1) / length, V{}) * r);
    }
    if (!is_finite(reduce(sum)) || !(reduce_min(least) > smallest))
      detail::penetrate_one_by_one(*this, x, in);
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept {
    const S square = (x - p_.centre).squaredNorm();
    return is_finite(square) && square < p_.radius * p_.radius;
  }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const Vec3<S> d = c - p_.centre;
    if (!is_finite(d) || !is_finite(r) || r < S(0)) return false;
    const S sum = (p_.radius + r) * detail::separation_guard<S>;
    return d.cwiseAbs().maxCoeff() > sum || d.squaredNorm() > sum * sum;
  }

  /// First hit at t >= 0; from inside, where the ray leaves. Direction of any length; zero or not finite: no
  /// hit.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const S scale = detail::ray_scale(origin, d);
    if (!(scale > S(0))) return detail::no_hit<S>();
    const Vec3<S> o = (origin - p_.centre) / p_.radius, e = d / scale;
    S t_in, t_out;
    if (!detail::unit_ball_interval(o, e, t_in, t_out) || t_out < S(0)) return detail::no_hit<S>();
    const S t = t_in >= S(0) ? t_in : t_out, along = t / scale * p_.radius;
    if (!is_finite(along)) return detail::no_hit<S>();
    return {true, p_.centre + p_.radius * (o + t * e).normalized(), along};
  }

  /// 1/R in every direction.
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& p) const noexcept {
    const Vec3<S> n = normal(p), e = perpendicular(n);
    return {S(1) / p_.radius, S(1) / p_.radius, e, n.cross(e)};
  }
  /// Outward unit normal at a surface point.
  [[nodiscard]] Vec3<S> normal(const Vec3<S>& p) const noexcept { return closest(p).normal; }

  /// Longitude 2 pi u about z, colatitude pi v; u, v are clamped to [0, 1].
  [[nodiscard]] Vec3<S> point(S u, S v) const noexcept {
    return p_.centre + p_.radius * detail::direction(u, v);
  }
  /// The finest cube-sphere with at most `vertices` (>= 8) vertices, all on the surface; triangles differ in
  /// area by less than 2.
  [[nodiscard]] MeshData<S> mesh(std::size_t vertices) const {
    detail::require_vertices(vertices, "Sphere");
    return detail::lattice_mesh<S>(detail::equal_cells(vertices), [this](const Vec3<S>& c) -> Vec3<S> {
      return p_.centre + p_.radius * detail::cube_to_sphere(c);
    });
  }

  [[nodiscard]] S reach() const noexcept { return p_.radius; }
  [[nodiscard]] S volume() const noexcept {
    return detail::four_pi_thirds<S> * p_.radius * p_.radius * p_.radius;
  }
  [[nodiscard]] Vec3<S> lower() const noexcept { return p_.centre - Vec3<S>::Constant(p_.radius); }
  [[nodiscard]] Vec3<S> upper() const noexcept { return p_.centre + Vec3<S>::Constant(p_.radius); }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  Params p_;
};

static_assert(ParametricSurface<Sphere<float>> && ParametricSurface<Sphere<double>>);

}  // namespace palpate
