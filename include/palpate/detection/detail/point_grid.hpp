// SPDX-License-Identifier: MIT
#pragma once

/// @file  Neighbours of a point among many, by a grid of cells. Set-up only.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate::detail {

/// A growing set of points in cubic cells; only cells with points are stored.
template <Real S>
class PointGrid {
 public:
  static constexpr std::uint32_t none = (std::numeric_limits<std::uint32_t>::max)();

  /// Distances within this factor are equal: what a regular shape has in exact arithmetic, roundings must not
  /// tell apart, which are others in another unit. In float by less: 64 roundings are 1e-5 of a distance.
  static constexpr S tie =
      S(1) - (sizeof(S) == sizeof(float) ? S(64) : S(4096)) * std::numeric_limits<S>::epsilon();

  /// For some or all of the points `all` (at least one), and neighbours strictly nearer than r > 0 [m]; r to
  /// rounding is not nearer.
  PointGrid(std::span<const Vec3<S>> all, S r) : square_(r * r * tie), low_(all[0]) {
    Vec3<S> high = low_;
    for (const Vec3<S>& p : all) {
      low_ = low_.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    // 21 bits for each coordinate; a cell a little wider than r makes its rounding harmless.
    cell_ = (std::max)(r * S(1.001L), (high - low_).maxCoeff() / S(1000000));
    while ((std::size_t(1) << bits_) < 2 * all.size()) ++bits_;
    slots_.assign(std::size_t(1) << bits_, {});
  }

  void insert(const Vec3<S>& p) {
    const auto index = static_cast<std::uint32_t>(points_.size());
    Slot& slot = slots_[find(key(cell(p)))];
    slot.key = key(cell(p));
    points_.push_back(p);
    next_.push_back(slot.head);
    slot.head = index;
  }

  /// Calls visit(index, squared distance) for every point of the set nearer to x than r.
  template <class Visit>
  void for_each_near(const Vec3<S>& x, const Visit& visit) const {
    const Cell c = cell(x);
    for (std::uint64_t z = c[2] - 1; z <= c[2] + 1; ++z) {
      for (std::uint64_t y = c[1] - 1; y <= c[1] + 1; ++y) {
        for (std::uint64_t u = c[0] - 1; u <= c[0] + 1; ++u) {
          for (std::uint32_t i = slots_[find(key({u, y, z}))].head; i != none; i = next_[i]) {
            const S d2 = (points_[i] - x).squaredNorm();
            if (d2 < square_) visit(i, d2);
          }
        }
      }
    }
  }

  /// Calls visit(index) for the nearest point nearer to x than r, and for those as near to rounding.
  template <class Visit>
  void for_each_nearest(const Vec3<S>& x, const Visit& visit) const {
    S min_square = square_;
    for_each_near(x, [&](std::uint32_t, S d2) { min_square = (std::min)(min_square, d2); });
    for_each_near(x, [&](std::uint32_t i, S d2) {
      if (d2 * tie <= min_square) visit(i);
    });
  }

  /// The nearest point nearer to x than r, the first of equal ones; `none` if there is none.
  [[nodiscard]] std::uint32_t nearest(const Vec3<S>& x) const {
    std::uint32_t best = none;
    S min_square = square_;
    for_each_near(x, [&](std::uint32_t i, S d2) {
      if (!(d2 < min_square || (d2 == min_square && i < best))) return;
      best = i;
      min_square = d2;
    });
    return best;
  }

 private:
  using Cell = std::array<std::uint64_t, 3>;
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t head = none;  // last point of this cell; none: the slot is free
  };

  // A margin keeps every neighbour's number positive.
  [[nodiscard]] Cell cell(const Vec3<S>& x) const noexcept {
    const Vec3<S> c = (x - low_) / cell_ + Vec3<S>::Constant(S(2));
    return {static_cast<std::uint64_t>(c.x()), static_cast<std::uint64_t>(c.y()),
            static_cast<std::uint64_t>(c.z())};
  }
  [[nodiscard]] static std::uint64_t key(const Cell& c) noexcept { return c[2] << 42 | c[1] << 21 | c[0]; }

  // The key's slot, or the free one where it belongs; at most half of the slots are taken.
  [[nodiscard]] std::size_t find(std::uint64_t k) const noexcept {
    std::size_t i = static_cast<std::size_t>((k * 0x9e3779b97f4a7c15u) >> (64 - bits_));
    while (slots_[i].head != none && slots_[i].key != k) i = (i + 1) & (slots_.size() - 1);
    return i;
  }

  S square_, cell_;
  Vec3<S> low_;
  std::vector<Vec3<S>> points_;
  std::vector<std::uint32_t> next_;  // in the same cell
  std::vector<Slot> slots_;          // open addressing, 2^bits_
  int bits_ = 1;
};

}  // namespace palpate::detail
