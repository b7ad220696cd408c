// SPDX-License-Identifier: MIT
#pragma once

/// @file  Solid cylinder with flat caps: exact closest point, and a depth that turns over the rims.

#include <palpate/geometry/detail/edge_blend.hpp>
#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>

namespace palpate {

/// Cylinder rho <= R, |y - m_y| <= h about the axis y. No equation: elementary geometry; penetration() is the
/// blend of edge_blend.hpp over the side and the two caps.
///
/// | symbol | name          | unit | range                                           |
/// |--------|---------------|------|-------------------------------------------------|
/// | R      | `radius`      | m    | [1e-6, 1e6]                                     |
/// | h      | `half_height` | m    | [1e-6, 1e6], h / R within 1 : 1000 and 1000 : 1   |
/// | m      | `centre`      | m    | finite, below 1e6                               |
///
/// closest(): the exact distance. Outside, its normal is along x - p, also on the rims. Ties inside: the side
/// before the caps, the +y cap before the other, +x from the axis. penetration(): depth below the side is R -
/// rho down to R / 2 and 3/4 R - rho^2 / R deeper, where every direction is near: continued once
/// differentiably and without the kink that R - rho has on the axis. It equals the exact depth down to R / 2
/// while the other faces are at least twice as far. Accuracy: a few ulp of max(R, h, |x|). A query that is
/// not finite: closest() gives the end of +x at the largest finite distance, penetration() no contact,
/// separated() false, raycast() no hit. Constructor reports bad sizes or centre.
template <Real S>
class Cylinder {
 public:
  using Scalar = S;

  struct Params {
    S radius{S(0.02)};                 ///< R [m]
    S half_height{S(0.03)};            ///< h [m]
    Vec3<S> centre = Vec3<S>::Zero();  ///< m [m]
  };

  explicit Cylinder(const Params& params) : p_(params) {
    detail::require_size(p_.radius, "Cylinder", "radius [m] must be in [1e-6, 1e6]");
    detail::require_size(p_.half_height, "Cylinder", "half_height [m] must be in [1e-6, 1e6]");
    detail::require_ratio(half(), S(1000), "Cylinder",
                          "ratio of half_height and radius must be at most 1000");
    detail::require_centre(p_.centre, "Cylinder");
  }

  /// Closest point of the surface, exact distance; no iteration.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!is_finite(r))
      return detail::nowhere<S>(p_.centre + Vec3<S>(p_.radius, S(0), S(0)), Vec3<S>::UnitX());
    const Vec3<S> out = outward(r);
    const S R = p_.radius, h = p_.half_height, side = r.y() < S(0) ? S(-1) : S(1);
    const S rho = (std::min)(radial(r), (std::numeric_limits<S>::max)()), over = rho - R,
            above = std::abs(r.y()) - h;
    if (over <= S(0) && above <= S(0)) {
      if (over >= above) return {p_.centre + R * out + Vec3<S>(S(0), r.y(), S(0)), out, over};
      return {p_.centre + Vec3<S>(r.x(), side * h, r.z()), Vec3<S>(S(0), side, S(0)), above};
    }
    if (above <= S(0)) return {p_.centre + R * out + Vec3<S>(S(0), r.y(), S(0)), out, over};
    if (over <= S(0)) return {p_.centre + Vec3<S>(r.x(), side * h, r.z()), Vec3<S>(S(0), side, S(0)), above};
    const S size = (std::max)(over, above), u = over / size, v = above / size;
    const S length = std::sqrt(u * u + v * v), distance = size * length;
    return {p_.centre + R * out + Vec3<S>(S(0), side * h, S(0)),
            Vec3<S>((u * out + Vec3<S>(S(0), v * side, S(0))) / length),
            is_finite(distance) ? distance : (std::numeric_limits<S>::max)()};
  }

  /// Blended depth and outward -d(depth)/dx; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!within(r)) return {S(0), Vec3<S>::Zero()};
    const S R = p_.radius, rho = radial(r);
    const bool deep = rho < R / S(2);
    const S side = deep ? S(0.75) * R - rho * (rho / R) : R - rho;
    const EdgeBlend<S, 3> blend = edge_blend<S, 3>({side, p_.half_height - r.y(), p_.half_height + r.y()});
    const auto& w = blend.weight;
    const S slope = w[0] * (deep ? S(2) * rho / R : S(1));
    return {blend.depth, slope * outward(r) + Vec3<S>(S(0), w[1] - w[2], S(0))};
  }

  /// The same of a batch.
  PALPATE_FLATTEN void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    using V = detail::batch_simd<S>;
    const S R = p_.radius, h = p_.half_height;
    V sum{};
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const detail::SimdVec3<V> r = detail::load_from<V>(x, i, p_.centre);
      const V square = r.x * r.x + r.z * r.z;
      sum += square + abs(r.y);
      const V rho = sqrt(square), above = (detail::max)(rho, R / S(2)), below = (detail::min)(rho, R / S(2));
      std::array<V, 3> w;
      V depth;
      const auto inside = detail::edge_blend<V, 3>(
          {(R - above) + (R / S(4) - below * (below / R)), h - r.y, h + r.y}, half().minCoeff(), depth, w);
      const V across = select(inside, w[0] / above, V{});  // 2 rho / R times 1 / rho where deep
      detail::store(in, i, select(inside, depth, V{}),
                    detail::SimdVec3<V>{across * r.x, select(inside, w[1] - w[2], V{}), across * r.z});
    }
    if (!is_finite(reduce(sum))) detail::penetrate_one_by_one(*this, x, in);
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept { return within(x - p_.centre); }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const Vec3<S> d = c - p_.centre;
    if (!is_finite(d) || !is_finite(r) || r < S(0)) return false;
    constexpr S guard = detail::separation_guard<S>;
    const S rho = radial(d);
    const S over = is_finite(rho) ? rho - p_.radius * guard : S(0),
            above = std::abs(d.y()) - p_.half_height * guard;
    const S u = over > S(0) ? over : S(0), v = above > S(0) ? above : S(0), grown = r * guard;
    return u > grown || v > grown || u * u + v * v > grown * grown;
  }

  /// First hit at t >= 0; from inside, where the ray leaves. Direction of any length; zero or not finite: no
  /// hit.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const S scale = detail::ray_scale(origin, d);
    if (!(scale > S(0))) return detail::no_hit<S>();
    const S R = p_.radius, h = p_.half_height;
    const Vec3<S> o = origin - p_.centre, e = d / scale;
    detail::Slab<S> caps =
        detail::slab_interval<S>(Vec3<S>(S(0), o.y(), S(0)), Vec3<S>(S(0), e.y(), S(0)), half());
    using Vec2 = Eigen::Matrix<S, 2, 1, Eigen::DontAlign>;
    const Vec2 o2(o.x() / R, o.z() / R), e2(e.x(), e.z());
    S side_in = caps.t_in, side_out = caps.t_out;
    bool side_enters = false, side_leaves = false;
    // Along the axis: a millionth of a rounding (chosen), so that nothing overflows.
    if (e2.cwiseAbs().maxCoeff() < std::numeric_limits<S>::epsilon() * S(1e-6L)) {
      if (!(o2.squaredNorm() <= S(1))) return detail::no_hit<S>();
    } else {
      if (!detail::unit_ball_interval(o2, e2, side_in, side_out)) return detail::no_hit<S>();
      side_in *= R, side_out *= R;
      side_enters = side_in > caps.t_in, side_leaves = side_out < caps.t_out;
    }
    const S t_in = side_enters ? side_in : caps.t_in, t_out = side_leaves ? side_out : caps.t_out;
    if (caps.empty || t_in > t_out || t_out < S(0)) return detail::no_hit<S>();
    const bool entering = t_in >= S(0), on_side = entering ? side_enters : side_leaves;
    const S t = entering ? t_in : t_out, along = t / scale;
    if (!is_finite(along)) return detail::no_hit<S>();
    Vec3<S> q = o + t * e;
    const S rho = radial(q);
    if (on_side || rho > R) q = R * outward(q) + Vec3<S>(S(0), q.y(), S(0));
    if (!on_side) q.y() = entering == (e.y() < S(0)) ? h : -h;
    if (q.y() > h) q.y() = h;
    if (q.y() < -h) q.y() = -h;
    return {true, p_.centre + q, along};
  }

  /// Side: 1/R around, 0 along the axis. Caps: 0. Rims, where curvature is unbounded, count as the nearer
  /// face.
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& p) const noexcept {
    const Vec3<S> n = normal(p);
    if (std::abs(n.y()) > S(0.5)) return {S(0), S(0), Vec3<S>::UnitX(), n.cross(Vec3<S>::UnitX())};
    return {S(1) / p_.radius, S(0), n.cross(Vec3<S>::UnitY()), Vec3<S>::UnitY()};
  }
  /// Outward unit normal of the face nearest to p; the side at a tie.
  [[nodiscard]] Vec3<S> normal(const Vec3<S>& p) const noexcept {
    const Vec3<S> r = p - p_.centre;
    if (!is_finite(r)) return Vec3<S>::UnitX();
    if (std::abs(radial(r) - p_.radius) <= std::abs(std::abs(r.y()) - p_.half_height)) return outward(r);
    return Vec3<S>(S(0), r.y() < S(0) ? S(-1) : S(1), S(0));
  }

  /// Angle 2 pi u about y; v runs by length from the middle of the +y cap over the side to the middle of the
  /// other cap. u, v are clamped to [0, 1].
  [[nodiscard]] Vec3<S> point(S u, S v) const noexcept {
    const S R = p_.radius, h = p_.half_height, s = detail::unit_interval(v) * (S(2) * R + S(2) * h);
    const Vec3<S> d = detail::direction(u, S(0.5));
    const Vec3<S> around(d.x(), S(0), d.y());
    if (s < R) return p_.centre + s * around + Vec3<S>(S(0), h, S(0));
    if (s <= R + S(2) * h) return p_.centre + R * around + Vec3<S>(S(0), R + h - s, S(0));
    const S rest = S(2) * (R + h) - s;
    return p_.centre + (rest > S(0) ? rest : S(0)) * around - Vec3<S>(S(0), h, S(0));
  }
  /// The finest grid with at most `vertices` (>= 8) vertices; the rims are edges. On the caps squares are
  /// mapped to the disc with equal areas [shirley1997]. Triangles differ in area by less than 4 from 100
  /// vertices on.
  [[nodiscard]] MeshData<S> mesh(std::size_t vertices) const {
    detail::require_vertices(vertices, "Cylinder");
    constexpr double quarter = 0.785398163397448309615660845819875721;
    const double width = 2 * quarter * static_cast<double>(p_.radius);  // an edge's arc on the rim
    const detail::Cells n =
        detail::even_cells(vertices, {width, 2 * static_cast<double>(p_.half_height), width});
    return detail::lattice_mesh<S>(n, [this](const Vec3<S>& c) -> Vec3<S> {
      const bool steep = std::abs(c.z()) > std::abs(c.x());
      const S large = steep ? c.z() : c.x(), small = steep ? c.x() : c.z();
      const S angle = large == S(0) ? S(0) : static_cast<S>(quarter) * (small / large);
      const S a = p_.radius * large * std::cos(angle), b = p_.radius * large * std::sin(angle);
      return p_.centre + Vec3<S>(steep ? b : a, p_.half_height * c.y(), steep ? a : b);
    });
  }

  /// Half of the smallest extent; the blended depth is differentiable everywhere inside.
  [[nodiscard]] S reach() const noexcept { return half().minCoeff(); }
  [[nodiscard]] S volume() const noexcept {
    return S(6.28318530717958647692528676655900577L) * p_.radius * p_.radius * p_.half_height;
  }
  [[nodiscard]] Vec3<S> lower() const noexcept { return p_.centre - half(); }
  [[nodiscard]] Vec3<S> upper() const noexcept { return p_.centre + half(); }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  [[nodiscard]] Vec3<S> half() const noexcept { return Vec3<S>(p_.radius, p_.half_height, p_.radius); }
  [[nodiscard]] static S radial(const Vec3<S>& r) noexcept {
    return stable_norm(Vec3<S>(r.x(), S(0), r.z()));
  }
  // Unit, across the axis; +x on it.
  [[nodiscard]] static Vec3<S> outward(const Vec3<S>& r) noexcept {
    const S size = std::abs(r.x()) > std::abs(r.z()) ? std::abs(r.x()) : std::abs(r.z());
    if (size < (std::numeric_limits<S>::min)()) return Vec3<S>::UnitX();
    return Vec3<S>(r.x() / size, S(0), r.z() / size).normalized();
  }
  [[nodiscard]] bool within(const Vec3<S>& r) const noexcept {
    if (!is_finite(r) || !(std::abs(r.y()) < p_.half_height)) return false;
    const S square = r.x() * r.x() + r.z() * r.z();
    return is_finite(square) && square < p_.radius * p_.radius && radial(r) < p_.radius;
  }

  Params p_;
};

static_assert(ParametricSurface<Cylinder<float>> && ParametricSurface<Cylinder<double>>);

}  // namespace palpate
