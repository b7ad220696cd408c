// SPDX-License-Identifier: MIT
#pragma once

/// @file  Superellipsoid: rounded boxes, pills and pillows between ellipsoid, cylinder and box.

#include <palpate/geometry/detail/lattice_mesh.hpp>
#include <palpate/geometry/detail/shape_tools.hpp>
#include <palpate/geometry/detail/superellipsoid_near.hpp>
#include <palpate/geometry/detail/superellipsoid_norm.hpp>

namespace palpate {

/// Superellipsoid N(x - m) = 1 with the nested norm [barr1981]
///
///     N(x) = ((|x/a1|^p + |y/a2|^p)^(q/p) + |z/a3|^q)^(1/q),   p = 2 / e2,   q = 2 / e1
///
/// | symbol | name     | unit | range                                                                 |
/// |--------|----------|------|-----------------------------------------------------------------------|
/// | a_i    | `axes`   | m    | [1e-6, 1e6] each, ratio at most 1 : 20                                |
/// | e1     | `e1`     | -    | [0.1, 1]: 1 is round along z, 0.1 nearly flat ends                    |
/// | e2     | `e2`     | -    | [0.1, 1]: 1 is round across z, 0.1 nearly a square                    |
/// | m      | `centre` | m    | finite, below 1e6                                                     |
///
/// In this range the body is convex and its normal Lipschitz; exponents above 1 (pinched or with edges) are
/// refused.
///
/// Closest point: descent on the distance in the octant of x by Newton steps in the tangent plane with the
/// principal curvatures k_i, (1 + d k_i) delta_i = tau_i, d signed distance, tau tangential part of x - p;
/// pulled back to the surface along the radius, halved until the distance falls. At most 60 steps a descent,
/// 5 descents. Starts from the nearest of the radial projection and the projections along the axes.
/// Guarantee: a foot point found outside is the closest point (the body is convex), and so is one found
/// inside at a depth below reach(), because feet shallower than the reach are unique. Deeper, the best of
/// several descents is taken. Accuracy: p on the surface and distance to a few ulp of max(a_i, |x|), and the
/// part of x - p across the normal as well down to the reach. penetration() has a shorter way above the
/// reach, many points at once (superellipsoid_near.hpp); what does not settle there goes this one. Ties
/// (planes of symmetry, deep inside): the + side. A query that is not finite: closest() gives the end of +x
/// at the largest finite distance, penetration() no contact, separated() false, raycast() no hit. Constructor
/// reports bad axes, exponents or centre.
template <Real S>
class Superellipsoid {
 public:
  using Scalar = S;

  struct Params {
    Vec3<S> axes{S(0.03), S(0.02), S(0.02)};  ///< semi-axes a_i [m]
    S e1{S(0.5)};                             ///< e1 [-]
    S e2{S(0.5)};                             ///< e2 [-]
    Vec3<S> centre = Vec3<S>::Zero();         ///< m [m]
  };

  explicit Superellipsoid(const Params& params)
      : p_(checked(params)),
        norm_{S(2) / p_.e2, S(2) / p_.e1},
        min_(p_.axes.minCoeff()),
        unit_(std::exp2(std::floor(std::log2(min_)))),
        near_(p_.axes / unit_, norm_.p, norm_.q) {
    for (std::size_t i = 0; i < seeds; ++i)
      for (std::size_t j = 0; j < seeds; ++j)
        seed_[i * seeds + j] =
            support((S(0.5) + static_cast<S>(i)) / seeds, (S(0.5) + static_cast<S>(j)) / seeds);
    reach_ = find_reach();
  }

  /// Closest point of the surface.
  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept {
    const Vec3<S> r = x - p_.centre;
    if (!is_finite(r))
      return detail::nowhere<S>(p_.centre + Vec3<S>(p_.axes.x(), S(0), S(0)), Vec3<S>::UnitX());
    // Beyond this the closest point depends on the direction only, to rounding.
    const S limit = S(1e3) / std::numeric_limits<S>::epsilon() * p_.axes.maxCoeff();
    const S size = r.cwiseAbs().maxCoeff();
    const bool far = size > limit;
    Foot foot = solve(far ? Vec3<S>(r.cwiseAbs() / size * limit) : Vec3<S>(r.cwiseAbs()));
    if (far) {
      foot.distance = size * (r.cwiseAbs() / size - foot.p / size).norm();
      if (!is_finite(foot.distance)) foot.distance = (std::numeric_limits<S>::max)();
    }
    return {p_.centre + signs_of(r, foot.p), signs_of(r, foot.normal), foot.distance};
  }

  /// Depth below the closest point and the outward normal there; outside {0, 0}.
  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    Penetration<S> in;
    near_surface<1>(&x.x(), &x.y(), &x.z(), &in.depth, &in.gradient.x(), &in.gradient.y(), &in.gradient.z());
    return in;
  }

  /// The same for N points. Chains of operations are long here: twice `batch_size` points take 0.87 of the
  /// time each.
  template <std::size_t N>
  void penetration(const PointBatch<S, N>& x, PenetrationBatch<S, N>& in) const noexcept {
    near_surface<static_cast<int>(N)>(x.x.data(), x.y.data(), x.z.data(), in.depth.data(),
                                      in.gradient_x.data(), in.gradient_y.data(), in.gradient_z.data());
  }

  [[nodiscard]] bool inside(const Vec3<S>& x) const noexcept {
    const Vec3<S> z = (x - p_.centre).cwiseAbs().cwiseQuotient(p_.axes);
    return is_finite(z) && z.maxCoeff() < S(1) && norm_.value(z) < S(1);
  }

  /// True only if no point of the ball (c, r) is inside; false when anything is not finite or r < 0. Box
  /// test, then N(c) > 1 + r / a_min: the body grown by r is within 1 + r / a_min times the body, as it holds
  /// the ball of a_min.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    const Vec3<S> d = (c - p_.centre).cwiseAbs();
    if (!is_finite(d) || !is_finite(r) || r < S(0)) return false;
    // Rounding of N: a few ulp for each power.
    constexpr S guard = S(1) + S(64) * std::numeric_limits<S>::epsilon();
    for (int i = 0; i < 3; ++i)
      if (d[i] > (p_.axes[i] + r) * guard) return true;
    const Vec3<S> z = d.cwiseQuotient(p_.axes);
    const S limit = (S(1) + r / min_) * guard;
    if (z.squaredNorm() <= limit * limit)
      return false;  // N is at most the length: its exponents are at least 2
    const S n = norm_.value(z);
    return is_finite(n) && n > limit;
  }

  /// First hit at t >= 0; from inside, where the ray leaves. Direction of any length; zero or not finite: no
  /// hit. N along the ray is convex, so Newton from the bounding box runs one way onto the root; at most 60
  /// steps. A ray that grazes within sqrt(epsilon) of N may count either way.
  [[nodiscard]] RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& d) const noexcept {
    const S scale = detail::ray_scale(origin, d);
    if (!(scale > S(0))) return detail::no_hit<S>();
    constexpr S epsilon = std::numeric_limits<S>::epsilon();
    const Vec3<S> o = (origin - p_.centre).cwiseQuotient(p_.axes);
    const Vec3<S> e = (d / scale).cwiseQuotient(p_.axes) * min_;
    const detail::Slab<S> slab = detail::slab_interval<S>(o, e, Vec3<S>::Ones());
    if (slab.empty || slab.t_out < S(0)) return detail::no_hit<S>();
    const S first = slab.t_in > S(0) ? slab.t_in : S(0);
    // On the box, N is 1 to rounding where the body is flat: from there the ray enters all the same.
    const bool entering = slab.t_in > S(0) || norm_.value(o.cwiseAbs()) > S(1);
    S t = entering ? first : slab.t_out, excess = S(1);
    Vec3<S> z = o + t * e;
    for (int k = 0; k < 60; ++k) {
      const detail::NormJet<S> jet = norm_.jet(z.cwiseAbs());
      excess = jet.value - S(1);
      if (excess <= S(8) * epsilon) break;
      const S slope = signs_of(z, jet.gradient).dot(e);
      if (entering ? slope >= S(0) : slope <= S(0)) break;
      const S next = t - excess / slope;
      if (next == t) break;
      t = next;
      z = o + t * e;
    }
    const S along = t / scale * min_;
    if (!(std::abs(excess) <= std::sqrt(epsilon)) || t < S(0) || !is_finite(along))
      return detail::no_hit<S>();
    return {true, p_.centre + p_.axes.cwiseProduct(z / norm_.value(z.cwiseAbs())), along};
  }

  /// Principal curvatures at a surface point; 0 on the flats (planes of symmetry where an exponent is below
  /// 1). Where p > q = 2 the curvature at the ends of z depends on the direction of approach; the diagonal's
  /// is given.
  [[nodiscard]] Curvature<S> curvature(const Vec3<S>& p) const noexcept {
    const Vec3<S> r = p - p_.centre;
    const Frame f = frame(r.cwiseAbs());
    return {f.bend.k1, f.bend.k2, signs_of(r, f.bend.dir1), signs_of(r, f.bend.dir2)};
  }
  /// Outward unit normal at a surface point.
  [[nodiscard]] Vec3<S> normal(const Vec3<S>& p) const noexcept {
    const Vec3<S> r = p - p_.centre;
    return signs_of(r, frame(r.cwiseAbs()).normal);
  }

  /// Where the direction of longitude 2 pi u about z and colatitude pi v, stretched by a_i, leaves the body;
  /// u, v are clamped to [0, 1].
  [[nodiscard]] Vec3<S> point(S u, S v) const noexcept {
    return p_.centre + p_.axes.cwiseProduct(on_surface(detail::direction(u, v)));
  }
  /// The finest image of a cube-sphere with at most `vertices` (>= 8) vertices, all on the surface. Triangles
  /// of a body with equal axes differ in area by less than 5 from 100 vertices on; unequal axes multiply that
  /// by their ratio.
  [[nodiscard]] MeshData<S> mesh(std::size_t vertices) const {
    detail::require_vertices(vertices, "Superellipsoid");
    return detail::lattice_mesh<S>(detail::equal_cells(vertices), [this](const Vec3<S>& c) -> Vec3<S> {
      return p_.centre + p_.axes.cwiseProduct(on_surface(detail::cube_to_sphere(c)));
    });
  }

  /// Least of a_min, half of the least extent, and the smallest radius of curvature, found at set-up on
  /// a grid of normals, refined, and lowered by 1 %.
  [[nodiscard]] S reach() const noexcept { return reach_; }
  /// 2 a1 a2 a3 e1 e2 B(e1/2 + 1, e1) B(e2/2, e2/2), B the beta function [barr1981].
  [[nodiscard]] S volume() const {
    const auto beta = [](S u, S v) { return std::tgamma(u) * std::tgamma(v) / std::tgamma(u + v); };
    return S(2) * p_.axes.prod() * p_.e1 * p_.e2 * beta(p_.e1 / S(2) + S(1), p_.e1) *
           beta(p_.e2 / S(2), p_.e2 / S(2));
  }
  [[nodiscard]] Vec3<S> lower() const noexcept { return p_.centre - p_.axes; }
  [[nodiscard]] Vec3<S> upper() const noexcept { return p_.centre + p_.axes; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  static constexpr std::size_t seeds = 5;
  static constexpr int max_steps = 60;

  struct Frame {  // of a surface point in the positive octant
    Vec3<S> normal;
    Curvature<S> bend;
  };
  struct Foot {
    Vec3<S> p, normal;
    S distance;
  };

  [[nodiscard]] static const Params& checked(const Params& p) {
    for (int i = 0; i < 3; ++i)
      detail::require_size(p.axes[i], "Superellipsoid", "axes [m] must be in [1e-6, 1e6]");
    detail::require_ratio(p.axes, S(20), "Superellipsoid", "ratio of axes must be at most 20");
    require_exponent(p.e1, "exponent e1 must be in [0.1, 1]");
    require_exponent(p.e2, "exponent e2 must be in [0.1, 1]");
    detail::require_centre(p.centre, "Superellipsoid");
    return p;
  }
  static void require_exponent(S e, const char* rule) {
    constexpr S slack = S(4) * std::numeric_limits<S>::epsilon();
    if (!is_finite(e) || !(e >= S(0.1) - slack && e <= S(1)))
      fail("Superellipsoid", rule, static_cast<double>(e));
  }
  // Penetration of N points: at once, and the general way for those that are too deep for that or do not
  // settle.
  template <int N>
  PALPATE_FLATTEN void near_surface(const S* x, const S* y, const S* z, S* depth, S* nx, S* ny,
                                    S* nz) const noexcept {
    using V = std::conditional_t<N == 1, S, detail::native_simd<S>>;
    using detail::abs, detail::load, detail::select, detail::store;
    const S per_unit = S(1) / unit_;
    const std::array<const S*, 3> at{x, y, z};
    const std::array<S*, 3> n{nx, ny, nz};
    const auto from_centre = [&](std::size_t axis, std::size_t i) -> V {
      return load<V>(at[axis] + i) - p_.centre[static_cast<Eigen::Index>(axis)];
    };
    typename detail::SuperellipsoidNear<S>::template Axes<N> r;
    for (std::size_t i = 0; i < N; i += detail::size_of<V>)
      for (std::size_t axis = 0; axis < 3; ++axis) store(&r[axis][i], abs(from_centre(axis, i)) * per_unit);
    typename detail::SuperellipsoidNear<S>::template Result<N> near;
    near_.template solve<N>(r, near);
    std::array<S, static_cast<std::size_t>(N)> left;
    bool any_left = false;
    for (std::size_t i = 0; i < N; i += detail::size_of<V>) {
      const V below = load<V>(&near.depth[i]) * unit_, zero{};
      const detail::MaskOf<V> is_near = load<V>(&near.near[i]) > zero,
                              settled = is_near && load<V>(&near.settled[i]) > zero && below < reach_,
                              inside = settled && below > zero, other = is_near && !settled;
      store(depth + i, select(inside, below, zero));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const V normal = load<V>(&near.normal[axis][i]);
        const V turned = select(from_centre(axis, i) < zero, -normal, normal);
        store(n[axis] + i, select(inside, turned, zero));
      }
      store(&left[i], select(other, V(S(1)), zero));
      any_left |= detail::any_of(other);
    }
    if (!any_left) return;
    for (std::size_t i = 0; i < N; ++i) {
      if (!(left[i] > S(0))) continue;
      const Vec3<S> away = Vec3<S>(x[i], y[i], z[i]) - p_.centre;
      const Foot foot = solve(away.cwiseAbs());
      if (!(foot.distance < S(0))) continue;
      const Vec3<S> normal = signs_of(away, foot.normal);
      depth[i] = -foot.distance, nx[i] = normal.x(), ny[i] = normal.y(), nz[i] = normal.z();
    }
  }

  // v with the sign of r.
  [[nodiscard]] static S with_sign(S r, S v) noexcept { return r < S(0) ? -v : v; }
  [[nodiscard]] static Vec3<S> signs_of(const Vec3<S>& r, const Vec3<S>& v) noexcept {
    return Vec3<S>(with_sign(r.x(), v.x()), with_sign(r.y(), v.y()), with_sign(r.z(), v.z()));
  }
  [[nodiscard]] Vec3<S> on_surface(const Vec3<S>& z) const noexcept { return z / norm_.value(z.cwiseAbs()); }

  [[nodiscard]] Frame frame(const Vec3<S>& p) const noexcept {
    const detail::NormJet<S> jet = norm_.jet(p.cwiseQuotient(p_.axes));
    const Vec3<S> stretch = min_ * p_.axes.cwiseInverse();
    const Vec3<S> g = jet.gradient.cwiseProduct(stretch);
    const S m = g.norm();
    if (!is_finite(m) || !(m > S(0)))
      return {Vec3<S>::UnitX(), detail::principal<S>(Vec3<S>::UnitX(), Mat3<S>::Zero())};
    const Mat3<S> W = stretch.asDiagonal() * jet.hessian * stretch.asDiagonal() / (m * min_);
    const Vec3<S> n = g / m;
    return {n, detail::principal<S>(n, W)};
  }

  // Point of the octant with the outward normal along n >= 0, of any length.
  [[nodiscard]] Vec3<S> support(const Vec3<S>& n) const noexcept {
    return p_.axes.cwiseProduct(norm_.dual_gradient(n.cwiseProduct(p_.axes)));
  }
  // The same for longitude u pi/2 and colatitude v pi/2.
  [[nodiscard]] Vec3<S> support(S u, S v) const noexcept {
    return support(detail::direction<S>(u / S(4), v / S(2)).cwiseAbs());
  }

  [[nodiscard]] S find_reach() const noexcept {
    constexpr int grid = 64;
    const auto bend = [&](S u, S v) { return frame(support(u, v)).bend.k1; };
    S best = S(0), u = S(0), v = S(0);
    const auto look = [&](S a, S b) {
      const S k = bend(detail::unit_interval(a), detail::unit_interval(b));
      if (!(k > best)) return false;
      best = k, u = a, v = b;
      return true;
    };
    for (int i = 0; i <= grid; ++i)
      for (int j = 0; j <= grid; ++j) look(static_cast<S>(i) / grid, static_cast<S>(j) / grid);
    // To 1e-4 of an octant; 1 % less for what the search may have missed. Both chosen.
    for (S h = S(0.5) / grid; h > S(1e-4); h /= S(2))
      for (int k = 0; k < 8 && (look(u + h, v) || look(u - h, v) || look(u, v + h) || look(u, v - h)); ++k) {
      }
    const S radius = best > S(0) ? S(0.99) / best : min_;
    return radius < min_ ? radius : min_;
  }

  // r in the positive octant, relative to the centre.
  [[nodiscard]] Foot solve(Vec3<S> r) const noexcept {
    // Numbers near the least normal one lose their digits when they are multiplied.
    constexpr S tiny = (std::numeric_limits<S>::min)() / std::numeric_limits<S>::epsilon();
    for (S& c : r) c = c < tiny ? S(0) : c;
    const Vec3<S> z = r.cwiseQuotient(p_.axes);
    Vec3<S> start = p_.axes;
    S nearest = (std::numeric_limits<S>::max)();
    const auto offer = [&](const Vec3<S>& p) {
      const S distance = stable_norm<S>(p - r);
      if (is_finite(p) && distance < nearest) nearest = distance, start = p;
    };
    const S n = norm_.value(z);
    if (n > S(4)) return descend(r, support(r));
    if (n > std::numeric_limits<S>::epsilon()) offer(r / n);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3<S> q = z;
      if (norm_.project(axis, q)) offer(p_.axes.cwiseProduct(q));
    }
    Foot foot = descend(r, start);
    if (foot.distance > -reach_) return foot;
    // Deep: other feet may be nearer. Descend from the nearest few seeds as well.
    std::array<Vec3<S>, 4> from;
    std::array<S, 4> length;
    length.fill((std::numeric_limits<S>::max)());
    for (const Vec3<S>& seed : seed_) {
      const S square = (seed - r).squaredNorm();
      if (!(square < length.back())) continue;
      std::size_t at = from.size() - 1;
      for (; at > 0 && square < length[at - 1]; --at) length[at] = length[at - 1], from[at] = from[at - 1];
      length[at] = square, from[at] = seed;
    }
    for (const Vec3<S>& seed : from) {
      const Foot other = descend(r, seed);
      if (std::abs(other.distance) <
          std::abs(foot.distance) * (S(1) - S(64) * std::numeric_limits<S>::epsilon()))
        foot = other;
    }
    return foot;
  }

  [[nodiscard]] Foot descend(const Vec3<S>& r, Vec3<S> p) const noexcept {
    constexpr S epsilon = std::numeric_limits<S>::epsilon();
    const S scale = (std::max)(p_.axes.maxCoeff(), r.maxCoeff());
    Vec3<S> away = r - p;
    S square = away.squaredNorm();
    Frame f = frame(p);
    for (int k = 0; k < max_steps; ++k) {
      const S d = away.dot(f.normal);
      const Vec3<S> tau = tangential(away, f.normal);
      if (tau.cwiseAbs().maxCoeff() <= S(4) * epsilon * scale) break;
      // Newton where the distance is convex; elsewhere the same length downhill, at most 20 |tau| (chosen).
      const auto stiff = [&](S bend) { return (std::max)(std::abs(S(1) + d * bend), S(0.05)); };
      const S s1 = tau.dot(f.bend.dir1) / stiff(f.bend.k1), s2 = tau.dot(f.bend.dir2) / stiff(f.bend.k2);
      Vec3<S> step = s1 * f.bend.dir1 + s2 * f.bend.dir2;
      const int halvings = tau.cwiseAbs().maxCoeff() > std::sqrt(epsilon) * scale ? 12 : 2;
      const S slack = S(16) * epsilon * p_.axes.maxCoeff() * std::sqrt(square);  // roundings of p in the gain
      bool better = false;
      for (int halving = 0; halving < halvings && !better; ++halving, step /= S(2)) {
        const Vec3<S> z = (p + step).cwiseAbs().cwiseQuotient(p_.axes);
        const Vec3<S> trial = p_.axes.cwiseProduct(z / norm_.value(z)), trial_away = r - trial;
        const S gain = (trial - p).dot(away + trial_away);  // |away|^2 - |trial_away|^2 without cancellation
        if (!(gain > -slack)) continue;
        const Frame trial_frame = frame(trial);
        // Where lengths no longer tell points apart, the tangential part does.
        if (!(gain > slack) && !(S(2) * tangential(trial_away, trial_frame.normal).norm() < tau.norm()))
          continue;
        better = true;
        p = trial, away = trial_away, square = trial_away.squaredNorm(), f = trial_frame;
      }
      if (!better) break;
    }
    const S d = away.dot(f.normal), length = std::sqrt(square);
    return {p, f.normal, d < S(0) ? -length : length};
  }

  Params p_;
  detail::NestedNorm<S> norm_;
  S min_, reach_ = S(0);
  S unit_;  // of lengths for near_: a power of two, so that changing it rounds nothing
  detail::SuperellipsoidNear<S> near_;
  std::array<Vec3<S>, seeds * seeds> seed_;
};

static_assert(ParametricSurface<Superellipsoid<float>> && ParametricSurface<Superellipsoid<double>>);

}  // namespace palpate
