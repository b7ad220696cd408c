// SPDX-License-Identifier: MIT
#pragma once

/// @file  Closest points and means of values (near_blend.hpp) for many points at once.

#include <palpate/core/lane_register.hpp>
#include <palpate/geometry/detail/near_blend.hpp>
#include <palpate/geometry/detail/near_triangles.hpp>

namespace palpate::detail {

/// What NearBlend needs at `lane_count` points that are close together: their feet on the triangles around,
/// up to 64.
template <Real S>
class NearLanes {
 public:
  using Nearest = typename TriangleBvh<S>::Nearest;
  using Lanes = LaneArray<S>;

  /// `around` has every triangle within NearBlend's band of a point, at least one; `cull` is good for all
  /// points.
  NearLanes(const TriangleBvh<S>& tree, const NearBlend<S>& blend, const typename TriangleBvh<S>::Cull& cull,
            const PointLanes<S>& x, const NearTriangles<S>& around) noexcept
      : x_(x) {
    distance2_.fill((std::numeric_limits<S>::max)());
    add(tree, around.nearest());
    std::array<std::array<float, lane_count>, 3> at;
    std::array<float, lane_count> limit;
    const Vec3<S>& origin = tree.origin();
    lane_array(at[0]) = (lane_array(x.x) - origin.x()).template cast<float>();
    lane_array(at[1]) = (lane_array(x.y) - origin.y()).template cast<float>();
    lane_array(at[2]) = (lane_array(x.z) - origin.z()).template cast<float>();
    const Lanes first = lane_array(distance2_).sqrt();
    lane_array(limit) = ((blend.radii(first) + cull.slack).square() * cull.widened).template cast<float>();
    around.for_each_near(at, limit, [&](std::uint32_t triangle) { add(tree, triangle); });
    distance_ = lane_array(distance2_).sqrt();
  }

  /// False where there are more than 64: nothing of it can be used then.
  [[nodiscard]] bool complete() const noexcept { return count_ <= foot_.size(); }
  /// Distance of each point, >= 0.
  [[nodiscard]] const Lanes& distance() const noexcept { return distance_; }
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
  /// lanes where that is 0 have 0.
  template <class Value>
  Lanes mean(const NearBlend<S>& blend, const Value& value, std::array<Lanes, 3>& out) const noexcept {
    return mean_of<false>(blend, value, out);
  }
  /// The same of unit vectors: what is interpolated is normalised.
  template <class Value>
  Lanes mean_direction(const NearBlend<S>& blend, const Value& value,
                       std::array<Lanes, 3>& out) const noexcept {
    return mean_of<true>(blend, value, out);
  }

 private:
  using R = LaneRegister<S>;

  struct Foot {
    std::uint32_t triangle;
    std::array<S, lane_count> u, v, w, distance2;  // weights of the corners
  };

  struct Weights {
    R u, v, w;
  };

  template <bool unit, class Value>
  Lanes mean_of(const NearBlend<S>& blend, const Value& value, std::array<Lanes, 3>& out) const noexcept {
    const Lanes radius = blend.radii(distance_), limit = radius.square(),
                per = (radius - distance_).max((std::numeric_limits<S>::min)()).inverse();
    std::array<std::array<S, lane_count>, 4> sum{};
    const R least = all_of<R>((std::numeric_limits<S>::min)());
    for (std::size_t f = 0; f < count_; ++f) {
      const Foot& foot = foot_[f];
      if (!((lane_array(foot.distance2) - limit).minCoeff() < S(0))) continue;
      const Vec3<S>&a = value(foot.triangle, 0), &b = value(foot.triangle, 1), &c = value(foot.triangle, 2);
      for (std::size_t i = 0; i < lane_count; i += register_lanes<S>) {
        const R u = load_register(&foot.u[i]), v = load_register(&foot.v[i]), w = load_register(&foot.w[i]);
        const R nx = u * a[0] + v * b[0] + w * c[0], ny = u * a[1] + v * b[1] + w * c[1],
                nz = u * a[2] + v * b[2] + w * c[2];
        const R here = (load_register(radius.data() + i) - root_of<S>(load_register(&foot.distance2[i]))) *
                       load_register(per.data() + i);
        const R weight = here > S(0) ? here * here : R{};
        R scale = weight;
        if constexpr (unit) {
          const R square = nx * nx + ny * ny + nz * nz;
          scale /= root_of<S>(square > least ? square : least);
        }
        const auto add = [i](std::array<S, lane_count>& to, const R& more) {
          store_vector(&to[i], R(load_register(&to[i]) + more));
        };
        add(sum[0], scale * nx), add(sum[1], scale * ny), add(sum[2], scale * nz), add(sum[3], weight);
      }
    }
    const Lanes total = lane_array(sum[3]), some = total.max((std::numeric_limits<S>::min)());
    for (std::size_t k = 0; k < 3; ++k) out[k] = lane_array(sum[k]) / some;
    return total;
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
    const R none{}, one = all_of<R>(S(1));
    // v and w as fractions.
    const auto area = sum > none;
    R v = area ? vb : none, w = area ? vc : none, whole = area ? sum : one;
    const auto on_bc = (va <= none) & (d43 >= none) & (d56 >= none);
    v = on_bc ? d56 : v, w = on_bc ? d43 : w, whole = on_bc ? d43 + d56 : whole;
    const auto on_ac = (vb <= none) & (d2 >= none) & (d6 <= none);
    v = on_ac ? none : v, w = on_ac ? d2 : w, whole = on_ac ? d2 - d6 : whole;
    const auto on_ab = (vc <= none) & (d1 >= none) & (d3 <= none);
    v = on_ab ? d1 : v, w = on_ab ? none : w, whole = on_ab ? d1 - d3 : whole;
    const auto at_c = (d6 >= none) & (d5 <= d6);
    v = at_c ? none : v, w = at_c ? one : w, whole = at_c ? one : whole;
    const auto at_b = (d3 >= none) & (d4 <= d3);
    v = at_b ? one : v, w = at_b ? none : w, whole = at_b ? one : whole;
    const auto at_a = (d1 <= none) & (d2 <= none);
    v = at_a ? none : v, w = at_a ? none : w, whole = at_a ? one : whole;
    v /= whole, w /= whole;
    // Exactly 0 on the edge across from a.
    const auto across = on_bc & ((on_ac | on_ab | at_a | at_b | at_c) == 0);
    v = across ? one - w : v;
    return {across ? none : one - v - w, v, w};
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
    const R number = all_of<R>(static_cast<S>(count_));
    for (std::size_t i = 0; i < lane_count; i += register_lanes<S>) {
      const R x = load_register(&x_.x[i]), y = load_register(&x_.y[i]), z = load_register(&x_.z[i]);
      const auto [u, v, w] = weights(x, y, z, a, b, c);
      const R away_x = x - (u * a[0] + v * b[0] + w * c[0]), away_y = y - (u * a[1] + v * b[1] + w * c[1]),
              away_z = z - (u * a[2] + v * b[2] + w * c[2]),
              distance2 = away_x * away_x + away_y * away_y + away_z * away_z;
      store_vector(&foot.u[i], u);
      store_vector(&foot.v[i], v);
      store_vector(&foot.w[i], w);
      store_vector(&foot.distance2[i], distance2);
      const auto nearer = distance2 < load_register(&distance2_[i]);
      const auto keep = [i, &nearer](std::array<S, lane_count>& best, const R& here) {
        store_vector(&best[i], R(nearer ? here : load_register(&best[i])));
      };
      keep(distance2_, distance2), keep(nearest_, number);
      keep(away_[0], away_x), keep(away_[1], away_y), keep(away_[2], away_z);
    }
    ++count_;
  }

  const PointLanes<S>& x_;
  std::array<Foot, 64> foot_;  // only the first count_ are set
  std::size_t count_ = 0;
  std::array<S, lane_count> nearest_{}, distance2_;  // number of the nearest foot, and its square distance
  std::array<std::array<S, lane_count>, 3> away_{};  // from it to the point
  Lanes distance_;
};

/// Calls visit(NearLanes) for points within `spread` of `middle` and no farther than `far` from the mesh [m].
/// False, and no call, where they have too many triangles near them: then each is better off on its own.
template <Real S, class Visit>
[[nodiscard]] inline bool with_near_lanes(const TriangleBvh<S>& tree, const NearBlend<S>& blend,
                                          const PointLanes<S>& x, const Vec3<S>& middle, S spread, S far,
                                          const Visit& visit) noexcept {
  const NearTriangles<S> around(tree, middle, std::sqrt(blend.band(far)) + spread);
  if (!around.complete()) return false;
  const NearLanes<S> lanes(tree, blend, tree.cull(middle, spread), x, around);
  if (!lanes.complete()) return false;
  visit(lanes);
  return true;
}

}  // namespace palpate::detail
