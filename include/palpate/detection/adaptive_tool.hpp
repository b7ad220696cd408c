// SPDX-License-Identifier: MIT
#pragma once

/// @file A tool's points at two spacings.

#include <palpate/core/error.hpp>
#include <palpate/detection/detail/point_grid.hpp>
#include <palpate/detection/tool_points.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate {

/// The same tool's points twice, from `contact_samples`, for `AdaptiveContactPoints`: the fine ones half as
/// far apart as the coarse. Tool coordinates. Reports fine points that are fewer than the coarse, or have
/// another centre of mass.
template <Real S>
class AdaptiveTool {
 public:
  using Scalar = S;

  AdaptiveTool(ToolPoints<S> coarse, ToolPoints<S> fine)
      : coarse_(std::move(coarse)), fine_(std::move(fine)) {
    constexpr const char* where = "AdaptiveTool";
    if (fine_.size() < coarse_.size())
      fail(where, "needs as many fine points as coarse or more, fine minus coarse must be >= 0",
           static_cast<double>(fine_.size()) - static_cast<double>(coarse_.size()));
    if (fine_.centre_of_mass() != coarse_.centre_of_mass())
      fail(where, "needs one centre of mass, the distance of both points' [m] must be 0",
           static_cast<double>((fine_.centre_of_mass() - coarse_.centre_of_mass()).norm()));
    fine_at_ = by_nearest(fine_, coarse_);
    coarse_at_ = by_nearest(coarse_, fine_);
  }

  [[nodiscard]] const ToolPoints<S>& coarse() const noexcept { return coarse_; }
  [[nodiscard]] const ToolPoints<S>& fine() const noexcept { return fine_; }
  using Lists = std::vector<std::vector<std::uint32_t>>;
  /// By each coarse point, the fine ones to which it is the nearest, nearer than two spacings.
  [[nodiscard]] const Lists& fine_at() const noexcept { return fine_at_; }
  /// By each fine point, the coarse ones, likewise.
  [[nodiscard]] const Lists& coarse_at() const noexcept { return coarse_at_; }
  /// Of both, the coarse ones first: what PointContact::point counts.
  [[nodiscard]] std::size_t size() const noexcept { return coarse_.size() + fine_.size(); }
  [[nodiscard]] const Vec3<S>& point(std::size_t i) const noexcept {
    return i < coarse_.size() ? coarse_.point(i) : fine_.point(i - coarse_.size());
  }
  [[nodiscard]] S area(std::size_t i) const noexcept {
    return i < coarse_.size() ? coarse_.area(i) : fine_.area(i - coarse_.size());
  }
  [[nodiscard]] Vec3<S> centre_of_mass() const noexcept { return coarse_.centre_of_mass(); }

 private:
  // By each of the others, those of the points to which it is the nearest.
  [[nodiscard]] static Lists by_nearest(const ToolPoints<S>& points, const ToolPoints<S>& others) {
    Lists out(others.size());
    const S area = std::accumulate(others.areas().begin(), others.areas().end(), S(0));
    std::vector<Vec3<S>> all(points.points().begin(), points.points().end());
    all.insert(all.end(), others.points().begin(), others.points().end());
    detail::PointGrid<S> grid(all, S(2) * std::sqrt(area / static_cast<S>(others.size())));
    for (const Vec3<S>& x : others.points()) grid.insert(x);
    for (std::uint32_t k = 0; k < points.size(); ++k)
      if (const std::uint32_t i = grid.nearest(points.point(k)); i != grid.none) out[i].push_back(k);
    return out;
  }

  ToolPoints<S> coarse_, fine_;
  Lists fine_at_, coarse_at_;
};

}  // namespace palpate
