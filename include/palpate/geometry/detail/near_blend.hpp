// SPDX-License-Identifier: MIT
#pragma once

/// @file  A value on a mesh near a point, without the jumps of the closest point.

#include <palpate/geometry/bvh.hpp>

namespace palpate::detail {

/// Triangles met by one search, as far as there is room.
template <Real S>
struct Seen {
  using Nearest = typename TriangleBvh<S>::Nearest;
  std::array<Nearest, 64> nearest;
  std::size_t count = 0;
  void add(const Nearest& n) noexcept {
    if (count < nearest.size()) nearest[count] = n;
    ++count;
  }
  [[nodiscard]] bool complete() const noexcept { return count <= nearest.size(); }
};

/// Weighted mean of values at the points x_i of the triangles next to the closest one, a continuous function
/// of x:
///
///     sum_i w_i v(x_i) / sum_i w_i,     w_i = (1 + e - d_i / d)_+^2,     e = min(1/4, (h / 4 d)^2)
///
/// x_i is the point of triangle i closest to x, d_i its distance, d the least, h the mean edge length.
/// Projection on a triangle is continuous and so is each weight; the closest point itself jumps below a
/// convex edge.
template <Real S>
class NearBlend {
 public:
  using Nearest = typename TriangleBvh<S>::Nearest;

  explicit NearBlend(S edge) noexcept : edge_(edge) {}

  /// Are points within `spread` [m] of another so close together that their triangles are mostly the same?
  /// Farther apart than about an edge and a half they have too many around them for one walk of the tree.
  [[nodiscard]] bool shares(S spread) const noexcept { return spread <= S(1.5L) * edge_; }

  /// ((1 + e) d)^2: what a search must visit.
  [[nodiscard]] S band(S d) const noexcept {
    const S ratio = d > S(0) ? edge_ / (S(4) * d) : S(1),
            radius = (S(1) + (std::min)(S(0.25L), ratio * ratio)) * d;
    return radius * radius;
  }

  /// (1 + e) d of many.
  template <SimdOrReal V>
  [[nodiscard]] PALPATE_INLINE V radii(const V& d) const noexcept {
    const V root = (min)(edge_ / S(4) / (max)(d, (std::numeric_limits<S>::min)()), S(0.5L));
    return (S(1) + root * root) * d;
  }

  /// The closest point of the mesh, and in `seen` what the mean needs.
  [[nodiscard]] Nearest search(const TriangleBvh<S>& tree, const Vec3<S>& x, std::uint32_t start,
                               Seen<S>& seen) const noexcept {
    return tree.closest_and_near(
        x, start, [this](S d2) { return band(std::sqrt(d2)); }, [&seen](const Nearest& n) { seen.add(n); });
  }

  /// The mean over triangles with of(triangle) true; from `seen`, or where that is not complete from a walk.
  /// d is the least distance of these; `otherwise` where d = 0 leaves no weight.
  template <class Of, class Value>
  [[nodiscard]] Vec3<S> mean(const TriangleBvh<S>& tree, const Vec3<S>& x, S d, const Seen<S>& seen,
                             const Of& of, const Value& value, const Vec3<S>& otherwise) const noexcept {
    const S limit = band(d), radius = std::sqrt(limit);
    Vec3<S> sum = Vec3<S>::Zero();
    S total = S(0);
    const auto add = [&](const Nearest& here) {
      if (!of(here.triangle)) return;
      const S w = (radius - std::sqrt(here.distance2)) / (radius - d);
      sum += w * w * value(here);
      total += w * w;
    };
    if (seen.complete()) {
      for (std::size_t i = 0; i < seen.count; ++i)
        if (seen.nearest[i].distance2 < limit) add(seen.nearest[i]);
    } else {
      tree.overlap(x, radius, add);
    }
    return total > S(0) ? Vec3<S>(sum / total) : otherwise;
  }

 private:
  S edge_;
};

/// Edge of the equilateral triangle of mean area [m].
template <Real S>
[[nodiscard]] inline S mean_edge(S area, std::size_t triangles) noexcept {
  return std::sqrt(area * S(2.3094L) / static_cast<S>(triangles));  // 4 / sqrt(3)
}

}  // namespace palpate::detail
