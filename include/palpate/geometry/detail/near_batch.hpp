// SPDX-License-Identifier: MIT
#pragma once

/// @file  Closest points and means of values (near_blend.hpp) for many points at once.

#include <palpate/core/simd_shuffle.hpp>
#include <palpate/geometry/detail/near_blend.hpp>
#include <palpate/geometry/detail/near_triangles.hpp>

namespace palpate::detail {

/// What NearBlend needs at a batch of points that are close together: their feet on the triangles around,
/// up to 64.
template <Real S>
class NearBatch {
 public:
  using Nearest = typename TriangleBvh<S>::Nearest;
  using Numbers = std::array<S, batch_size>;  ///< one of each point

  /// `around` has every triangle within NearBlend's band of a point, at least one; `cull` is good for all
  /// points.
  NearBatch(const TriangleBvh<S>& tree, const NearBlend<S>& blend, const typename TriangleBvh<S>::Cull& cull,
            const PointBatch<S>& x, const NearTriangles<S>& around) noexcept
      : x_(x) {
    distance2_.fill((std::numeric_limits<S>::max)());
    add(tree, around.nearest());
    std::array<std::array<float, batch_size>, 3> at;
    std::array<float, batch_size> limit;
    const Vec3<S>& origin = tree.origin();
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const SimdVec3<V> from_origin = load_from<V>(x, i, origin);
      store(&at[0][i], simd_cast<float>(from_origin.x));
      store(&at[1][i], simd_cast<float>(from_origin.y));
      store(&at[2][i], simd_cast<float>(from_origin.z));
      const V grown = blend.radii(sqrt(load<V>(&distance2_[i]))) + cull.slack;
      store(&limit[i], simd_cast<float>(grown * grown * cull.widened));
    }
    around.for_each_near(at, limit, [&](std::uint32_t triangle) { add(tree, triangle); });
    for (std::size_t i = 0; i < batch_size; i += V::size())
      store(&distance_[i], sqrt(load<V>(&distance2_[i])));
  }

  /// False where there are more than 64: nothing of it can be used then.
  [[nodiscard]] bool complete() const noexcept { return count_ <= foot_.size(); }
  /// Distance of each point, >= 0.
  [[nodiscard]] const Numbers& distance() const noexcept { return distance_; }
  /// x - x_i . v of point i and its closest point x_i.
  [[nodiscard]] S along(std::size_t i, const Vec3<S>& v) const noexcept {
    return away_[0][i] * v[0] + away_[1][i] * v[1] + away_[2][i] * v[2];
  }
  /// The mesh's point closest to point i.
  [[nodiscard]] Nearest nearest(std::size_t i) const noexcept {
    const Foot& foot = foot_[static_cast<std::size_t>(nearest_[i])];
    return {foot.triangle, Vec3<S>(foot.u[i], foot.v[i], foot.w[i]),
            Vec3<S>(x_.x[i] - away_[0][i], x_.y[i] - away_[1][i], x_.z[i] - away_[2][i]), distance2_[i]};
  }

  /// NearBlend's mean of vectors: value(triangle, corner) at the corners, interpolated. The sums of weights;
  /// points where that is 0 have 0.
  template <class Value>
  Numbers mean(const NearBlend<S>& blend, const Value& value, std::array<Numbers, 3>& out) const noexcept {
    return mean_of<false>(blend, value, out);
  }
  /// The same of unit vectors: what is interpolated is normalised.
  template <class Value>
  Numbers mean_direction(const NearBlend<S>& blend, const Value& value,
                         std::array<Numbers, 3>& out) const noexcept {
    return mean_of<true>(blend, value, out);
  }

 private:
  using R = native_simd<S>;  // of what lies in memory: one register
  using V = batch_simd<S>;

  struct Foot {
    std::uint32_t triangle;
    Numbers u, v, w, distance2;  // weights of the corners
  };

  struct Weights {
    R u, v, w;
  };

  template <bool unit, class Value>
  Numbers mean_of(const NearBlend<S>& blend, const Value& value, std::array<Numbers, 3>& out) const noexcept {
    Numbers radius, limit, per;
    constexpr S tiny = (std::numeric_limits<S>::min)();
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const V d = load<V>(&distance_[i]), r = blend.radii(d);
      store(&radius[i], r);
      store(&limit[i], r * r);
      store(&per[i], S(1) / (max)(r - d, tiny));
    }
    std::array<Numbers, 4> sum{};
    for (std::size_t f = 0; f < count_; ++f) {
      const Foot& foot = foot_[f];
      if (!is_near(foot, limit)) continue;
      const Vec3<S>&a = value(foot.triangle, 0), &b = value(foot.triangle, 1), &c = value(foot.triangle, 2);
      for (std::size_t i = 0; i < batch_size; i += R::size()) {
        const R u(&foot.u[i]), v(&foot.v[i]), w(&foot.w[i]);
        const R nx = u * a[0] + v * b[0] + w * c[0], ny = u * a[1] + v * b[1] + w * c[1],
                nz = u * a[2] + v * b[2] + w * c[2];
        const R here = (R(&radius[i]) - sqrt(R(&foot.distance2[i]))) * R(&per[i]);
        const R weight = select(here > R{}, here * here, R{});
        R scale = weight;
        if constexpr (unit) scale /= sqrt((max)(nx * nx + ny * ny + nz * nz, tiny));
        const auto add = [i](Numbers& to, const R& more) { store(&to[i], R(&to[i]) + more); };
        add(sum[0], scale * nx), add(sum[1], scale * ny), add(sum[2], scale * nz), add(sum[3], weight);
      }
    }
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const V total = (max)(load<V>(&sum[3][i]), tiny);
      for (std::size_t k = 0; k < 3; ++k) store(&out[k][i], load<V>(&sum[k][i]) / total);
    }
    return sum[3];
  }
  // Is a triangle within the limit of any point?
  [[nodiscard]] static PALPATE_INLINE bool is_near(const Foot& foot, const Numbers& limit) noexcept {
    V least = load<V>(foot.distance2.data()) - load<V>(limit.data());
    for (std::size_t i = V::size(); i < batch_size; i += V::size())
      least = (min)(least, load<V>(&foot.distance2[i]) - load<V>(&limit[i]));
    return reduce_min(least) < S(0);
  }

  // closest_on_triangle() with its cases as selections, from the last to the first.
  [[nodiscard]] PALPATE_INLINE static Weights weights(const R& x, const R& y, const R& z, const Vec3<S>& a,
                                                      const Vec3<S>& b, const Vec3<S>& c) noexcept {
    const S ex = b[0] - a[0], ey = b[1] - a[1], ez = b[2] - a[2], fx = c[0] - a[0], fy = c[1] - a[1],
            fz = c[2] - a[2];
    const R ax = x - a[0], ay = y - a[1], az = z - a[2], bx = x - b[0], by = y - b[1], bz = z - b[2],
            cx = x - c[0], cy = y - c[1], cz = z - c[2];
    const R d1 = ex * ax + ey * ay + ez * az, d2 = fx * ax + fy * ay + fz * az,
            d3 = ex * bx + ey * by + ez * bz, d4 = fx * bx + fy * by + fz * bz,
            d5 = ex * cx + ey * cy + ez * cz, d6 = fx * cx + fy * cy + fz * cz, d43 = d4 - d3, d56 = d5 - d6;
    const R vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4, sum = va + vb + vc;
    const R none{}, one = S(1);
    // v and w as fractions.
    const auto area = sum > none;
    R v = select(area, vb, none), w = select(area, vc, none), whole = select(area, sum, one);
    const auto choose = [&](const MaskOf<R>& mask, const R& v_there, const R& w_there, const R& whole_there)
                            PALPATE_INLINE_LAMBDA {
                              v = select(mask, v_there, v);
                              w = select(mask, w_there, w);
                              whole = select(mask, whole_there, whole);
                            };
    const auto on_bc = va <= none && d43 >= none && d56 >= none,
               on_ac = vb <= none && d2 >= none && d6 <= none, on_ab = vc <= none && d1 >= none && d3 <= none,
               at_c = d6 >= none && d5 <= d6, at_b = d3 >= none && d4 <= d3, at_a = d1 <= none && d2 <= none;
    choose(on_bc, d56, d43, d43 + d56);
    choose(on_ac, none, d2, d2 - d6);
    choose(on_ab, d1, none, d1 - d3);
    choose(at_c, none, one, one);
    choose(at_b, one, none, one);
    choose(at_a, none, none, one);
    v /= whole, w /= whole;
    // Exactly 0 on the edge across from a.
    const auto across = on_bc && !(on_ac || on_ab || at_a || at_b || at_c);
    v = select(across, one - w, v);
    return {select(across, none, one - v - w), v, w};
  }

  PALPATE_FLATTEN void add(const TriangleBvh<S>& tree, std::uint32_t triangle) noexcept {
    if (count_ >= foot_.size()) {
      count_ = foot_.size() + 1;
      return;
    }
    Foot& foot = foot_[count_];
    foot.triangle = triangle;
    const auto& t = tree.triangles()[triangle];
    const Vec3<S> a = tree.vertices()[t[0]], b = tree.vertices()[t[1]], c = tree.vertices()[t[2]];
    const R number = static_cast<S>(count_);
    for (std::size_t i = 0; i < batch_size; i += R::size()) {
      const R x = load<R>(&x_.x[i]), y = load<R>(&x_.y[i]), z = load<R>(&x_.z[i]);
      const auto [u, v, w] = weights(x, y, z, a, b, c);
      const R away_x = x - (u * a[0] + v * b[0] + w * c[0]), away_y = y - (u * a[1] + v * b[1] + w * c[1]),
              away_z = z - (u * a[2] + v * b[2] + w * c[2]),
              distance2 = away_x * away_x + away_y * away_y + away_z * away_z;
      store(&foot.u[i], u);
      store(&foot.v[i], v);
      store(&foot.w[i], w);
      store(&foot.distance2[i], distance2);
      const auto nearer = distance2 < load<R>(&distance2_[i]);
      const auto keep = [i, &nearer](Numbers& best, const R& here) {
        store(&best[i], select(nearer, here, load<R>(&best[i])));
      };
      keep(distance2_, distance2), keep(nearest_, number);
      keep(away_[0], away_x), keep(away_[1], away_y), keep(away_[2], away_z);
    }
    ++count_;
  }

  const PointBatch<S>& x_;
  std::array<Foot, 64> foot_;  // only the first count_ are set
  std::size_t count_ = 0;
  Numbers nearest_{}, distance2_;  // number of the nearest foot, and its square distance
  std::array<Numbers, 3> away_{};  // from it to the point
  Numbers distance_;
};

/// Calls visit(NearBatch) for points within `spread` of `middle` and no farther than `far` from the mesh [m].
/// False, and no call, where they have too many triangles near them: then each is better off on its own.
template <Real S, class Visit>
[[nodiscard]] inline bool with_near_batch(const TriangleBvh<S>& tree, const NearBlend<S>& blend,
                                          const PointBatch<S>& x, const Vec3<S>& middle, S spread, S far,
                                          const Visit& visit) noexcept {
  const NearTriangles<S> around(tree, middle, std::sqrt(blend.band(far)) + spread);
  if (!around.complete()) return false;
  const NearBatch<S> batch(tree, blend, tree.cull(middle, spread), x, around);
  if (!batch.complete()) return false;
  visit(batch);
  return true;
}

}  // namespace palpate::detail
