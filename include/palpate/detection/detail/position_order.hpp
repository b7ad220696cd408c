// SPDX-License-Identifier: MIT
#pragma once

/// @file An order of points that neither the order in which they were given nor the unit of length changes.
/// Set-up only.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

/// Coordinates that are equal in exact arithmetic, such as those of a grid, differ by roundings, and by
/// others in another unit. So points are compared by whole numbers, their cells along each axis: 2^20 of
/// them over the longest extent. That no coordinate of a regular shape falls on the border of a cell,
/// where a rounding would decide, the cells are shifted by the golden section of one. Points in one cell
/// are compared by their coordinates, then by area, and last by number.
template <Real S>
class PositionOrder {
 public:
  PositionOrder(std::span<const Vec3<S>> points, std::span<const S> areas) : points_(points), areas_(areas) {
    Vec3<double> low = points[0].template cast<double>(), high = low;
    for (const Vec3<S>& p : points) {
      low = low.cwiseMin(p.template cast<double>());
      high = high.cwiseMax(p.template cast<double>());
    }
    const double size = (high - low).maxCoeff();
    cells_.reserve(points.size());
    for (const Vec3<S>& p : points) {
      Cell c{};
      for (std::size_t k = 0; k < 3 && size > 0; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        c[k] = static_cast<std::uint32_t>((static_cast<double>(p[i]) - low[i]) / size * cells + shift);
      }
      cells_.push_back(c);
    }
  }

  /// Does point l stand before point r along this axis?
  [[nodiscard]] bool less(std::uint32_t l, std::uint32_t r, std::size_t axis) const noexcept {
    for (std::size_t k = axis; k < axis + 3; ++k) {
      if (cells_[l][k % 3] != cells_[r][k % 3]) return cells_[l][k % 3] < cells_[r][k % 3];
    }
    for (int k = 0; k < 3; ++k) {
      if (points_[l][k] != points_[r][k]) return points_[l][k] < points_[r][k];
    }
    if (areas_[l] != areas_[r]) return areas_[l] < areas_[r];
    return l < r;
  }

  /// The axis along which these points reach farthest, the first of equal ones.
  [[nodiscard]] std::size_t longest_axis(std::span<const std::uint32_t> points) const noexcept {
    Cell low = cells_[points[0]], high = low, extent;
    for (const std::uint32_t i : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = (std::min)(low[k], cells_[i][k]);
        high[k] = (std::max)(high[k], cells_[i][k]);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) extent[k] = high[k] - low[k];
    return static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  }

 private:
  using Cell = std::array<std::uint32_t, 3>;
  static constexpr double cells = 1 << 20;  // a rounding is 1e-10 of a cell
  static constexpr double shift = 0.6180339887498949;

  std::span<const Vec3<S>> points_;
  std::span<const S> areas_;
  std::vector<Cell> cells_;
};

}  // namespace palpate::detail
