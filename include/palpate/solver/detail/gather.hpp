// SPDX-License-Identifier: MIT
#pragma once

/// @file From the tool's pose to the sums of its regions: one collector per topology, all with the same
/// interface. A collector is set up once and does not change; what changes is its state, a value.
///
///     Sum<Force>                                           what adds up a region
///     State, initial_state()                               from tick to tick: slot(k), changed(), reset()
///     Status collect(object, tool, force, X, state, sums)  finds what touches and adds it up, by slot; else
///                                                          there are no sums

#include <palpate/contact/detail/entry_side.hpp>
#include <palpate/contact/detail/region_tracker.hpp>
#include <palpate/contact/region_slot.hpp>
#include <palpate/contact/topology.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/detection/candidates.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/leaf_share.hpp>
#include <palpate/solver/detail/relief.hpp>
#include <palpate/solver/detail/tick_sums.hpp>
#include <palpate/solver/detail/touching_leaves.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace palpate {

namespace detail {
/// Status bits of a point at `depth` [m].
template <ContactSurface Object, ForceModel Force>
[[nodiscard]] inline Status depth_status(const Object& object, const Force& force,
                                         typename Object::Scalar depth) noexcept {
  Status status = Status::ok;
  if (depth > object.reach()) status |= Status::beyond_reach;
  if (depth > force.max_depth()) status |= Status::beyond_stable;
  return status;
}

/// Depth [m] above which nothing can be past the middle of the body (EntrySide). Exact surfaces know their
/// reach; that of a mesh is an estimate, and a part of it may be thinner.
template <ContactSurface Object>
[[nodiscard]] inline typename Object::Scalar shallow(const Object& object) noexcept {
  using S = typename Object::Scalar;
  if constexpr (ParametricSurface<Object>) return object.reach() / S(4);
  return S(0);
}

/// The state of a topology with one region.
template <Real S>
class OneRegion : public SingleSlot {
 public:
  /// After update() in contact.
  template <class Sum>
  Status keep_side(const Pose<S>& X, S shallow, Sum& sum) noexcept {
    if (this->slot(0).merged == 0) side_.begin();
    return side_.update(X, shallow, sum);
  }

 private:
  EntrySide<S> side_;
};

/// What adds up a region of many points. A law with memory asks for the region's energy too.
template <class Force, Real S, class Without>
using SumFor = std::conditional_t<StatefulForceLaw<Force>, EnergySum<S, Without>, Without>;

template <class Leaves, StatefulForceLaw Law, Real S, class Base>
inline void add_energy(const Leaves& leaves, const ToolPoints<S>& tool, std::uint32_t begin, const Law& law,
                       const Pose<S>& X, const PenetrationBatch<S>& in, EnergySum<S, Base>& sum) noexcept {
  std::array<S, batch_size> energy, f;
  leaves.alone(tool, begin, law, X, in, energy, f);
  for (std::size_t i = 0; i < batch_size; ++i) {
    sum.energy += energy[i];
    sum.square += f[i] * law.force(in.depth[i]);
  }
}
}  // namespace detail

/// `Coupling` counts for topologies of several regions.
template <class Contacts, Real S, class Coupling>
class Collector;

template <Real S, class Coupling>
class Collector<SinglePoint, S, Coupling> {
 public:
  Collector(const SinglePoint&, const PointTool<S>&, const Coupling&) noexcept {}

  /// A map adds a force of its own, whose direction is another.
  template <ForceModel Force>
  using Sum = std::conditional_t<ForceMap<Force>, RegionSum<S>, PointForce<S>>;

  using State = detail::OneRegion<S>;
  [[nodiscard]] State initial_state() const noexcept { return {}; }

  template <ContactSurface Object, ForceModel Force>
  Status collect(const Object& object, const PointTool<S>& tool, const Force& force, const Pose<S>& X,
                 State& state, detail::TickSums<Sum<Force>, 1>& sums) const noexcept {
    const Vec3<S> x = X * tool.tip;
    const Penetration<S> in = object.penetration(x);
    const bool touching = in.depth > S(0);
    state.update(touching);
    if (!touching) return Status::ok;
    const auto& law = detail::law_at(force, x);
    return detail::depth_status(object, force, in.depth) |
           add<Force>(object, tool, law, X, x, in, law.force(in.depth), state, sums);
  }

 protected:
  /// The point at x [m] with the force f [N] of `law`, that of `Force` there.
  template <ForceModel Force, ContactSurface Object>
  PALPATE_INLINE static Status add(const Object& object, const PointTool<S>& tool, const auto& law,
                                   const Pose<S>& X, const Vec3<S>& x, const Penetration<S>& in, S f,
                                   State& state, detail::TickSums<Sum<Force>, 1>& sums) noexcept {
    const Vec3<S> arm = X.rotation * (tool.tip - tool.centre_of_mass);
    Sum<Force>& sum = detail::begin<Force>(sums)[0];
    sum.add(x, arm, in.gradient, in.depth, f, S(0));
    if constexpr (ForceMap<Force>) sum.add(arm, law.configurational_force(in.depth));
    return Status::contact | state.keep_side(X, detail::shallow(object), sum);
  }
};

template <MassSharing Sharing, Real S, class Coupling>
class Collector<SingleRegion<Sharing>, S, Coupling> {
 public:
  template <ForceModel Force>
  using Sum = detail::SumFor<Force, S, RegionSum<S>>;

  Collector(const SingleRegion<Sharing>&, const ToolPoints<S>& tool, const Coupling&) : leaves_(tool) {}

  using State = detail::OneRegion<S>;
  [[nodiscard]] State initial_state() const noexcept { return {}; }

  template <ContactSurface Object, ForceModel Force>
  PALPATE_INLINE Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force,
                                const Pose<S>& X, State& state,
                                detail::TickSums<Sum<Force>, 1>& sums) const noexcept {
    auto leaves = leaves_.begin(tool, X);
    detail::for_each_touching_leaf(
        tool, X, object,
        [&](std::uint32_t begin, const PointBatch<S>& x, const PenetrationBatch<S>& in) noexcept {
          leaves_.add(tool, begin, force, x, in, leaves);
          if constexpr (StatefulForceLaw<Force>)
            detail::add_energy(leaves_, tool, begin, force, X, in, sums.list()[0]);
        });
    state.update(!leaves.empty());
    if (leaves.empty()) return Status::ok;
    Sum<Force>& sum = detail::begin<Force>(sums)[0];
    static_cast<RegionSum<S>&>(sum) = leaves.total();
    sum.scale(Sharing::norm(static_cast<S>(sum.points)));
    return Status::contact | detail::depth_status(object, force, sum.deepest) |
           state.keep_side(X, detail::shallow(object), sum);
  }

 private:
  detail::Leaves<Sharing, S> leaves_;
};

template <std::size_t N, MassSharing Sharing, Real S, class Coupling>
class Collector<Regions<N, Sharing>, S, Coupling> {
  using Relief = detail::Relief<Coupling, N, Sharing, S>;
  static constexpr std::uint32_t leaf_size = static_cast<std::uint32_t>(batch_size);
  /// Of the touching points [m]. A type of its own, so that the tracker is compiled once for all objects.
  struct Positions {
    const ToolPoints<S>* tool;
    const Pose<S>* pose;
    const std::uint32_t* point;
    [[nodiscard]] Vec3<S> operator()(std::size_t i) const noexcept { return *pose * tool->point(point[i]); }
  };
  struct Leaf {
    std::uint32_t begin;
    std::uint64_t slots;                          // of its touching points, as bits
    std::array<std::uint8_t, batch_size> slot{};  // of each of them
    PenetrationBatch<S> in;
  };

 public:
  template <ForceModel Force>
  using Sum = detail::SumFor<Force, S, typename Relief::Sum>;

  Collector(const Regions<N, Sharing>& regions, const ToolPoints<S>& tool, const Coupling& coupling)
      : graph_(tool, static_cast<S>(regions.distance)),
        leaves_(tool),
        points_(tool.size()),
        relief_(coupling, tool, graph_) {}

  /// The regions' identity, and the lists that a tick works in.
  class State {
   public:
    [[nodiscard]] const RegionSlot& slot(std::size_t k) const noexcept { return tracker_.slots()[k]; }
    [[nodiscard]] bool changed() const noexcept { return tracker_.changed(); }
    void reset() noexcept { tracker_.reset(); }

   private:
    friend class Collector;
    State(std::size_t points, std::size_t leaves) : tracker_(points), leaf_(leaves), point_(points + 1) {}

    // The slots of each leaf's touching points; they stay while those points stay.
    void find_slots(std::size_t leaves, std::size_t count) noexcept {
      std::size_t next = 0;
      met_ = 0;
      for (std::size_t k = 0; k < leaves; ++k) {
        Leaf& leaf = leaf_[k];
        leaf.slots = 0;
        for (; next < count && point_[next] < leaf.begin + leaf_size; ++next) {
          const std::uint8_t slot = tracker_.slot_of()[next];
          leaf.slots |= std::uint64_t(1) << slot;
          leaf.slot[point_[next] - leaf.begin] = slot;
        }
        met_ |= leaf.slots;
      }
    }

    Status keep_side(std::size_t k, const Pose<S>& X, S shallow, RegionSum<S>& sum) noexcept {
      const RegionSlot& slot = tracker_.slots()[k];
      if (slot.merged == 0) {
        if (slot.parent == RegionSlot::none)
          side_[k].begin();
        else
          side_[k] = side_[slot.parent];  // split off
      }
      return side_[k].update(X, shallow, sum);
    }

    RegionTracker<S, N> tracker_;
    std::array<detail::EntrySide<S>, N> side_;
    std::vector<Leaf> leaf_;            // of this tick, those with touching points
    std::vector<std::uint32_t> point_;  // touching tool points of this tick, in order
    std::uint64_t met_ = 0;             // slots that have points, as bits
  };
  [[nodiscard]] State initial_state() const { return State(points_, leaves_.size()); }

  /// `memory`: a LawTick, where a law with memory meets a relief.
  template <ContactSurface Object, ForceModel Force, class... Memory>
  Status collect(const Object& object, const ToolPoints<S>& tool, const Force& force, const Pose<S>& X,
                 State& state, detail::TickSums<Sum<Force>, N>& all, const Memory&... memory) const noexcept {
    std::size_t leaves = 0, count = 0;
    S deepest = S(0);
    detail::for_each_touching_leaf(
        tool, X, object,
        [&](std::uint32_t begin, const PointBatch<S>&, const PenetrationBatch<S>& in) noexcept {
          Leaf& leaf = state.leaf_[leaves];
          leaf.begin = begin;
          leaf.in = in;
          ++leaves;
          for (std::uint32_t i = 0; i < leaf_size; ++i) {
            state.point_[count] =
                begin + i;  // without a branch: overwritten by the next one unless it touches
            count += in.depth[i] > S(0) ? 1u : 0u;
          }
          deepest = (std::max)(deepest, detail::max_of(in.depth));
        });
    Status status = state.tracker_.update(graph_, {state.point_.data(), count},
                                          Positions{&tool, &X, state.point_.data()});
    if (count == 0) return Status::ok;
    auto& sums = detail::begin<Force>(all);
    const S shallow = detail::shallow(object);
    if (state.tracker_.changed()) state.find_slots(leaves, count);
    const std::span<const Leaf> touching(state.leaf_.data(), leaves);
    const auto add_energy = [&]([[maybe_unused]] std::size_t slot, [[maybe_unused]] std::uint32_t begin,
                                [[maybe_unused]] const PenetrationBatch<S>& in, const auto& relief) noexcept {
      if constexpr (StatefulForceLaw<Force>) {  // of the regions without each other
        if constexpr (std::same_as<std::remove_cvref_t<decltype(relief)>, detail::AllLeft>)
          detail::add_energy(leaves_, tool, begin, force, X, in, sums[slot]);
      }
    };
    const auto add_up = [&](std::size_t slot, const auto& relief) noexcept {
      const std::uint64_t bit = std::uint64_t(1) << slot;
      auto sum = leaves_.begin(tool, X);
      for (const Leaf& leaf : touching) {
        if ((leaf.slots & bit) == 0) continue;
        // Placed anew: less work than to keep them, once other programs' data have taken the caches.
        const PointBatch<S>& x = leaves_.placed(tool, leaf.begin, X);
        if (leaf.slots == bit) {
          leaves_.add(tool, leaf.begin, force, x, leaf.in, sum, relief_.left(relief, leaf.begin, slot));
          add_energy(slot, leaf.begin, leaf.in, relief);
          continue;
        }
        PenetrationBatch<S> own = leaf.in;
        for (std::uint32_t i = 0; i < leaf_size; ++i)
          own.depth[i] = leaf.slot[i] == slot ? own.depth[i] : S(0);
        leaves_.add(tool, leaf.begin, force, x, own, sum, relief_.left(relief, leaf.begin, slot));
        add_energy(slot, leaf.begin, own, relief);
      }
      static_cast<RegionSum<S>&>(sums[slot]) = sum.total();
      sums[slot].scale(Sharing::norm(static_cast<S>(sums[slot].points)));
    };
    if constexpr (sizeof...(Memory) > 0) {  // what is remembered goes by the regions without each other
      for (std::size_t slot = 0; slot < N; ++slot)
        if ((state.met_ >> slot & 1u) != 0) add_up(slot, detail::AllLeft{});
    }
    const auto relief = relief_.relieve(tool, force, X, touching, leaves_, state, sums, memory...);
    for (std::size_t slot = 0; slot < N; ++slot) {
      if ((state.met_ >> slot & 1u) == 0) continue;
      add_up(slot, relief);
      if constexpr (Relief::active) sums[slot].full = relief.full[slot];
      status |= state.keep_side(slot, X, shallow, sums[slot]);
    }
    return status | Status::contact | detail::depth_status(object, force, deepest);
  }

 private:
  ProximityGraph<S> graph_;
  detail::Leaves<Sharing, S> leaves_;
  std::size_t points_;
  PALPATE_NO_UNIQUE_ADDRESS Relief relief_;
};

template <class T, Real S, class Coupling>
class Collector<Coarse<T>, S, Coupling> : public Collector<T, S, Coupling> {
  using Base = Collector<T, S, Coupling>;

 public:
  using Base::Base;

  template <ContactSurface Object, ForceModel Force, class State, class Sums>
  Status collect(const Object& object, const CoarseTool<S>& tool, const Force& force, const Pose<S>& X,
                 State& state, Sums& sums) const noexcept {
    const Status status = Base::collect(object, tool, force, X, state, sums);
    return tool.is_coarse() ? status | Status::coarsened : status;
  }
};

}  // namespace palpate
