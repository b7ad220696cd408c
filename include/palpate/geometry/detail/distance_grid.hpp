// SPDX-License-Identifier: MIT
#pragma once

/// @file  Signed distance at the cells of a coarse grid: bounds at every point at the cost of one look-up.

#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::detail {

/// Lower bound of |d| with the sign of d, d the signed distance, at the centre c of each cell of a box, and a
/// triangle near it. Distance changes by at most as much as the position does, so |d(x) - d(c)| <= |x - c|:
/// one look-up tells inside from outside away from the surface, and gives a search near it a triangle to
/// start from.
template <Real S>
class DistanceGrid {
 public:
  static constexpr S slack = S(0.25L);  ///< |d(c)| is at most 1 + slack times the bound; chosen

  struct Cell {
    float distance;          // signed lower bound at the centre [m]
    std::uint32_t triangle;  // near the centre
  };
  struct Bounds {
    S lower, upper;  // of the signed distance [m]
    std::uint32_t triangle;
  };

  /// About `cells` cells over [low, high]. near(x, triangle) gives a bound L with L <= |d(x)| <= (1 + slack)
  /// L and sets the triangle, from which it may start; exact(x, triangle) gives d(x) and likewise. Between
  /// neighbouring centres that are far from the surface the sign does not change, so `exact` is asked near
  /// the surface only. Set-up only.
  template <class Near, class Exact>
  DistanceGrid(const Vec3<S>& low, const Vec3<S>& high, std::size_t cells, const Near& near,
               const Exact& exact)
      : low_(low) {
    const Vec3<S> extent = high - low;
    const S longest = extent.maxCoeff();
    // A flat body counts as a thousandth of its length thick (chosen), or its cells would have no size.
    width_ = longest * std::cbrt((extent / longest).cwiseMax(S(1e-3L)).prod() / static_cast<S>(cells));
    for (int i = 0; i < 3; ++i) {
      const S n = std::ceil(extent[i] / width_);
      count_[static_cast<std::size_t>(i)] = n > S(1) ? static_cast<std::size_t>(n) : 1;
    }
    cells_.reserve(count_[0] * count_[1] * count_[2]);
    for (std::size_t k = 0; k < count_[2]; ++k) {
      for (std::size_t j = 0; j < count_[1]; ++j) {
        for (std::size_t i = 0; i < count_[0]; ++i) {
          const std::size_t n = cells_.size(), row = count_[0], layer = row * count_[1];
          const Cell* before = i > 0   ? &cells_[n - 1]
                               : j > 0 ? &cells_[n - row]
                               : k > 0 ? &cells_[n - layer]
                                       : nullptr;
          std::uint32_t triangle = before ? before->triangle : 0;
          const Vec3<S> c = centre(i, j, k);
          S d = near(c, triangle);
          // Neighbouring centres are one width apart; 1 % more covers the rounding of both.
          if (!before || d < S(1.01L) * width_)
            d = exact(c, triangle);
          else if (before->distance < 0)
            d = -d;
          cells_.push_back({static_cast<float>(d), triangle});
        }
      }
    }
    // Rounding of the float and of the position.
    guard_ = S(8) * S(std::numeric_limits<float>::epsilon()) * (extent.norm() + low.norm());
  }

  /// Precondition: x is finite and within [low, high].
  [[nodiscard]] Bounds at(const Vec3<S>& x) const noexcept {
    std::array<std::size_t, 3> n;
    for (std::size_t i = 0; i < 3; ++i) {
      const S cell = (x[static_cast<int>(i)] - low_[static_cast<int>(i)]) / width_;
      n[i] = cell > S(0) ? (std::min)(static_cast<std::size_t>(cell), count_[i] - 1) : 0;
    }
    const Cell& cell = cells_[(n[2] * count_[1] + n[1]) * count_[0] + n[0]];
    const S offset = (x - centre(n[0], n[1], n[2])).norm() + guard_, d = static_cast<S>(cell.distance);
    const S more = slack * std::abs(d);
    return d < S(0) ? Bounds{d - more - offset, d + offset, cell.triangle}
                    : Bounds{d - offset, d + more + offset, cell.triangle};
  }

 private:
  [[nodiscard]] Vec3<S> centre(std::size_t i, std::size_t j, std::size_t k) const noexcept {
    return low_ + width_ * Vec3<S>(static_cast<S>(i) + S(0.5L), static_cast<S>(j) + S(0.5L),
                                   static_cast<S>(k) + S(0.5L));
  }

  Vec3<S> low_;
  S width_, guard_;
  std::array<std::size_t, 3> count_;
  std::vector<Cell> cells_;
};

}  // namespace palpate::detail
