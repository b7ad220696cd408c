// SPDX-License-Identifier: MIT
#pragma once

/// @file Topology of a resolved contact with as many points as it needs: a tool has points at two spacings,
/// and where few of the coarse ones touch the fine ones carry the load.

#include <palpate/core/error.hpp>
#include <palpate/resolved/contact_points.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// The same tool's points twice, from `contact_samples`: the fine ones half as far apart as the coarse. Tool
/// coordinates. Reports fine points that are fewer than the coarse, or have another centre of mass.
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
  /// Fine points to which coarse point i is the nearest; coarse ones to which fine point k is.
  [[nodiscard]] std::span<const std::uint32_t> fine_at(std::size_t i) const noexcept { return fine_at_[i]; }
  [[nodiscard]] std::span<const std::uint32_t> coarse_at(std::size_t k) const noexcept {
    return coarse_at_[k];
  }
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
  using Lists = std::vector<std::vector<std::uint32_t>>;
  // By each of the others, those of the points to which it is the nearest.
  [[nodiscard]] static Lists by_nearest(const ToolPoints<S>& points, const ToolPoints<S>& others) {
    Lists out(others.size());
    std::uint32_t nearest = 0;  // the last point's, which is near by
    for (std::uint32_t k = 0; k < points.size(); ++k) {
      const Vec3<S>& x = points.point(k);
      S least = (others.point(nearest) - x).norm();
      const auto nodes = others.nodes();
      for (std::uint32_t n = 0; n < nodes.size();) {
        const auto& node = nodes[n];
        if ((node.centre - x).norm() - node.radius > least) {
          n = node.skip;
          continue;
        }
        if (node.skip == ++n)
          for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (const S far = (others.point(i) - x).norm(); far < least) least = far, nearest = i;
      }
      out[nearest].push_back(k);
    }
    return out;
  }

  ToolPoints<S> coarse_, fine_;
  Lists fine_at_, coarse_at_;
};

/// As ContactPoints<N, Beside>, up to N points of either spacing. With n, the number of coarse points beneath
/// the surface that are alike deep, n = (sum delta)^2/sum delta^2, or by fine points as many as these stand
/// for, the fine ones carry the share
///
///     s = t^2 (3 - 2 t),   t = 2 - n/6, between 0 and 1
///
/// of the load: all of it up to 6, none from 12 on. A ball has 4 and 8 coarse points that carry load there,
/// or 16 and 32 fine ones. In between both are solved, and force, torque, shape, and what the points carry,
/// are the sum of the shares. Elsewhere only one of them is looked at; what a contact keeps, as where it
/// sticks, goes from one to the other. 6 and 12 are chosen: a ball's force is within 2 % rms then where three
/// fine points and more touch, and a tick takes no longer than with that tool deeper in the body.
template <std::size_t N, std::size_t Beside = 0>
struct AdaptiveContactPoints : ContactPoints<N, Beside> {
  static constexpr float all_fine = 6, all_coarse = 12;
  template <Real S>
  using Tool = AdaptiveTool<S>;
};

namespace detail {
template <std::size_t N, std::size_t Beside>
inline constexpr bool is_shipped_topology<AdaptiveContactPoints<N, Beside>> = true;
template <Real S>
struct DefaultTopology<AdaptiveTool<S>> {
  using type = AdaptiveContactPoints<256>;
};
}  // namespace detail

template <class T>
concept AdaptiveTopology = ResolvedTopology<T> && requires { T::all_fine, T::all_coarse; };

}  // namespace palpate
