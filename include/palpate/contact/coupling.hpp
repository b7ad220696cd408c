// SPDX-License-Identifier: MIT
#pragma once

/// @file What contact regions do to each other's force (section VI).
///
/// | shipped              | F_S of a region                                    | use it when             |
/// |----------------------|----------------------------------------------------|-------------------------|
/// | `IndependentRegions` | its own force                                      | absent, the default     |
/// | `RegionSkeletons`    | + the stress forces that the others' beams pass on | regions feel each other |
///
/// The forces of independent regions have a potential. The stress forces have none (docs/beams.md), so
/// friction's promise of passivity is for independent regions only.

#include <palpate/core/absent.hpp>
#include <palpate/core/vector.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace palpate {

/// No region feels another.
struct IndependentRegions {
  static constexpr bool active = false;
  struct Result {};
};

/// A region as the coupling sees it: `{p0, -F_c, D, F_cn}`, [m], [N], [m], [N].
template <class C, class S>
concept HasContact = std::default_initializable<typename C::Contact> && requires(const Vec3<S>& v, S s) {
  (typename C::Contact{v, v, v, s});
};

/// `Result::from_others`: per region, the force on the tool that the others pass on [N].
template <class C, class S>
concept HasFromOthers = std::default_initializable<typename C::Result> &&
                        requires(const typename C::Result& result, std::size_t j) {
                          { result.from_others.size() } noexcept -> std::convertible_to<std::size_t>;
                          { result.from_others[j] } -> std::convertible_to<const Vec3<S>&>;
                        };

/// Fills the result for these regions, at most as many as there are contacts.
template <class C>
concept HasShare =
    requires(const C& coupling, std::span<const typename C::Contact> contacts, typename C::Result& result) {
      { coupling.share(contacts, result) } noexcept;
    };

namespace detail {
/// Checked instead of a coupling that is absent.
template <class S>
struct NoCoupling {
  struct Contact {
    Vec3<S> origin, load, displacement;
    S normal_force;
  };
  struct Result {
    std::span<const Vec3<S>> from_others;
  };
  void share(std::span<const Contact>, Result&) const noexcept;
};
template <class C, class S>
using CheckedCoupling = ActiveOrT<C, NoCoupling<S>>;
}  // namespace detail

/// A coupling is absent when `active` is false; then an empty `Result` is all that is asked of it.
template <class C, class S>
concept RegionForceCoupling =
    std::copyable<C> && HasActive<C> && std::default_initializable<typename C::Result> &&
    HasContact<detail::CheckedCoupling<C, S>, S> && HasFromOthers<detail::CheckedCoupling<C, S>, S> &&
    HasShare<detail::CheckedCoupling<C, S>>;

namespace detail {
template <class Deformation>
struct CouplingOf {
  using type = IndependentRegions;
};
template <class Deformation>
  requires requires { typename Deformation::Coupling; }
struct CouplingOf<Deformation> {
  using type = typename Deformation::Coupling;
};
}  // namespace detail

/// What a deformation model says of the forces between regions, `Deformation::Coupling`; else none.
template <class Deformation>
using DefaultCoupling = typename detail::CouplingOf<Deformation>::type;

static_assert(RegionForceCoupling<IndependentRegions, float> &&
              RegionForceCoupling<IndependentRegions, double>);

}  // namespace palpate
