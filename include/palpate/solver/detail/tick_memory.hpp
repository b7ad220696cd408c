// SPDX-License-Identifier: MIT
#pragma once

/// @file What a solver remembers from tick to tick. Of policies that are absent there is nothing.

#include <palpate/contact/contact_state.hpp>
#include <palpate/contact/surface_load.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/fixed_vector.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/inherit.hpp>
#include <palpate/solver/detail/law_memory.hpp>
#include <palpate/solver/rate_window.hpp>
#include <palpate/solver/tick_result.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate::detail {

template <class Item, int Role, bool present>
using Present = std::conditional_t<present, Item, Absent<Role>>;

/// The last tick.
template <Real S>
struct LastTick {
  Pose<S> pose;
  TickResult<S> result{};
  int ticks = 0;  ///< in a row at this pose, up to 2; 0: none yet
};

/// What each region remembers of the force law, where that has memory.
template <class Force, std::size_t N>
struct LawMemories {
  using type = Absent<1>;
};
template <StatefulForceLaw Force, std::size_t N>
struct LawMemories<Force, N> {
  using type = std::array<LawMemory<Force>, N>;
};

/// `Regions`: the collector's state.
template <Real S, class Regions, ForceModel Force, bool has_friction, bool twists, std::size_t N>
struct TickMemory {
  explicit TickMemory(Regions regions) : regions_(std::move(regions)) {}

  /// No contact; a body that has yielded or relaxes stays as it is.
  void forget_contact() noexcept {
    contacts_.clear();
    regions_.reset();
    last_.ticks = 0;
    if constexpr (RateDependentForceLaw<Force>) poses_.clear();
  }
  /// As before the first tick.
  void forget() noexcept {
    forget_contact();
    law_ = {};
  }

  /// The next tick is worked out, though the pose is the last one's.
  void refresh() noexcept { last_.ticks = (std::min)(last_.ticks, 1); }

  [[nodiscard]] auto points() const noexcept
    requires requires(const Regions& r) { r.residual(); }
  {
    return regions_.contacts();
  }
  template <class List>
  void loads(List& out) const noexcept
    requires requires(const Regions& r) { r.residual(); }
  {
    regions_.loads(out);
  }
  void set_beside(std::span<const SurfaceLoad<S>> loads) noexcept
    requires requires(Regions& r) { r.set_beside(loads); }
  {
    regions_.set_beside(loads);
    refresh();
  }
  [[nodiscard]] const auto& residual() const noexcept
    requires requires(const Regions& r) { r.residual(); }
  {
    return regions_.residual();
  }

  Regions regions_;
  LastTick<S> last_{};
  PALPATE_NO_UNIQUE_ADDRESS Present<std::array<FrictionMemory<S, twists>, N>, 0, has_friction> memory_{};
  PALPATE_NO_UNIQUE_ADDRESS typename LawMemories<Force, N>::type law_{};
  PALPATE_NO_UNIQUE_ADDRESS Present<PoseHistory<S>, 2, RateDependentForceLaw<Force>> poses_{};
  FixedVector<ContactState<S>, N> contacts_;
};

}  // namespace palpate::detail
