// SPDX-License-Identifier: MIT
#pragma once

/// @file  One triangle against a point and against a ray.

#include <palpate/config.hpp>
#include <palpate/core/vector.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace palpate::detail {

/// Barycentric weights of the point of triangle (a, b, c) closest to x; a weight is exactly 0 where that
/// point lies on an edge or a vertex. Without area the answer is still a point of the triangle. Source:
/// [ericson2004].
template <Real S>
[[nodiscard]] PALPATE_INLINE Vec3<S> closest_on_triangle(const Vec3<S>& x, const Vec3<S>& a, const Vec3<S>& b,
                                                         const Vec3<S>& c) noexcept {
  // Coordinate by coordinate, because this is where a query's time goes: gcc 12 at -O2 does not inline all of
  // Eigen.
  const S ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2], vx = c[0] - a[0], vy = c[1] - a[1],
          vz = c[2] - a[2];
  const S ax = x[0] - a[0], ay = x[1] - a[1], az = x[2] - a[2];
  const S d1 = ux * ax + uy * ay + uz * az, d2 = vx * ax + vy * ay + vz * az;
  if (d1 <= S(0) && d2 <= S(0)) return {S(1), S(0), S(0)};
  const S bx = x[0] - b[0], by = x[1] - b[1], bz = x[2] - b[2];
  const S d3 = ux * bx + uy * by + uz * bz, d4 = vx * bx + vy * by + vz * bz;
  if (d3 >= S(0) && d4 <= d3) return {S(0), S(1), S(0)};
  const S cx = x[0] - c[0], cy = x[1] - c[1], cz = x[2] - c[2];
  const S d5 = ux * cx + uy * cy + uz * cz, d6 = vx * cx + vy * cy + vz * cz;
  if (d6 >= S(0) && d5 <= d6) return {S(0), S(0), S(1)};
  const S vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= S(0) && d1 >= S(0) && d3 <= S(0)) {
    const S v = d1 / (d1 - d3);
    return {S(1) - v, v, S(0)};
  }
  if (vb <= S(0) && d2 >= S(0) && d6 <= S(0)) {
    const S w = d2 / (d2 - d6);
    return {S(1) - w, S(0), w};
  }
  if (va <= S(0) && d4 >= d3 && d5 >= d6) {
    const S w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {S(0), S(1) - w, w};
  }
  const S sum = va + vb + vc;
  if (!(sum > S(0))) return {S(1), S(0), S(0)};
  const S v = vb / sum, w = vc / sum;
  return {S(1) - v - w, v, w};
}

/// A ray made ready for many triangles: axes permuted so that the direction's greatest component is the last,
/// and sheared onto it. Neighbours compute a shared edge from the same numbers in the same order, so that no
/// ray passes between them. Source: [woop2013].
template <Real S>
struct ShearedRay {
  Vec3<S> origin;
  std::array<int, 3> axis;
  S sx, sy, sz;

  /// Precondition: the greatest entry of |d| is 1 or near it.
  ShearedRay(const Vec3<S>& o, const Vec3<S>& d) noexcept : origin(o) {
    int z = 0;
    d.cwiseAbs().maxCoeff(&z);
    axis = {(z + 1) % 3, (z + 2) % 3, z};
    if (d[z] < S(0)) std::swap(axis[0], axis[1]);
    sx = d[axis[0]] / d[z];
    sy = d[axis[1]] / d[z];
    sz = S(1) / d[z];
  }

  /// Sets t and the weights and gives true when the line meets the triangle, from either side, at t >= 0.
  [[nodiscard]] bool hit(const std::array<std::uint32_t, 3>& index, const Vec3<S>& a, const Vec3<S>& b,
                         const Vec3<S>& c, S& t, Vec3<S>& weight) const noexcept {
    const Vec3<S> p = shear(a), q = shear(b), r = shear(c);
    // Under contraction to fused multiply-add the two orders of an edge differ: always the lower vertex
    // first.
    const auto edge = [](const Vec3<S>& l, const Vec3<S>& m, std::uint32_t i, std::uint32_t j) {
      return i < j ? cross(l, m) : -cross(m, l);
    };
    const S u = edge(q, r, index[1], index[2]), v = edge(r, p, index[2], index[0]),
            w = edge(p, q, index[0], index[1]);
    if ((u < S(0) || v < S(0) || w < S(0)) && (u > S(0) || v > S(0) || w > S(0))) return false;
    const S sum = u + v + w;
    if (sum == S(0)) return false;
    weight = Vec3<S>(u, v, w) / sum;
    t = weight.dot(Vec3<S>(p.z(), q.z(), r.z()));
    return t >= S(0) && is_finite(t);
  }

 private:
  [[nodiscard]] Vec3<S> shear(const Vec3<S>& v) const noexcept {
    const Vec3<S> e = v - origin;
    const S z = e[axis[2]];
    return Vec3<S>(e[axis[0]] - sx * z, e[axis[1]] - sy * z, sz * z);
  }
  // In double for float, where the product's sign is then exact.
  [[nodiscard]] static S cross(const Vec3<S>& l, const Vec3<S>& m) noexcept {
    using W = decltype(S{} + double{});
    const W d = static_cast<W>(l.y()) * static_cast<W>(m.x()) - static_cast<W>(l.x()) * static_cast<W>(m.y());
    return static_cast<S>(d);
  }
};

}  // namespace palpate::detail
