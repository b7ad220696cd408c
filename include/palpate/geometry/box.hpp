// SPDX-License-Identifier: MIT
#pragma once

/// @file  Cuboid: exact closest point, and a depth that turns over the edges instead of jumping.

#include <palpate/geometry/detail/edge_blend.hpp>
#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>

namespace palpate {

/// Cuboid |x_i - m_i| <= h_i, faces across the object's axes. No equation: elementary geometry; penetration()
/// is the blend of edge_blend.hpp over the six faces.
///
/// | symbol | name     | unit | range                                      |
/// |--------|----------|------|--------------------------------------------|
/// | h_i    | `half`   | m    | [1e-6, 1e6] each, ratio at most 1 : 1000   |
/// | m      | `centre` | m    | finite, below 1e6                          |
///
/// closest(): the exact distance. Outside, its normal is along x - p, which on edges and corners is within
/// their cone of normals. Tie inside: the first of x, y, z, its + side at equal distance. penetration():
/// equals the exact depth below the nearest face while all others are at least twice as far. Accuracy: a few
/// ulp of max(h_i, |x_i|). A query that is not finite: closest() gives the middle of the +x face at the
/// largest finite distance, penetration() no contact, separated() false, raycast() no hit. Constructor
/// reports bad sizes or centre.
template <Real S>
class Box {
 public:
  using Scalar = S;

  struct Params {
    Vec3<S> half{S(0.03), S(0.02), S(0.02)};  ///< half edge lengths h_i [m]
    Vec3<S> centre = Vec3<S>::Zero();         ///< m [m]
  };

  explicit Box(const Params& params) : p_(params) {
    for (int i = 0; i < 3; ++i) detail::require_size(p_.half[i], "Box", "half [m] must be in [1e-6, 1e6]");
    detail::require_ratio(p_.half, S(1000), "Box", "ratio of half lengths must be at most 1000");
    detail::require_centre(p_.centre, "Box");
  }

  /// Closest point of the surface, exact distance; no iteration.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!is_finite(r))
      return detail::nowhere<S>(p_.centre + Vec3<S>(p_.half.x(), S(0), S(0)), Vec3<S>::UnitX());
    Vec3<S> q = r.cwiseMax(-p_.half).cwiseMin(p_.half);
    const int i = nearest_face(r);
    const Vec3<S> face = (r[i] < S(0) ? S(-1) : S(1)) * Vec3<S>::Unit(i);
    const Vec3<S> away = r - q;
    if (away.x() == S(0) && away.y() == S(0) && away.z() == S(0)) {
      q[i] = r[i] < S(0) ? -p_.half[i] : p_.half[i];
      return {p_.centre + q, face, std::abs(r[i]) - p_.half[i]};
    }
    const S size = away.cwiseAbs().maxCoeff();
    const S length = (away / size).norm(), distance = size * length;
    return {p_.centre + q, away / size / length,
            is_finite(distance) ? distance : (std::numeric_limits<S>::max)()};
  }

  /// Blended depth and outward -d(depth)/dx; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!within(r)) return {S(0), Vec3<S>::Zero()};
    const EdgeBlend<S, 6> blend =
        edge_blend<S, 6>({p_.half.x() - r.x(), p_.half.x() + r.x(), p_.half.y() - r.y(), p_.half.y() + r.y(),
                          p_.half.z() - r.z(), p_.half.z() + r.z()});
    const auto& w = blend.weight;
    return {blend.depth, Vec3<S>(w[0] - w[1], w[2] - w[3], w[4] - w[5])};
  }

  /// The same of a batch.
  PALPATE_FLATTEN void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    if (!detail::all_finite(x)) return detail::penetrate_one_by_one(*this, x, in);
    // Six faces do not stay in four registers: then the whole batch.
    using V = std::conditional_t<detail::batch_simd<S>::registers == 1, detail::batch_simd<S>,
                                 detail::Simd<S, static_cast<int>(batch_size)>>;
    const Vec3<S>& h = p_.half;
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const detail::SimdVec3<V> r = detail::load_from<V>(x, i, p_.centre);
      std::array<V, 6> w;
      V depth;
      const auto inside = detail::edge_blend<V, 6>(
          {h.x() - r.x, h.x() + r.x, h.y() - r.y, h.y() + r.y, h.z() - r.z, h.z() + r.z}, h.minCoeff(), depth,
          w);
      detail::store(in, i, select(inside, depth, V{}),
                    detail::SimdVec3<V>{select(inside, w[0] - w[1], V{}), select(inside, w[2] - w[3], V{}),
                                        select(inside, w[4] - w[5], V{})});
    }
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept { return within(x - p_.centre); }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const Vec3<S> d = c - p_.centre;
    if (!is_finite(d) || !is_finite(r) || r < S(0)) return false;
    const Vec3<S> away = (d.cwiseAbs() - p_.half * detail::separation_guard<S>).cwiseMax(S(0));
    const S grown = r * detail::separation_guard<S>;
    return away.maxCoeff() > grown || away.squaredNorm() > grown * grown;
  }

  /// First hit at t >= 0; from inside, where the ray leaves. Direction of any length; zero or not finite: no
  /// hit.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const S scale = detail::ray_scale(origin, d);
    if (!(scale > S(0))) return detail::no_hit<S>();
    const Vec3<S> o = origin - p_.centre, e = d / scale;
    const detail::Slab<S> slab = detail::slab_interval(o, e, p_.half);
    if (slab.empty || slab.t_out < S(0)) return detail::no_hit<S>();
    const bool entering = slab.t_in >= S(0);
    const S t = entering ? slab.t_in : slab.t_out, along = t / scale;
    if (!is_finite(along)) return detail::no_hit<S>();
    const int axis = entering ? slab.axis_in : slab.axis_out;
    Vec3<S> q = (o + t * e).cwiseMax(-p_.half).cwiseMin(p_.half);
    q[axis] = (entering == (e[axis] < S(0))) ? p_.half[axis] : -p_.half[axis];
    return {true, p_.centre + q, along};
  }

  /// 0 on the faces. Edges and corners, where curvature is unbounded, count as the nearest face.
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& p) const noexcept {
    const Vec3<S> n = normal(p), e = perpendicular(n);
    return {S(0), S(0), e, n.cross(e)};
  }
  /// Outward unit normal of the face nearest to p.
  [[nodiscard]] Vec3<S> normal(const Vec3<S>& p) const noexcept {
    const Vec3<S> r = p - p_.centre;
    const int i = nearest_face(r);
    return (r[i] < S(0) ? S(-1) : S(1)) * Vec3<S>::Unit(i);
  }

  /// Where the direction of longitude 2 pi u about z and colatitude pi v, stretched by h_i, leaves the box;
  /// u, v are clamped to [0, 1].
  [[nodiscard]] Vec3<S> point(S u, S v) const noexcept {
    const Vec3<S> d = detail::direction(u, v);
    return p_.centre + p_.half.cwiseProduct(d / d.cwiseAbs().maxCoeff());
  }
  /// The finest grid of nearly square cells with at most `vertices` (>= 8) vertices; edges and corners are
  /// vertices. Triangles differ in area by less than 4 once every edge has 2 cells.
  [[nodiscard]] MeshData<S> mesh(std::size_t vertices) const {
    detail::require_vertices(vertices, "Box");
    const std::array<double, 3> edges{static_cast<double>(p_.half.x()), static_cast<double>(p_.half.y()),
                                      static_cast<double>(p_.half.z())};
    return detail::lattice_mesh<S>(detail::even_cells(vertices, edges), [this](const Vec3<S>& c) -> Vec3<S> {
      return p_.centre + p_.half.cwiseProduct(c);
    });
  }

  /// Half of the smallest extent; the blended depth is differentiable everywhere inside.
  [[nodiscard]] S reach() const noexcept { return p_.half.minCoeff(); }
  [[nodiscard]] S volume() const noexcept { return S(8) * p_.half.prod(); }
  [[nodiscard]] Vec3<S> lower() const noexcept { return p_.centre - p_.half; }
  [[nodiscard]] Vec3<S> upper() const noexcept { return p_.centre + p_.half; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  [[nodiscard]] bool within(const Vec3<S>& r) const noexcept {
    return is_finite(r) && std::abs(r.x()) < p_.half.x() && std::abs(r.y()) < p_.half.y() &&
           std::abs(r.z()) < p_.half.z();
  }
  [[nodiscard]] int nearest_face(const Vec3<S>& r) const noexcept {
    int nearest = 0;
    for (int i = 1; i < 3; ++i)
      if (std::abs(r[i]) - p_.half[i] > std::abs(r[nearest]) - p_.half[nearest]) nearest = i;
    return nearest;
  }

  Params p_;
};

static_assert(ParametricSurface<Box<float>> && ParametricSurface<Box<double>>);

}  // namespace palpate
