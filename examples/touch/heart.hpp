// SPDX-License-Identifier: MIT
#pragma once

/// @file A smooth heart: a surface of the example's own that meets ParametricSurface, with extremal points of
/// its own.

#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>
#include <palpate/geometry/extremal_points.hpp>

#include <array>
#include <cmath>

namespace touch {

/// Star-shaped body |x| < r(x/|x|) about the origin, y up: two lobes with a cleft between, a tip below.
///
///     r(u) = a (1 + sum_k h_k exp(kappa_k (u.m_k - 1)))
///
/// | symbol       | name        | unit | range                                                             |
/// |--------------|-------------|------|-------------------------------------------------------------------|
/// | a            | `size`      | m    | [1e-3, 1]                                                         |
/// | m, h, kappa  | `bumps`     | -    | unit directions, heights, sharpness; fixed by the shape           |
///
/// r is analytic, so closest() may use Newton's method: on the tangent plane, with the surface's own
/// curvature, back to the surface along the ray from the origin, a step taken only if it comes closer. It
/// starts from the point on the ray of x. Where that is nearer than reach() there is one critical point of
/// the distance within reach, which is the closest point [federer1959]; deeper, or far outside the cleft, the
/// answer is a local minimum. At most 25 steps.
class Heart {
 public:
  using Scalar = double;
  using S = double;
  using V = palpate::Vec3<double>;
  using M = palpate::Mat3<double>;

  struct Params {
    double size{0.036};  ///< a [m]
  };

  explicit Heart(const Params& params) : p_(params) {
    if (!(params.size >= 1e-3 && params.size <= 1))
      palpate::fail("Heart", "size [m] must be in [1e-3, 1]", params.size);
    measure();
  }

  [[nodiscard]] palpate::SurfacePoint<S> closest(const V& x) const noexcept {
    const double size = x.cwiseAbs().maxCoeff();
    if (!palpate::is_finite(x))
      return palpate::detail::nowhere<S>(on_ray(V::UnitX()), normal(on_ray(V::UnitX())));
    if (size > 1e6) {  // a direction is all that counts from there
      palpate::SurfacePoint<S> far = closest(V(x / size * 1e6));
      far.distance = (std::min)(size, 1e300);
      return far;
    }
    V p = on_ray(x);
    double square = (x - p).squaredNorm();
    for (int step = 0; step < 25; ++step) {
      const Local at = local(p, true);
      const V gap = x - p, across = gap - at.normal * at.normal.dot(gap);
      if (across.squaredNorm() <= 1e-28 * p.squaredNorm()) break;
      // Half the squared distance has the Hessian 1 + h W on the tangent plane, W the shape operator; kept
      // positive.
      const palpate::Curvature<S> c = palpate::detail::principal<S>(at.normal, at.shape);
      const double h = at.normal.dot(gap);
      V move = c.dir1 * (c.dir1.dot(across) / (std::max)(0.1, 1 + h * c.k1)) +
               c.dir2 * (c.dir2.dot(across) / (std::max)(0.1, 1 + h * c.k2));
      bool closer = false;
      for (int halving = 0; halving < 8 && !closer; ++halving, move *= 0.5) {
        const V q = on_ray(p + move);
        const double next = (x - q).squaredNorm();
        if (next < square) p = q, square = next, closer = true;
      }
      if (!closer) break;  // rounding
    }
    const V n = normal(p);
    const double distance = std::sqrt(square);
    return {p, n, implicit(x) < 0 ? -distance : distance};
  }

  [[nodiscard]] palpate::Penetration<S> penetration(const V& x) const noexcept {
    if (!palpate::is_finite(x) || x.squaredNorm() > largest_ * largest_ || !(implicit(x) < 0))
      return {0, V::Zero()};
    const palpate::SurfacePoint<S> foot = closest(x);
    return {-foot.distance, foot.normal};
  }

  /// |x| - r is Lipschitz with `slope_` outside the body, and the shortest way to it stays outside.
  [[nodiscard]] bool separated(const V& c, S r) const noexcept {
    if (!palpate::is_finite(c) || !palpate::is_finite(r) || r < 0) return false;
    const double length = c.norm();
    if (length > (largest_ + r) * palpate::detail::separation_guard<S>) return true;
    return implicit(c) > slope_ * r * palpate::detail::separation_guard<S>;
  }

  /// Sphere tracing with the same bound, then bisection. Its steps shrink at a grazing ray; after 400 it is a
  /// miss.
  [[nodiscard]] palpate::RayHit<S> raycast(const V& origin, const V& d) const noexcept {
    const double length = d.norm();
    if (!palpate::is_finite(origin) || !palpate::is_finite(d) || !(length > 0))
      return palpate::detail::no_hit<S>();
    const V u = d / length;
    const bool outside = implicit(origin) > 0;
    double t = 0, step = 0;
    for (int i = 0; i < 400; ++i) {
      const V x = origin + t * u;
      const double rho = x.norm(), f = implicit(x);
      if (outside && rho > largest_ && x.dot(u) > 0) break;
      if (i > 0 && (f > 0) != outside) return refine(origin, u, t - step, t, length);
      // From inside: a fixed small step; the body is fat, so no thin wall is missed.
      step = outside ? (std::max)(1e-5 * p_.size, f / slope_) : 0.01 * p_.size;
      t += step;
    }
    return palpate::detail::no_hit<S>();
  }

  [[nodiscard]] palpate::Curvature<S> curvature(const V& p) const noexcept {
    const Local at = local(p, true);
    return palpate::detail::principal<S>(at.normal, at.shape);
  }
  [[nodiscard]] V normal(const V& p) const noexcept { return local(p, false).normal; }
  [[nodiscard]] V point(S u, S v) const noexcept { return on_ray(palpate::detail::direction<S>(u, v)); }
  [[nodiscard]] palpate::MeshData<S> mesh(std::size_t vertices) const {
    palpate::detail::require_vertices(vertices, "Heart");
    return palpate::detail::lattice_mesh<S>(palpate::detail::equal_cells(vertices), [this](const V& c) -> V {
      return on_ray(palpate::detail::cube_to_sphere(c));
    });
  }

  [[nodiscard]] S reach() const noexcept { return reach_; }
  [[nodiscard]] S volume() const noexcept { return volume_; }
  [[nodiscard]] V lower() const noexcept { return lower_; }
  [[nodiscard]] V upper() const noexcept { return upper_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }
  /// The surface point in the direction of x.
  [[nodiscard]] V on_ray(const V& x) const noexcept {
    const V u = palpate::unit_or<S>(x, V::UnitY());
    return radius(u) * u;
  }

  static constexpr std::size_t bump_count = 9;
  /// Lobes, cleft, tip, front, back; then what refines cleft and tip.
  [[nodiscard]] V bump(std::size_t k) const noexcept { return on_ray(bumps[k].direction); }

 private:
  struct Bump {
    V direction;
    double height, sharpness;
  };
  static inline const std::array<Bump, bump_count> bumps{
      {{V(-0.6, 0.8, 0), 0.5, 5},  // lobes
       {V(0.6, 0.8, 0), 0.5, 5},
       {V(0, 1, 0), -0.5, 7},   // the cleft, from front to back
       {V(0, -1, 0), 0.42, 4},  // tip
       {V(0, 0, 1), -0.3, 2},   // flatter than wide
       {V(0, 0, -1), -0.3, 2},
       {V(0, 0.8, 0.6), -0.18, 8},
       {V(0, 0.8, -0.6), -0.18, 8},
       {V(0, -1, 0), 0.26, 18}}};  // the tip's point

  struct Local {
    V normal;
    M shape;  // Hessian of |x| - r over its gradient's length
  };

  [[nodiscard]] double radius(const V& u) const noexcept {
    double sum = 1;
    for (const Bump& b : bumps) sum += b.height * std::exp(b.sharpness * (u.dot(b.direction) - 1));
    return p_.size * sum;
  }
  [[nodiscard]] double implicit(const V& x) const noexcept {
    const double length = x.norm();
    return length > 0 ? length - radius(x / length) : -p_.size;
  }
  [[nodiscard]] Local local(const V& x, bool with_shape) const noexcept {
    const double rho = x.norm();
    const V u = x / rho;
    V g = V::Zero();  // of r, as a function of u in space
    M H = M::Zero();
    for (const Bump& b : bumps) {
      const double first =
          p_.size * b.height * b.sharpness * std::exp(b.sharpness * (u.dot(b.direction) - 1));
      g += first * b.direction;
      if (with_shape) H += first * b.sharpness * b.direction * b.direction.transpose();
    }
    const M P = M::Identity() - u * u.transpose();
    const V across = P * g, gradient = u - across / rho;
    const double slope = gradient.norm();
    Local at{gradient / slope, M::Zero()};
    if (!with_shape) return at;
    const M second = P * H * P - g.dot(u) * P - across * u.transpose() - u * across.transpose();
    at.shape = (P / rho - second / (rho * rho)) / slope;
    return at;
  }

  [[nodiscard]] palpate::RayHit<S> refine(const V& origin, const V& u, double low, double high,
                                          double length) const noexcept {
    const bool sign = implicit(origin + low * u) > 0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      ((implicit(origin + middle * u) > 0) == sign ? low : high) = middle;
    }
    return {true, origin + high * u, high / length};
  }

  // Bounds for the queries. The slope's is rigorous (each bump at its steepest); reach is taken from a fine
  // sampling.
  void measure() {
    double steepest = 0;
    for (const Bump& b : bumps) {
      const double k = b.sharpness, c = (std::sqrt(1 + 4 * k * k) - 1) / (2 * k);
      steepest += std::abs(b.height) * k * std::sqrt(1 - c * c) * std::exp(k * (c - 1));
    }
    const palpate::MeshData<S> fine = mesh(6000);
    double smallest = fine.vertices.front().norm(), sharpest = 0, secant = 1;
    lower_ = upper_ = fine.vertices.front();
    for (const V& p : fine.vertices) {
      smallest = (std::min)(smallest, p.norm());
      largest_ = (std::max)(largest_, p.norm());
      lower_ = lower_.cwiseMin(p), upper_ = upper_.cwiseMax(p);
      const Local at = local(p, true);
      const palpate::Curvature<S> c = palpate::detail::principal<S>(at.normal, at.shape);
      sharpest = (std::max)({sharpest, c.k1, -c.k2});
      secant = (std::max)(secant, p.norm() / at.normal.dot(p));
    }
    for (const auto& t : fine.triangles)
      volume_ += fine.vertices[t[0]].dot(fine.vertices[t[1]].cross(fine.vertices[t[2]])) / 6;
    // Between samples, 0.03 rad apart at most, r changes by less than this.
    const double between = 0.03 * steepest * p_.size;
    largest_ += between;
    slope_ = std::hypot(1.0, steepest * p_.size / (smallest - between));
    reach_ = 0.9 / (sharpest * secant);
  }

  Params p_;
  double largest_ = 0, slope_ = 1, reach_ = 0, volume_ = 0;
  V lower_ = V::Zero(), upper_ = V::Zero();
};

static_assert(palpate::ParametricSurface<Heart>);

/// The extremal points of our own choice: the lobes, the cleft, the tip, front, back, and the two flanks.
[[nodiscard]] inline std::vector<palpate::ExtremalPoint<double>> extremal_points(const Heart& heart) {
  std::vector<palpate::ExtremalPoint<double>> points;
  const auto add = [&](const Heart::V& p) { points.push_back({p, heart.normal(p)}); };
  for (std::size_t k = 0; k < 6; ++k) add(heart.bump(k));
  add(heart.on_ray(Heart::V(-1, -0.1, 0)));
  add(heart.on_ray(Heart::V(1, -0.1, 0)));
  return points;
}

}  // namespace touch
