// SPDX-License-Identifier: MIT
#pragma once

/// @file Absent policies: how a policy says that it is absent, and what stands in a class in its place.

#include <concepts>

namespace palpate {

/// A policy that may be absent says so: `active` is false. Then nothing else is asked of it.
template <class P>
concept HasActive = requires {
  { P::active } -> std::convertible_to<bool>;
};

/// An empty member. Each role needs its own type, because two empty members of one type must have distinct
/// addresses.
template <int Role>
struct Absent {};

namespace detail {
/// The policy where it is active, else a stand-in that satisfies everything. Concepts check this one: an
/// alternative (`||`) would do, but compilers do not say which member of an alternative is missing.
template <class P, class StandIn>
struct ActiveOr {
  using type = StandIn;
};
template <class P, class StandIn>
  requires(P::active)
struct ActiveOr<P, StandIn> {
  using type = P;
};
template <class P, class StandIn>
using ActiveOrT = typename ActiveOr<P, StandIn>::type;
}  // namespace detail

}  // namespace palpate
