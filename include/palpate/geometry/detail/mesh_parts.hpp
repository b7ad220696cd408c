// SPDX-License-Identifier: MIT
#pragma once

/// @file  The closed parts of a triangle mesh, and whether each is oriented outwards. Set-up only.

#include <palpate/geometry/concept.hpp>
#include <palpate/geometry/detail/half_edges.hpp>

#include <cmath>

namespace palpate::detail {

/// Solid angle of triangle (a, b, c) seen from the origin, over 4 pi; positive when it is seen from inside.
/// Source: [vanoosterom1983].
template <Real S>
[[nodiscard]] inline S winding_share(const Vec3<S>& a, const Vec3<S>& b, const Vec3<S>& c) noexcept {
  const S la = a.norm(), lb = b.norm(), lc = c.norm();
  const S numerator = a.dot(b.cross(c));
  const S denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  constexpr S two_pi = S(6.28318530717958647692528676655900577L);
  return std::atan2(numerator, denominator) / two_pi;
}

/// The closed parts of a mesh, each one's triangles together.
struct Parts {
  std::vector<std::uint32_t> triangles;  // grouped
  std::vector<std::size_t> begin{0};     // of each part, and the end
};
[[nodiscard]] inline Parts closed_parts(std::span<const std::uint32_t> twin) {
  Parts parts;
  std::vector<bool> seen(twin.size() / 3, false);
  parts.triangles.reserve(seen.size());
  for (std::size_t seed = 0; seed < seen.size(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = true;
    std::size_t head = parts.triangles.size();
    parts.triangles.push_back(static_cast<std::uint32_t>(seed));
    for (; head < parts.triangles.size(); ++head) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t other = twin[3 * parts.triangles[head] + k] / 3;
        if (seen[other]) continue;
        seen[other] = true;
        parts.triangles.push_back(other);
      }
    }
    parts.begin.push_back(parts.triangles.size());
  }
  return parts;
}

/// A part that bounds material has positive volume and stands outside all others' material (winding number
/// 0); one that bounds a cavity has negative volume and stands inside (winding number 1), within a part of
/// larger volume. Where a part stands is asked at one vertex of it. Gives the first triangle of each part
/// that does not; where all do and cavities take more than there is, for they run through each other, that
/// of the least volume. Precondition: every half-edge has a twin of the other direction.
template <Real S>
[[nodiscard]] inline std::vector<std::uint32_t> wrong_parts(const MeshData<S>& mesh,
                                                            std::span<const std::uint32_t> twin) {
  using W = Wide<S>;
  const Parts parts = closed_parts(twin);
  const std::size_t count = parts.begin.size() - 1;
  const auto corner = [&](std::size_t i, std::size_t k) {
    return Vec3<W>(mesh.vertices[mesh.triangles[parts.triangles[i]][k]].template cast<W>());
  };
  std::vector<Vec3<W>> low(count), high(count);
  std::vector<W> volume(count, W(0));
  for (std::size_t p = 0; p < count; ++p) {
    const Vec3<W> origin = corner(parts.begin[p], 0);
    low[p] = high[p] = origin;
    for (std::size_t i = parts.begin[p]; i < parts.begin[p + 1]; ++i) {
      const Vec3<W> a = corner(i, 0), b = corner(i, 1), c = corner(i, 2);
      volume[p] += (a - origin).dot((b - origin).cross(c - origin));
      low[p] = low[p].cwiseMin(a).cwiseMin(b).cwiseMin(c);
      high[p] = high[p].cwiseMax(a).cwiseMax(b).cwiseMax(c);
    }
  }
  // Could p be a cavity of q?
  const auto fits = [&](std::size_t p, std::size_t q) {
    return volume[q] > -volume[p] && (low[p].array() >= low[q].array()).all() &&
           (high[p].array() <= high[q].array()).all();
  };
  std::vector<std::uint32_t> wrong;
  W total = 0;
  std::size_t least = 0;
  for (std::size_t p = 0; p < count; ++p) {
    total += volume[p];
    if (volume[p] < volume[least]) least = p;
    bool stands = volume[p] > 0;
    for (std::size_t q = 0; q < count && !stands; ++q) stands = fits(p, q);
    const Vec3<W> point = corner(parts.begin[p], 0);
    W winding = 0;
    for (std::size_t q = 0; q < count; ++q) {
      if (q == p || (point.array() < low[q].array()).any() || (point.array() > high[q].array()).any())
        continue;
      for (std::size_t i = parts.begin[q]; i < parts.begin[q + 1]; ++i)
        winding += winding_share<W>(corner(i, 0) - point, corner(i, 1) - point, corner(i, 2) - point);
    }
    const W expected = volume[p] > 0 ? W(0) : W(1);
    // The winding number is 1/2 where the vertex lies on the other part, which is no error: 0.75 is half way
    // from there to a whole number. A volume below 1e-12 of the box's is the sum's rounding (chosen).
    const W box = (high[p] - low[p]).norm();
    if (!stands || std::abs(volume[p]) <= W(1e-12) * box * box * box ||
        std::abs(winding - expected) > W(0.75))
      wrong.push_back(parts.triangles[parts.begin[p]]);
  }
  if (wrong.empty() && !(total > 0)) wrong.push_back(parts.triangles[parts.begin[least]]);
  return wrong;
}

}  // namespace palpate::detail
