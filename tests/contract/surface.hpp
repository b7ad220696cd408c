// SPDX-License-Identifier: MIT
#pragma once

/// @file  What every exact surface must keep (geometry/concept.hpp), run on examples of each.

#include "support/check.hpp"

#include <palpate/core/error.hpp>
#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace palpate::test {

constexpr std::uint64_t surface_seed = 20250711;

using Long3 = Vec3<long double>;

/// An exact surface of whatever type, so that the suite is compiled once for all of them.
template <Real S>
struct AnySurface {
  virtual ~AnySurface() = default;
  [[nodiscard]] virtual SurfacePoint<S> closest(const Vec3<S>& x) const = 0;
  [[nodiscard]] virtual Penetration<S> penetration(const Vec3<S>& x) const = 0;
  [[nodiscard]] virtual bool inside(const Vec3<S>& x) const = 0;
  [[nodiscard]] virtual bool separated(const Vec3<S>& centre, S radius) const = 0;
  [[nodiscard]] virtual RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& direction) const = 0;
  [[nodiscard]] virtual Curvature<S> curvature(const Vec3<S>& x) const = 0;
  [[nodiscard]] virtual Vec3<S> point(S u, S v) const = 0;
  [[nodiscard]] virtual MeshData<S> mesh(std::size_t vertices) const = 0;
  [[nodiscard]] virtual Vec3<S> lower() const = 0;
  [[nodiscard]] virtual Vec3<S> upper() const = 0;
  [[nodiscard]] virtual S reach() const = 0;
  [[nodiscard]] virtual S volume() const = 0;
  /// Many points at once: false where the surface has no such function.
  virtual bool penetration(const PointBatch<S>& x, PenetrationBatch<S>& out) const = 0;
  virtual bool penetration(const PointBatch<S, 2 * batch_size>& x,
                           PenetrationBatch<S, 2 * batch_size>& out) const = 0;
};

template <ParametricSurface Body, Real S = typename Body::Scalar>
class Surface final : public AnySurface<S> {
 public:
  explicit Surface(Body body) : body_(std::move(body)) {}
  SurfacePoint<S> closest(const Vec3<S>& x) const override { return body_.closest(x); }
  Penetration<S> penetration(const Vec3<S>& x) const override { return body_.penetration(x); }
  bool inside(const Vec3<S>& x) const override { return body_.inside(x); }
  bool separated(const Vec3<S>& centre, S radius) const override { return body_.separated(centre, radius); }
  RayHit<S> raycast(const Vec3<S>& origin, const Vec3<S>& direction) const override {
    return body_.raycast(origin, direction);
  }
  Curvature<S> curvature(const Vec3<S>& x) const override { return body_.curvature(x); }
  Vec3<S> point(S u, S v) const override { return body_.point(u, v); }
  MeshData<S> mesh(std::size_t vertices) const override { return body_.mesh(vertices); }
  Vec3<S> lower() const override { return body_.lower(); }
  Vec3<S> upper() const override { return body_.upper(); }
  S reach() const override { return body_.reach(); }
  S volume() const override { return body_.volume(); }
  bool penetration(const PointBatch<S>& x, PenetrationBatch<S>& out) const override {
    if constexpr (HasPenetrationBatch<Body>) body_.penetration(x, out);
    return HasPenetrationBatch<Body>;
  }
  bool penetration(const PointBatch<S, 2 * batch_size>& x,
                   PenetrationBatch<S, 2 * batch_size>& out) const override {
    if constexpr (HasPenetrationBatch<Body, 2 * batch_size>) body_.penetration(x, out);
    return HasPenetrationBatch<Body, 2 * batch_size>;
  }

 private:
  Body body_;
};

/// The suite. `make(scale)` builds the body with every length times `scale`, centre included; `gauge(x)` is
/// independent of the code under test: 1 on the surface, below 1 inside, growing in proportion along rays
/// from the centre, which is at `centre`. `area_ratio` is the stated evenness of the mesh.
template <Real S>
class SurfaceSuite {
 public:
  using Body = std::unique_ptr<const AnySurface<S>>;

  SurfaceSuite(std::function<Body(S)> make, std::function<long double(const Long3&)> gauge,
               const Vec3<S>& centre, double area_ratio)
      : make_(std::move(make)),
        made_(make_(S(1))),
        gauge_(std::move(gauge)),
        centre_(centre),
        area_ratio_(area_ratio),
        samples_(body_.mesh(1500)),
        half_((body_.upper() - body_.lower()) / S(2)),
        size_(half_.maxCoeff()),
        rounding_(ulps<S>(1) * static_cast<long double>(size_ + centre.cwiseAbs().maxCoeff())) {}

  void run() {
    INFO("seed ", surface_seed, ", half sizes ", half_.x(), " ", half_.y(), " ", half_.z());
    closest();
    penetration();
    penetration_batch<batch_size>();
    penetration_batch<2 * batch_size>();
    continuity();
    separated();
    raycast();
    curvature();
    point();
    mesh();
    units();
    not_finite();
  }

 private:
  Long3 wide(const Vec3<S>& v) const { return v.template cast<long double>(); }
  long double gauge(const Vec3<S>& x) const { return gauge_(wide(x) - wide(centre_)); }
  S uniform() { return static_cast<S>(std::uniform_real_distribution<double>(-1, 1)(random_)); }
  Vec3<S> within(S factor) {
    return centre_ + factor * half_.cwiseProduct(Vec3<S>(uniform(), uniform(), uniform()));
  }
  Vec3<S> on_surface() { return body_.point((uniform() + S(1)) / S(2), (uniform() + S(1)) / S(2)); }
  // A point at most `depth` below the surface.
  Vec3<S> below(S depth) {
    const SurfacePoint<S> p = body_.closest(on_surface());
    return p.position - (uniform() + S(1)) / S(2) * depth * p.normal;
  }

  void closest() {
    std::vector<Vec3<S>> queries{centre_};
    for (int i = 0; i < 3; ++i) {
      for (const S s : {S(-3), S(-1), S(-0.5), S(1e-6), S(0.99), S(1), S(1e3)})
        queries.push_back(centre_ + s * half_[i] * Vec3<S>::Unit(i));
      Vec3<S> flat = within(S(1));
      flat[i] = centre_[i];
      queries.push_back(flat);
      queries.push_back(S(1e6) * Vec3<S>::Unit(i));
    }
    for (int i = 0; i < 100; ++i) {
      queries.push_back(within(S(1)));
      queries.push_back(within(S(3)));
      queries.push_back(below(body_.reach()));
    }
    for (int i = 0; i < 5; ++i) queries.push_back(S(1e6) * Vec3<S>(uniform(), uniform(), uniform()));

    for (const Vec3<S>& x : queries) {
      const SurfacePoint<S> p = body_.closest(x);
      INFO("x ", x.x(), " ", x.y(), " ", x.z(), " p ", p.position.x(), " ", p.position.y(), " ",
           p.position.z());
      REQUIRE((is_finite(p.position) && is_finite(p.normal) && is_finite(p.distance)));
      // A few roundings in the coordinates, which the gauge sees over the smallest half size.
      CHECK_ABSOLUTE(gauge(p.position), 1.0L, 16 * rounding_ / static_cast<long double>(half_.minCoeff()));
      CHECK_ABSOLUTE(wide(p.normal).norm(), 1.0L, ulps<S>(8));
      // x = p + distance * normal: |x - p| and its direction at once. Roundings of x, p and a few in the
      // solver.
      const long double scale = rounding_ + ulps<S>(1) * (wide(x) - wide(centre_)).norm();
      const Long3 gap = wide(x) - wide(p.position);
      CHECK_ABSOLUTE(gap.norm(), std::fabs(static_cast<long double>(p.distance)), 32 * scale);
      // Past the reach the foot of a superellipsoid may be nearly degenerate: found to sqrt(epsilon) only.
      const bool regular = p.distance > -body_.reach();
      const long double across = (gap - wide(p.normal) * static_cast<long double>(p.distance)).norm();
      CHECK(across <= (regular ? 64 * scale : scale * std::sqrt(1.0L / ulps<S>(1))));
      if (std::fabs(gauge(x) - 1) > 16 * scale / static_cast<long double>(half_.minCoeff())) {
        CHECK((p.distance < S(0)) == (gauge(x) < 1));
        CHECK(body_.inside(x) == (gauge(x) < 1));
      }
      long double nearest = std::numeric_limits<long double>::max();
      for (const Vec3<S>& v : samples_.vertices) nearest = std::min(nearest, (wide(v) - wide(x)).norm());
      CHECK(std::fabs(static_cast<long double>(p.distance)) <= nearest + 32 * scale);
    }
  }

  void penetration() {
    for (int i = 0; i < 200; ++i) {
      const Vec3<S> x = i % 2 == 0 ? below(S(0.5) * body_.reach()) : within(S(1.2));
      const Penetration<S> p = body_.penetration(x);
      const SurfacePoint<S> foot = body_.closest(x);
      INFO("x ", x.x(), " ", x.y(), " ", x.z(), " depth ", p.depth, " distance ", foot.distance);
      if (!body_.inside(x)) {
        CHECK(p.depth <= S(0));
        continue;
      }
      CHECK(p.depth <= -foot.distance + static_cast<S>(8 * rounding_));
      CHECK(p.depth >= S(0.6) * -foot.distance -
                           static_cast<S>(8 * rounding_));  // three faces blended: 0.704, on an axis 3/4
      CHECK(p.gradient.norm() <= S(1) + S(8) * std::numeric_limits<S>::epsilon());
      if constexpr (std::is_same_v<S, double>) {
        if (p.depth < 0.02 * body_.reach() || p.depth > 0.5 * body_.reach()) continue;
        // Central differences: the gradient changes by at most about 10 / depth per metre, hence the error by
        // step.
        const double step = 1e-6 * body_.reach();
        for (int k = 0; k < 3; ++k) {
          const Vec3<S> h = step * Vec3<S>::Unit(k);
          const double slope = (body_.penetration(x + h).depth - body_.penetration(x - h).depth) / (2 * step);
          const double noise = static_cast<double>(16 * rounding_) / step;
          CHECK_ABSOLUTE(-slope, p.gradient[k], 10 * step / p.depth + noise);
        }
      }
    }
  }

  // Depth is Lipschitz with 1, its gradient with a few / depth: on short chords anywhere, edges and corners
  // included. Many at once as one by one: in one face's or several faces' depth, at the centre, outside, far
  // away, and not finite.
  template <std::size_t N>
  void penetration_batch() {
    for (int k = 0; k < 300; ++k) {
      PointBatch<S, N> x;
      for (std::size_t i = 0; i < N; ++i) {
        Vec3<S> p = k % 3 == 0 ? within(S(1.2)) : below(k % 3 == 1 ? S(1e-3) * size_ : size_ / S(4));
        if (i % batch_size == 3 && k % 10 == 0) p = centre_;
        if (i == 5 && k % 20 == 0) p = S(1e5) * size_ * Vec3<S>::Ones();
        if (i == 7 && k % 30 == 0) p.x() = std::numeric_limits<S>::quiet_NaN();
        x.x[i] = p.x(), x.y[i] = p.y(), x.z[i] = p.z();
      }
      PenetrationBatch<S, N> in;
      if (!body_.penetration(x, in)) return;
      for (std::size_t i = 0; i < N; ++i) {
        const Penetration<S> one = body_.penetration(Vec3<S>(x.x[i], x.y[i], x.z[i]));
        // The same formula in another order: a few roundings of the coordinates.
        const S few = S(16) * static_cast<S>(rounding_);
        CHECK_ABSOLUTE(in.depth[i], one.depth, few);
        if (!(one.depth > few)) continue;  // outside, or on the surface to rounding
        const Vec3<S> gradient(in.gradient_x[i], in.gradient_y[i], in.gradient_z[i]);
        // Over an edge directions turn by as much as the position moves over the depth, times a number of
        // order 1.
        CHECK((gradient - one.gradient).norm() <=
              S(4) * few / (std::min)(one.depth, body_.reach()) + test::ulps<S>(16));
      }
    }
  }

  void continuity() {
    long double worst_depth = 0, worst_gradient = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3<S> a = i % 2 == 0 ? below(S(0.5) * body_.reach()) : within(S(1));
      const Vec3<S> b = a + S(0.01) * body_.reach() * Vec3<S>(uniform(), uniform(), uniform());
      const Penetration<S> pa = body_.penetration(a), pb = body_.penetration(b);
      const long double chord = (wide(b) - wide(a)).norm();
      if (!(pa.depth > S(0)) || !(pb.depth > S(0)) || std::max(pa.depth, pb.depth) > S(0.9) * body_.reach())
        continue;
      const long double depth = std::min(pa.depth, pb.depth), reach = body_.reach();
      const long double turn = (wide(pa.gradient) - wide(pb.gradient)).norm();
      worst_depth = std::max(worst_depth, std::fabs(static_cast<long double>(pa.depth - pb.depth)) -
                                              16 * rounding_ - chord * (1 + ulps<S>(4)));
      // A smooth surface turns by 1 / (reach - depth), the blend by about 4 / depth; the normal's own
      // rounding is that of x over the radius of curvature.
      const long double bound = 6 * chord * (1 / depth + 1 / (reach - std::max(pa.depth, pb.depth)));
      worst_gradient =
          std::max(worst_gradient, turn / (bound + 64 * rounding_ / (reach * 0.1L) + ulps<S>(64)));
    }
    CHECK(worst_depth <= 0);
    CHECK(worst_gradient <= 1);
  }

  void separated() {
    int far = 0;
    for (int i = 0; i < 600; ++i) {
      const S r = std::pow(S(10), S(2) * uniform() - S(1.5)) * half_.minCoeff();
      const Vec3<S> c = i % 3 == 0 ? within(S(2))
                                   : body_.closest(on_surface()).position +
                                         r * Vec3<S>(uniform(), uniform(), uniform()) * S(2);
      const bool apart = body_.separated(c, r);
      INFO("c ", c.x(), " ", c.y(), " ", c.z(), " r ", r);
      if (apart) CHECK(body_.closest(c).distance >= r - static_cast<S>(8 * rounding_));
      const Vec3<S> outside = (c - centre_).cwiseAbs() - half_;
      if (outside.maxCoeff() > r * S(1.001) + S(1e-4) * size_) {
        CHECK(apart);
        ++far;
      }
      CHECK(!body_.separated(centre_, r));
      CHECK(!body_.separated(body_.point(S(0.3), S(0.4)), r));
    }
    CHECK(far > 20);
    CHECK(body_.separated(centre_ + S(10) * half_, half_.minCoeff()));
    CHECK(body_.separated(Vec3<S>::Constant(S(1e6)), S(0)));
  }

  void raycast() {
    int hits = 0, misses = 0;
    for (int i = 0; i < 400; ++i) {
      const Vec3<S> o = i % 4 == 0 ? within(S(0.5)) : within(S(4));
      Vec3<S> d = i % 2 == 0 ? Vec3<S>(within(S(1)) - o)
                             : Vec3<S>(half_.cwiseProduct(Vec3<S>(uniform(), uniform(), uniform())));
      if (i % 5 == 0) d = (i % 10 == 0 ? size_ : -size_) * Vec3<S>::Unit(i / 5 % 3);
      const bool from_inside = body_.inside(o);
      const RayHit<S> hit = body_.raycast(o, d);
      INFO("ray ", i, " o ", o.x(), " ", o.y(), " ", o.z(), " d ", d.x(), " ", d.y(), " ", d.z(), " t ",
           hit.t);
      // Along the ray before the hit (or all along a miss) nothing is on the other side of the surface.
      const S end = hit.hit ? hit.t : S(10) * size_ / d.cwiseAbs().maxCoeff() + S(10);
      const long double slack = 64 * rounding_ / static_cast<long double>(half_.minCoeff());
      for (int k = 0; k < 64; ++k) {
        const long double g = gauge(o + end * (static_cast<S>(k) + S(0.5)) / S(64) * d);
        // A ray that grazes may count either way.
        const long double graze = hit.hit ? slack : slack + 2 * std::sqrt(ulps<S>(1));
        CHECK((from_inside ? g <= 1 + graze : g >= 1 - graze));
      }
      if (!hit.hit) {
        CHECK(!from_inside);
        ++misses;
        continue;
      }
      ++hits;
      CHECK(hit.t >= S(0));
      CHECK_ABSOLUTE(gauge(hit.position), 1.0L, 16 * rounding_ / static_cast<long double>(half_.minCoeff()));
      // Where the ray grazes, a rounding of x moves the hit by its square root.
      const long double drift =
          (wide(hit.position) - wide(o) - static_cast<long double>(hit.t) * wide(d)).norm();
      CHECK(drift <= 64 * (rounding_ +
                           ulps<S>(1) * (wide(o).norm() + static_cast<long double>(hit.t) * wide(d).norm())));
      const RayHit<S> twice = body_.raycast(o, S(2) * d);
      CHECK(twice.hit);
      CHECK(twice.t == hit.t / S(2));
    }
    CHECK(hits > 100);
    CHECK(misses > 20);
    CHECK(!body_.raycast(centre_, Vec3<S>::Zero()).hit);
    CHECK(!body_.raycast(centre_ + S(3) * half_, half_).hit);
    CHECK(body_.raycast(centre_ + S(3) * half_, -half_).hit);
  }

  void curvature() {
    int skipped = 0;
    for (int i = 0; i < 100; ++i) {
      const Vec3<S> p = body_.closest(on_surface()).position, n = body_.closest(p).normal;
      const Curvature<S> c = body_.curvature(p);
      CHECK(c.k1 >= c.k2);
      CHECK(c.k2 >= -S(64) * std::numeric_limits<S>::epsilon() * c.k1);  // convex
      CHECK(c.k1 * body_.reach() <= S(1.0001));
      for (const Vec3<S>& d : {c.dir1, c.dir2}) {
        CHECK_ABSOLUTE(d.norm(), S(1), ulps<S>(16));
        CHECK_ABSOLUTE(d.dot(n), S(0), 16 * rounding_ / static_cast<long double>(body_.reach()));
      }
      CHECK_ABSOLUTE(c.dir1.dot(c.dir2), S(0), ulps<S>(16));
      if constexpr (std::is_same_v<S, double>) {
        // dn = k dir ds. Central differences of the normal over a small part of the reach; their error is of
        // second order in it (first where the curvature itself has a kink), the noise is rounding / step.
        const double step = 1e-4 * body_.reach();
        for (int k = 0; k < 2; ++k) {
          const Vec3<S> d = k == 0 ? c.dir1 : c.dir2;
          const Vec3<S> turn = body_.closest(p + step * d).normal - body_.closest(p - step * d).normal;
          if (turn.norm() > 0.01) {  // an edge of a box or cylinder
            ++skipped;
            continue;
          }
          const Vec3<S> expected = 2 * step * (k == 0 ? c.k1 : c.k2) * d;
          const double noise = static_cast<double>(64 * rounding_ / static_cast<long double>(body_.reach()));
          CHECK((turn - expected).norm() <= 2e-6 + noise);  // 1 % of the largest turn, 2e-4
        }
      }
    }
    CHECK(skipped <= 4);
  }

  void point() {
    const S nan = std::numeric_limits<S>::quiet_NaN();
    const auto check = [&](S u, S v) {
      INFO("u ", u, " v ", v);
      CHECK_ABSOLUTE(gauge(body_.point(u, v)), 1.0L,
                     16 * rounding_ / static_cast<long double>(half_.minCoeff()));
    };
    for (int i = 0; i <= 12; ++i)
      for (int j = 0; j <= 12; ++j) check(static_cast<S>(i) / S(12), static_cast<S>(j) / S(12));
    for (const S odd : {S(-1), S(2), nan, std::numeric_limits<S>::infinity()}) check(odd, odd);
  }

  void mesh() {
    double error_before = 1;
    for (const std::size_t vertices : {8u, 9u, 100u, 1000u, 4000u}) {
      const MeshData<S> m = body_.mesh(vertices);
      INFO("vertices ", vertices, " got ", m.vertices.size());
      CHECK(m.vertices.size() >= 8);
      CHECK(m.vertices.size() <= vertices);
      if (vertices >= 1000) CHECK(m.vertices.size() >= vertices * 4 / 5);
      CHECK(m.triangles.size() == 2 * (m.vertices.size() - 2));  // Euler, no handles

      long double worst = 0;
      for (const Vec3<S>& v : m.vertices) worst = std::max(worst, std::fabs(gauge(v) - 1));
      CHECK(worst <= 16 * rounding_ / static_cast<long double>(half_.minCoeff()));

      std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, opposite;
      double volume = 0, smallest = std::numeric_limits<double>::max(), largest = 0;
      for (const auto& t : m.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
          edges.emplace_back(t[k], t[(k + 1) % 3]);
          opposite.emplace_back(t[(k + 1) % 3], t[k]);
        }
        const Vec3<double> a = (m.vertices[t[0]] - centre_).template cast<double>();
        const Vec3<double> b = (m.vertices[t[1]] - centre_).template cast<double>();
        const Vec3<double> c = (m.vertices[t[2]] - centre_).template cast<double>();
        const double area = (b - a).cross(c - a).norm() / 2;
        volume += a.dot(b.cross(c)) / 6;
        smallest = std::min(smallest, area);
        largest = std::max(largest, area);
      }
      std::sort(edges.begin(), edges.end());
      std::sort(opposite.begin(), opposite.end());
      CHECK(std::adjacent_find(edges.begin(), edges.end()) == edges.end());  // each directed edge once
      CHECK(edges == opposite);                                              // and its opposite once
      const double error = 1 - volume / static_cast<double>(body_.volume());
      CHECK(error >= -1e-6);  // inscribed, to the rounding of float
      CHECK(error <= error_before + 1e-6);
      error_before = error;
      if (vertices >= 100) CHECK(largest / smallest <= area_ratio_);
    }
    CHECK(error_before < 0.01);  // 4000 vertices: of second order in the spacing
    const Vec3<S> margin = Vec3<S>::Constant(static_cast<S>(2 * rounding_));
    for (const Vec3<S>& v : samples_.vertices) {
      CHECK(((v - body_.lower() + margin).minCoeff() >= S(0) &&
             (body_.upper() + margin - v).minCoeff() >= S(0)));
    }
    const MeshData<S> again = body_.mesh(1500);
    CHECK((again.triangles == samples_.triangles && again.vertices == samples_.vertices));
    CHECK_THROWS_AS((void)body_.mesh(7), SetupError);
    CHECK_THROWS_AS((void)body_.mesh(2000000000u), SetupError);
  }

  // Lengths times a power of two: every result scales, to the bit.
  void units() {
    const S k = S(1024);
    const Body made = make_(k);
    const AnySurface<S>& large = *made;
    CHECK(large.reach() == k * body_.reach());
    for (int i = 0; i < 50; ++i) {
      const Vec3<S> x = within(S(1.3));
      const SurfacePoint<S> a = body_.closest(x), b = large.closest(k * x);
      CHECK((b.position == k * a.position && b.normal == a.normal && b.distance == k * a.distance));
      const Penetration<S> pa = body_.penetration(x), pb = large.penetration(k * x);
      CHECK((pb.depth == k * pa.depth && pb.gradient == pa.gradient));
      CHECK(large.curvature(b.position).k1 == body_.curvature(a.position).k1 / k);
    }
  }

  void not_finite() {
    for (const S odd : {std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity(),
                        -std::numeric_limits<S>::infinity()}) {
      for (int i = 0; i < 3; ++i) {
        Vec3<S> x = centre_;
        x[i] = odd;
        const SurfacePoint<S> p = body_.closest(x);
        CHECK_ABSOLUTE(gauge(p.position), 1.0L, 16 * rounding_ / static_cast<long double>(half_.minCoeff()));
        CHECK(p.distance == (std::numeric_limits<S>::max)());
        CHECK(is_finite(p.normal));
        CHECK(body_.penetration(x).depth == S(0));
        CHECK(!body_.inside(x));
        CHECK(!body_.separated(x, S(1)));
        CHECK(!body_.separated(centre_ + S(10) * half_, odd));
        CHECK(!body_.raycast(x, Vec3<S>::UnitX()).hit);
        CHECK(!body_.raycast(centre_, x).hit);
        const Curvature<S> c = body_.curvature(x);
        CHECK((is_finite(c.k1) && is_finite(c.k2) && is_finite(c.dir1) && is_finite(c.dir2)));
      }
    }
    CHECK(!body_.separated(centre_ + S(10) * half_, S(-1)));
    // Finite but near the end of the range: defined, and outside.
    const Vec3<S> huge = Vec3<S>::Constant((std::numeric_limits<S>::max)() / S(2));
    CHECK(body_.closest(huge).distance > S(1e6));
    CHECK(is_finite(body_.closest(huge).position));
    CHECK(body_.penetration(huge).depth == S(0));
    CHECK(body_.separated(huge, S(1)));
  }

  std::function<Body(S)> make_;
  Body made_;
  const AnySurface<S>& body_ = *made_;
  std::function<long double(const Long3&)> gauge_;
  Vec3<S> centre_;
  double area_ratio_;
  MeshData<S> samples_;
  Vec3<S> half_;
  S size_;
  long double rounding_;  // one rounding of a coordinate [m]
  std::mt19937_64 random_{surface_seed};
};

}  // namespace palpate::test
