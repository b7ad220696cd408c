// SPDX-License-Identifier: MIT
#pragma once

/// @file  Ellipsoid: the paper's elastic body, with a closest point that holds from the centre to 1e6 m.

#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>

namespace palpate {

/// Ellipsoid sum_i ((x_i - m_i) / a_i)^2 = 1, axes along the object's.
///
/// | symbol | name     | unit | range                                       |
/// |--------|----------|------|---------------------------------------------|
/// | a_i    | `axes`   | m    | [1e-6, 1e6] each, ratio at most 1 : 1000    |
/// | m      | `centre` | m    | finite, below 1e6                           |
///
/// Closest point p of x, in the octant of x: x - p = s a_min^2 (p_i / a_i^2). With z_i = |x_i - m_i| / a_i,
/// r_i = (a_i / a_min)^2 and w = s + 1 > 0 it is p_i = a_i q_i, q_i = r_i z_i / (w + r_i - 1), and w solves
/// |q(w)| = 1 [eberly_distance]. Halley's method runs on 1/|q| - 1, which is concave and nearly linear in w
/// [more1983], inside a bracket that is halved (in log w) when a step leaves it or gains little. w and r_i -
/// 1 are computed without cancellation, so a point on the focal disc is no special case.
///
/// Iterations: at most 40; usually 2 to 5. Accuracy: p on the surface to a few ulp; p and distance are exact
/// for an x moved by a few ulp of max(a_max, |x|). Ties (x in the plane across the smallest axis, inside the
/// focal disc; or at the centre): the + side of the smallest axis, the first of equal ones. A query that is
/// not finite: closest() gives the end of +x at the largest finite distance, penetration() no contact,
/// separated() false, raycast() no hit. Constructor reports bad axes or centre.
template <Real S>
class Ellipsoid {
 public:
  using Scalar = S;

  struct Params {
    Vec3<S> axes{S(0.03), S(0.02), S(0.02)};  ///< semi-axes a_i [m]
    Vec3<S> centre = Vec3<S>::Zero();         ///< m [m]
  };

  explicit Ellipsoid(const Params& params) : p_(params) {
    for (int i = 0; i < 3; ++i)
      detail::require_size(p_.axes[i], "Ellipsoid", "axes [m] must be in [1e-6, 1e6]");
    detail::require_ratio(p_.axes, S(1000), "Ellipsoid", "ratio of axes must be at most 1000");
    detail::require_centre(p_.centre, "Ellipsoid");
    int smallest = 0;
    min_ = p_.axes.minCoeff(&smallest);
    for (int i = 0; i < 3; ++i) {
      const S a = p_.axes[i];
      ratio_[i] = (a / min_) * (a / min_);
      gap_[i] = ((a - min_) / min_) * ((a + min_) / min_);
      slope_[i] = min_ / a;
      inverse_[i] = S(1) / a;
    }
    inverse_min_ = S(1) / min_;
    // Stands for 0 along the smallest axis, where it picks the + side; its square is still a normal number.
    tie_[smallest] = sizeof(S) == sizeof(float) ? S(1e-18L) : S(1e-150L);
  }

  /// Closest point of the surface.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    Vec3<S> r = x - p_.centre;
    if (!is_finite(r))
      return detail::nowhere<S>(p_.centre + Vec3<S>(p_.axes.x(), S(0), S(0)), Vec3<S>::UnitX());
    // Beyond this the closest point depends on the direction only, to rounding; nothing overflows before it.
    const S limit = S(1e4) / std::numeric_limits<S>::epsilon() * p_.axes.maxCoeff();
    const S size = r.cwiseAbs().maxCoeff();
    if (size > limit) {
      const Foot foot = solve(r / size * limit);
      const Vec3<S> p = p_.axes.cwiseProduct(foot.q);
      const S distance = size * (r / size - p / size).norm();
      return {p_.centre + p, foot.normal, is_finite(distance) ? distance : (std::numeric_limits<S>::max)()};
    }
    const Foot foot = solve(r);
    return {p_.centre + p_.axes.cwiseProduct(foot.q), foot.normal, foot.distance};
  }

  /// Depth below the closest point and the outward normal there; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    const S g = r.cwiseProduct(inverse_).squaredNorm();
    if (!is_finite(g) || !(g < S(1))) return {S(0), Vec3<S>::Zero()};
    return penetration_inside(r);
  }

  /// The same of a batch.
  void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    using V = detail::Simd<S, (std::min)(2 * detail::native_size<S>, static_cast<int>(batch_size))>;
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      V depth;
      detail::SimdVec3<V> n;
      if (near_surface(detail::load_from<V>(x, i, p_.centre), depth, n))
        detail::store(in, i, depth, n);
      else
        detail::penetrate_one_by_one(*this, x, in, i, V::size());
    }
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept {
    const S g = (x - p_.centre).cwiseProduct(inverse_).squaredNorm();
    return is_finite(g) && g < S(1);
  }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0.
  /// Box test, then |c_i / a_i| > 1 + r / a_min: that scaled ellipsoid contains the body grown by r, because
  /// its support function (1 + r / a_min) h(n) >= h(n) + r, as h(n) >= a_min.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const Vec3<S> d = c - p_.centre;
    if (!is_finite(d) || !is_finite(r) || r < S(0)) return false;
    for (int i = 0; i < 3; ++i)
      if (std::abs(d[i]) > (p_.axes[i] + r) * detail::separation_guard<S>) return true;
    const S g = d.cwiseProduct(inverse_).squaredNorm(),
            grown = (S(1) + r * inverse_min_) * detail::separation_guard<S>;
    return is_finite(g) && g > grown * grown;
  }

  /// First hit at t >= 0; from inside, where the ray leaves. Direction of any length; zero or not finite: no
  /// hit.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const S scale = detail::ray_scale(origin, d);
    if (!(scale > S(0))) return detail::no_hit<S>();
    const Vec3<S> o = (origin - p_.centre).cwiseQuotient(p_.axes), e = (d / scale).cwiseProduct(slope_);
    S t_in, t_out;
    if (!detail::unit_ball_interval(o, e, t_in, t_out) || t_out < S(0)) return detail::no_hit<S>();
    const S t = t_in >= S(0) ? t_in : t_out, along = t / scale * min_;
    if (!is_finite(along)) return detail::no_hit<S>();
    const Vec3<S> q = (o + t * e).normalized();
    return {true, p_.centre + p_.axes.cwiseProduct(q), along};
  }

  /// Principal curvatures at a surface point, from the implicit form's Hessian; the smaller one from the
  /// Gaussian curvature 1 / (a_1 a_2 a_3 |g|^2)^2, which does not cancel.
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& p) const noexcept {
    const Vec3<S> r = (p - p_.centre).cwiseQuotient(p_.axes);
    const Vec3<S> g = r.cwiseProduct(slope_);  // gradient times a_min
    const S m = g.norm();
    if (!is_finite(m) || !(m > (std::numeric_limits<S>::min)())) return curvature(closest(p).position);
    const Mat3<S> W = (slope_.cwiseAbs2() / (min_ * m)).asDiagonal();
    Curvature<S> c = detail::principal<S>(g / m, W);
    const S volume_ratio = slope_.prod() / (m * m);
    const S flatter = volume_ratio * volume_ratio / (min_ * min_ * c.k1);
    c.k2 = flatter < c.k1 ? flatter : c.k1;
    return c;
  }
  /// Outward unit normal at a surface point.
  [[nodiscard]] Vec3<S> normal(const Vec3<S>& p) const noexcept {
    return unit_or<S>((p - p_.centre).cwiseQuotient(p_.axes).cwiseProduct(slope_), Vec3<S>::UnitX());
  }

  /// Image of the unit sphere's longitude 2 pi u about z and colatitude pi v; u, v are clamped to [0, 1].
  [[nodiscard]] Vec3<S> point(S u, S v) const noexcept {
    return p_.centre + p_.axes.cwiseProduct(detail::direction(u, v));
  }
  /// The finest image of a cube-sphere with at most `vertices` (>= 8) vertices, all on the surface. Triangles
  /// differ in area by less than 2 a_max / a_min.
  [[nodiscard]] MeshData<S> mesh(std::size_t vertices) const {
    detail::require_vertices(vertices, "Ellipsoid");
    return detail::lattice_mesh<S>(detail::equal_cells(vertices), [this](const Vec3<S>& c) -> Vec3<S> {
      return p_.centre + p_.axes.cwiseProduct(detail::cube_to_sphere(c));
    });
  }

  /// a_min^2 / a_max: the smallest radius of curvature.
  [[nodiscard]] S reach() const noexcept { return min_ * (min_ / p_.axes.maxCoeff()); }
  [[nodiscard]] S volume() const noexcept { return detail::four_pi_thirds<S> * p_.axes.prod(); }
  [[nodiscard]] Vec3<S> lower() const noexcept { return p_.centre - p_.axes; }
  [[nodiscard]] Vec3<S> upper() const noexcept { return p_.centre + p_.axes; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

  static constexpr int max_iterations = 40;  ///< of the closest point

 private:
  static constexpr S tolerance = S(8) * std::numeric_limits<S>::epsilon();  // of |q|^2 = 1

  struct Foot {
    Vec3<S> q;  // closest point / a_i, |q| = 1
    Vec3<S> normal;
    S distance;
  };

  // A function of its own: a tick out of reach does not set up the registers of one in contact.
  [[nodiscard]] Penetration<S> penetration_inside(const Vec3<S>& r) const noexcept {
    S depth;
    detail::SimdVec3<S> n;
    if (near_surface<S>({r.x(), r.y(), r.z()}, depth, n)) return {depth, Vec3<S>(n.x, n.y, n.z)};
    const Foot foot = solve(r);
    return {-foot.distance, foot.normal};
  }

  // Penetration near the surface of points at r from the centre, 0 outside. False where one is too deep for
  // this or not finite: then nothing is said of any. As solve() with s = w - 1 and q_i = z_i / (1 + s j_i),
  // j_i = (a_min / a_i)^2; but the first step needs no division by 1 + s j_i, and after the second the change
  // of q is small enough for three terms of its series.
  template <class V>
  [[nodiscard]] PALPATE_INLINE bool near_surface(const detail::SimdVec3<V>& r, V& depth,
                                                 detail::SimdVec3<V>& normal) const noexcept {
    using detail::abs, detail::reduce, detail::reduce_max, detail::reduce_min, detail::select, detail::sqrt;
    const Vec3<S> j = slope_.cwiseAbs2();
    const V zx = r.x * inverse_.x(), zy = r.y * inverse_.y(), zz = r.z * inverse_.z();
    V qx = zx * zx, qy = zy * zy, qz = zz * zz, G = qx + qy + qz, f = G - S(1);
    const auto inside = f < V{};
    const bool usable = is_finite(reduce(G)) && reduce_min(G) > S(0.25);  // |z| > 1/2
    // 1 / H, and sqrt(G) - 1 by its continued fraction: by one division, but of a single point, which waits
    // for results and not for the divider.
    const V h = qx * j.x() + qy * j.y() + qz * j.z(), below = S(16) + f * (S(12) + f);
    V per_h, per_below;
    if constexpr (Real<V>) {
      per_h = S(1) / h, per_below = S(1) / below;
    } else {
      const V per = S(1) / (h * below);
      per_h = below * per, per_below = h * per;
    }
    V s = step<V>(G, f * (S(8) + S(4) * f) * per_below, per_h, qx * (j.x() * j.x()), qy * (j.y() * j.y()),
                  qz * (j.z() * j.z()), j.x(), j.y(), j.z());
    bool settled = false;
    for (int k = 0; k < 3 && !settled; ++k) {
      const V dx = S(1) + s * j.x(), dy = S(1) + s * j.y(), dz = S(1) + s * j.z();
      V vx, vy, vz;
      if constexpr (Real<V>) {
        vx = S(1) / dx, vy = S(1) / dy, vz = S(1) / dz;
      } else {
        const V dyz = dy * dz, v = S(1) / (dx * dyz), vdx = v * dx;
        vx = v * dyz, vy = vdx * dz, vz = vdx * dy;
      }
      const V ux = vx * j.x(), uy = vy * j.y(), uz = vz * j.z();
      const V px = zx * vx, py = zy * vy, pz = zz * vz;
      qx = px * px, qy = py * py, qz = pz * pz, G = qx + qy + qz, f = G - S(1);
      const V hx = qx * ux, hy = qy * uy, hz = qz * uz;
      // f is small by now: four terms of the series of sqrt(1 + f) - 1.
      const V t = f * (S(0.5) - f * (S(0.125) - f * (S(0.0625) - f * S(0.0390625))));
      const V change = step<V>(G, t, S(1) / (hx + hy + hz), hx * ux, hy * uy, hz * uz, ux, uy, uz);
      const V ex = ux * change, ey = uy * change, ez = uz * change;
      // 1 - e + e^2 - e^3
      const V ex2 = ex * ex, ey2 = ey * ey, ez2 = ez * ez;
      qx = px - px * ex, qy = py - py * ey, qz = pz - pz * ez;
      qx += qx * ex2, qy += qy * ey2, qz += qz * ez2;
      s += change;
      // |q| may be 1 by chance before the step is small enough for its series: their next terms count too.
      const V e = ex2 + ey2 + ez2;
      const V wrong = select(inside, abs(qx * qx + qy * qy + qz * qz - S(1)) + e * e, V{});
      settled = usable && is_finite(reduce(wrong)) && reduce_max(wrong) <= tolerance &&
                reduce_min(select(inside, s, V{})) > S(-0.75);  // w > 1/4, far from the poles
    }
    qx *= slope_.x(), qy *= slope_.y(), qz *= slope_.z();
    // The root and the division side by side.
    const V m2 = qx * qx + qy * qy + qz * qz, m = sqrt(m2), per_m = select(inside, m * (S(1) / m2), V{});
    depth = select(inside, s * (m * -min_), V{});
    normal = {qx * per_m, qy * per_m, qz * per_m};
    return settled;
  }

  // Step in w of order 4 towards |q| = 1, with G = |q|^2, t = |q| - 1, u_i = 1 / (w + r_i - 1), 1 / r = H =
  // sum u_i q_i^2 and k_i = u_i^2 q_i^2: Householder's third step for 1/|q| - 1.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE V step(const V& G, const V& t, const V& r, const V& kx, const V& ky,
                                             const V& kz, const V& ux, const V& uy, const V& uz) noexcept {
    const V g = G * r, k = (kx + ky + kz) * r * g, l = ((kx * ux + ky * uy + kz * uz) * r) * (g * g);
    const V e = S(1) - k;  // 0 for a sphere, as is 1 - l
    // In short chains.
    return (g * t) * ((S(1) - (S(1.5) * t) * e) + (t * t) * (S(4.5) * (e * e - e) + (S(2) - S(2) * l)));
  }

  // Closest point of r, relative to the centre; |r| below 1e4 a_max / epsilon.
  [[nodiscard]] Foot solve(const Vec3<S>& r) const noexcept {
    constexpr S epsilon = std::numeric_limits<S>::epsilon();
    const Vec3<S> z = r.cwiseAbs().cwiseProduct(inverse_) + tie_;
    const Vec3<S> rz = ratio_.cwiseProduct(z);
    Vec3<S> q = z, inverse = slope_.cwiseAbs2();  // q and 1 / (w + r_i - 1) at w = 1
    S w = S(1), G = z.squaredNorm();
    // Each term alone must stay below 1, which bounds w below; w + r_i - 1 >= w bounds it above.
    S low = ((S(1) - S(4) * epsilon) * rz - gap_).maxCoeff(), high = S(1);
    if (!(G < S(1))) high = rz.norm() * (S(1) + S(8) * epsilon);
    if (G > S(4)) {  // far outside the lower bound is the better start
      w = low;
      inverse = (gap_.array() + w).inverse();
      q = rz.cwiseProduct(inverse);
      G = q.squaredNorm();
    }
    S f_before = S(1), G_before = S(0);
    for (int k = 0; k < max_iterations; ++k) {
      const S f = G - S(1);
      if (std::abs(f) <= S(8) * epsilon) break;  // the answer for r / |q|
      (f > S(0) ? low : high) = w;
      // Halley's step for phi = 1/|q| - 1 with H = -G'/2, K = -H'/3, as one fraction; Newton's when it
      // overshoots.
      const Vec3<S> h = q.cwiseAbs2().cwiseProduct(inverse);
      const S H = h.sum(), K = h.dot(inverse), root = S(1) + std::sqrt(G);
      const S newton = root * H * H, halley = newton - S(1.5) * f * (K * G - H * H);
      const S next = w + G * f * H / (S(2) * halley > newton ? halley : newton);
      // Little gained: |f| / (G + 1) above a quarter of the last.
      const bool halve =
          !(next > low && next < high) || S(4) * std::abs(f) * (G_before + S(1)) > f_before * (G + S(1));
      w = halve ? std::sqrt(low * high) : next;
      f_before = halve ? S(8) : std::abs(f);
      G_before = G;
      inverse = (gap_.array() + w).inverse();
      q = rz.cwiseProduct(inverse);
      G = q.squaredNorm();
    }

    q *= S(1.5) - S(0.5) * G;  // 1 / sqrt(G), as G = 1 to rounding
    for (int i = 0; i < 3; ++i)
      if (r[i] < S(0)) q[i] = -q[i];
    const Vec3<S> g = q.cwiseProduct(slope_);
    const S m = g.norm();
    return {q, g / m, (w - S(1)) * min_ * m};
  }

  Params p_;
  Vec3<S> ratio_, gap_, slope_, inverse_;  // (a_i / a_min)^2, that minus 1, a_min / a_i, 1 / a_i
  Vec3<S> tie_ = Vec3<S>::Zero();
  S min_, inverse_min_;
};

static_assert(ParametricSurface<Ellipsoid<float>> && ParametricSurface<Ellipsoid<double>>);

}  // namespace palpate
