// SPDX-License-Identifier: MIT
#pragma once

/// @file What contact regions do to each other's force (section VI).
///
/// | shipped              | F_S of a region                                     | use it when                                    |
/// |----------------------|-----------------------------------------------------|------------------------------------------------|
/// | `IndependentRegions` | its own force                                       | absent, the default: forces have a potential   |
/// | `RegionSkeletons`    | + the stress forces that the others' beams pass on  | the paper's VI: regions feel each other        |
///
/// The stress forces have no potential (docs/beams.md), so friction's promise of passivity holds for
/// independent regions only.

#include <palpate/core/scalar.hpp>

#include <concepts>
#include <span>

namespace palpate {

/// No region feels another.
struct IndependentRegions {
  static constexpr bool active = false;
  struct Result {};
};

/// A coupling is absent when `active` is false; otherwise `share()` takes the regions' contacts and gives,
/// per contact, the force on the tool that the others pass on (`Result::from_others` [N]).
template <class C>
concept RegionForceCoupling =
    std::copyable<C> &&
    requires {
      { C::active } -> std::convertible_to<bool>;
    } &&
    (!C::active ||
     requires(const C& coupling, std::span<const typename C::Contact> contacts, typename C::Result& result) {
       { coupling.share(contacts, result) } noexcept;
       result.from_others[0];
     });

static_assert(RegionForceCoupling<IndependentRegions>);

}  // namespace palpate
