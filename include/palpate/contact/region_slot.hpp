// SPDX-License-Identifier: MIT
#pragma once

/// @file  The slot of a region in the fixed list of regions, and what became of it in this tick.

#include <cstddef>
#include <cstdint>

namespace palpate {

/// Slots keep their index while the region lives, so that state can be stored beside them.
struct RegionSlot {
  static constexpr std::uint8_t none = 255;

  bool active = false;
  std::uint32_t id = 0;        ///< the same as long as the region lives; never used twice
  std::uint64_t merged = 0;    ///< bit k: slot k of the last tick lives on here, its own bit included; 0: new
  std::uint8_t parent = none;  ///< slot of the last tick that a new region split off from

  /// True when some force of the last tick's slot k is carried on here.
  [[nodiscard]] constexpr bool inherits(std::size_t k) const noexcept {
    return active && ((merged >> k & 1u) != 0 || parent == k);
  }
};

/// The slot of a topology with one region: its state from tick to tick.
class SingleSlot {
 public:
  void update(bool touching) noexcept {
    slot_.merged = slot_.active && touching ? 1u : 0u;
    if (touching && !slot_.active) ++slot_.id;
    slot_.active = touching;
  }
  void reset() noexcept { slot_.active = false; }
  [[nodiscard]] const RegionSlot& slot(std::size_t) const noexcept { return slot_; }
  [[nodiscard]] static constexpr bool changed() noexcept { return false; }

 private:
  RegionSlot slot_;
};

}  // namespace palpate
