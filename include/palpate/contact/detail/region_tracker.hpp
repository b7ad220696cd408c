// SPDX-License-Identifier: MIT
#pragma once

/// @file  Touching points to regions, and regions from tick to tick (section III, phases 2 and 3).

#include <palpate/contact/region_slot.hpp>
#include <palpate/core/status.hpp>
#include <palpate/detection/detail/point_grid.hpp>
#include <palpate/detection/detail/proximity_graph.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// Clusters the touching points into at most N regions and keeps the regions' identity.
///
/// Region: connected component of the graph that joins touching tool points nearer than r; the tie |x_i -
/// x_j| = r does not join. The tool is rigid, so the graph is built once and the partition depends only on
/// which points touch: while that set stays the same nothing is computed. A value: a copy goes on from the
/// same tick, and copies among trackers of one tool take no heap.
///
/// Identity: a component continues the region that shares most points with it (or, where it shares none, has
/// most points within r of it). A region that falls apart lives on in the piece with most points; the others
/// are new and name it as parent. Regions that grow together live on in the one with most points. Ties go to
/// the earlier component and the lower slot. Components beyond N join the slot of the nearest region and are
/// reported.
template <Real S, std::size_t N>
class RegionTracker {
 public:
  static constexpr std::uint8_t none = RegionSlot::none;

  explicit RegionTracker(std::size_t points) {
    for (Touched& t : touched_) {
      t.list.resize(points);
      t.where.resize(points);
      t.slot.resize(points);
    }
    queue_.resize(points);
    component_.resize(points);
    components_.resize(points);
  }

  void reset() noexcept {
    slots_ = {};
    touched_[now_].count = 0;
  }

  /// Takes this tick's touching tool points, given by index, with `position(i)` the position of list
  /// entry i [m]. `graph` is the tool's, the same in all ticks.
  template <class Position>
  Status update(const ProximityGraph<S>& graph, std::span<const std::uint32_t> touching,
                const Position& position) noexcept {
    for (std::size_t k = 0; k < N; ++k) {
      slots_[k].merged = std::uint64_t(slots_[k].active) << k;
      slots_[k].parent = none;
    }
    changed_ = false;
    const Touched& last = touched_[now_];
    if (last.count == touching.size() && std::equal(touching.begin(), touching.end(), last.list.begin()))
      return overflow_;
    changed_ = true;
    Touched& next = touched_[1 - now_];
    std::copy(touching.begin(), touching.end(), next.list.begin());
    next.count = touching.size();
    for (std::size_t i = 0; i < next.count; ++i) next.where[next.list[i]] = static_cast<std::uint32_t>(i);
    const std::size_t count = cluster(graph, next);
    assign(graph, last, next, count, position);
    now_ = 1 - now_;
    return overflow_;
  }

  [[nodiscard]] const std::array<RegionSlot, N>& slots() const noexcept { return slots_; }
  /// True when the set of touching points is another than in the last tick.
  [[nodiscard]] bool changed() const noexcept { return changed_; }
  /// The slot of each touching point, in the order given to update().
  [[nodiscard]] std::span<const std::uint8_t> slot_of() const noexcept {
    return {touched_[now_].slot.data(), touched_[now_].count};
  }

 private:
  // The points of one tick as a sparse set: membership in O(1) without clearing anything.
  struct Touched {
    std::vector<std::uint32_t> list;   // touching points
    std::vector<std::uint32_t> where;  // point -> index in list, valid only if list agrees
    std::vector<std::uint8_t> slot;    // slot of each entry of list
    std::size_t count = 0;

    [[nodiscard]] bool contains(std::uint32_t point) const noexcept {
      return where[point] < count && list[where[point]] == point;
    }
  };

  struct Component {
    std::uint32_t begin, end;  // range in queue_, entries of the list
    std::uint8_t slot;
    std::uint8_t parent;  // slot of the last tick that shares most points with it
  };

  // Breadth-first search over the r-graph; queue_ ends up holding the entries grouped by component.
  std::size_t cluster(const ProximityGraph<S>& graph, const Touched& set) noexcept {
    constexpr std::uint32_t unseen = (std::numeric_limits<std::uint32_t>::max)();
    std::fill_n(component_.begin(), set.count, unseen);
    std::size_t components = 0, head = 0, tail = 0;
    for (std::size_t seed = 0; seed < set.count; ++seed) {
      if (component_[seed] != unseen) continue;
      const auto label = static_cast<std::uint32_t>(components);
      components_[components].begin = static_cast<std::uint32_t>(tail);
      component_[seed] = label;
      queue_[tail++] = static_cast<std::uint32_t>(seed);
      while (head < tail) {
        const std::uint32_t entry = queue_[head++];
        for (const std::uint32_t neighbour : graph.neighbours(set.list[entry])) {
          if (!set.contains(neighbour)) continue;
          const std::uint32_t other = set.where[neighbour];
          if (component_[other] != unseen) continue;
          component_[other] = label;
          queue_[tail++] = other;
        }
      }
      components_[components++].end = static_cast<std::uint32_t>(tail);
    }
    return components;
  }

  template <class Position>
  void assign(const ProximityGraph<S>& graph, const Touched& last, Touched& next, std::size_t count,
              const Position& position) noexcept {
    constexpr std::size_t nobody = (std::numeric_limits<std::size_t>::max)();
    std::array<std::size_t, N> heir;  // component that shares most points with each old slot
    std::array<std::uint32_t, N> shared_with_heir{};
    std::array<std::uint32_t, N> shared_by_owner{};
    std::array<std::size_t, N> owner;  // component that takes the slot over
    heir.fill(nobody);
    owner.fill(nobody);

    const auto count_shared = [&](const Component& c) {
      std::array<std::uint32_t, N> shared{};
      for (std::uint32_t q = c.begin; q < c.end; ++q) {
        const std::uint32_t point = next.list[queue_[q]];
        if (last.contains(point)) ++shared[last.slot[last.where[point]]];
      }
      if (std::any_of(shared.begin(), shared.end(), [](std::uint32_t n) { return n > 0; })) return shared;
      // A fast roll exchanges every point in one tick: then being within r of the region counts.
      for (std::uint32_t q = c.begin; q < c.end; ++q) {
        for (const std::uint32_t point : graph.neighbours(next.list[queue_[q]])) {
          if (last.contains(point)) ++shared[last.slot[last.where[point]]];
        }
      }
      return shared;
    };
    for (std::size_t j = 0; j < count; ++j) {
      Component& c = components_[j];
      c.slot = none;
      c.parent = none;
      const auto shared = count_shared(c);
      std::uint32_t max_shared = 0;
      for (std::size_t k = 0; k < N; ++k) {
        if (shared[k] > max_shared) {
          max_shared = shared[k];
          c.parent = static_cast<std::uint8_t>(k);
        }
        if (shared[k] > shared_with_heir[k]) {
          shared_with_heir[k] = shared[k];
          heir[k] = j;
        }
      }
    }
    // An heir of several regions lives on in the slot it shares most points with.
    for (std::size_t k = 0; k < N; ++k) {
      if (heir[k] == nobody) continue;
      Component& c = components_[heir[k]];
      if (c.slot == none || shared_with_heir[k] > shared_by_owner[c.slot]) {
        if (c.slot != none) owner[c.slot] = nobody;
        c.slot = static_cast<std::uint8_t>(k);
        owner[k] = heir[k];
        shared_by_owner[k] = shared_with_heir[k];
      }
    }
    std::array<RegionSlot, N> slots{};
    for (std::size_t k = 0; k < N; ++k) {
      if (heir[k] == nobody) continue;
      RegionSlot& slot = slots[components_[heir[k]].slot];
      slot.merged |= std::uint64_t(1) << k;
    }
    for (std::size_t k = 0; k < N; ++k) {
      if (owner[k] == nobody) continue;
      slots[k].active = true;
      slots[k].id = slots_[k].id;
    }
    overflow_ = Status::ok;
    for (std::size_t j = 0; j < count; ++j) {
      if (components_[j].slot != none) continue;
      const auto free =
          std::find_if(slots.begin(), slots.end(), [](const RegionSlot& s) { return !s.active; });
      if (free == slots.end()) {
        overflow_ = Status::region_overflow;
        continue;
      }
      *free = {true, next_id_++, 0, components_[j].parent};
      components_[j].slot = static_cast<std::uint8_t>(free - slots.begin());
      owner[components_[j].slot] = j;
    }
    for (std::size_t j = 0; j < count; ++j) {
      if (components_[j].slot == none) components_[j].slot = nearest(j, owner, position);
    }
    for (std::size_t j = 0; j < count; ++j) {
      for (std::uint32_t q = components_[j].begin; q < components_[j].end; ++q)
        next.slot[queue_[q]] = components_[j].slot;
    }
    slots_ = slots;
  }

  // The slot whose region's first point is nearest to the first point of component j.
  template <class Position>
  std::uint8_t nearest(std::size_t j, const std::array<std::size_t, N>& owner,
                       const Position& position) const noexcept {
    const Vec3<S> from = position(queue_[components_[j].begin]);
    std::size_t best = 0;
    S min_distance = std::numeric_limits<S>::infinity();
    for (std::size_t k = 0; k < N; ++k) {
      const S distance = (position(queue_[components_[owner[k]].begin]) - from).squaredNorm();
      if (distance < min_distance * detail::PointGrid<S>::tie) {  // of equal ones the lower slot
        min_distance = distance;
        best = k;
      }
    }
    return static_cast<std::uint8_t>(best);
  }

  std::array<Touched, 2> touched_;
  std::size_t now_ = 0;
  std::vector<std::uint32_t> queue_;
  std::vector<std::uint32_t> component_;
  std::vector<Component> components_;
  std::array<RegionSlot, N> slots_{};
  std::uint32_t next_id_ = 1;
  Status overflow_ = Status::ok;
  bool changed_ = false;
};

}  // namespace palpate
