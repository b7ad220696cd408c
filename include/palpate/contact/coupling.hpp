// SPDX-License-Identifier: MIT
#pragma once

/// @file What contact regions do to each other's force (section VI).
///
/// | shipped              | F_S of a region                      | use it when                            |
/// |----------------------|--------------------------------------|----------------------------------------|
/// | `CompliantRegions`   | less where others have dented        | the default with a deformation model   |
/// | `IndependentRegions` | its own force                        | absent; the default without one        |
/// | `RegionSkeletons`    | + what the others' beams transmit    | comparing with the paper               |
///
/// Independent and compliant regions have a potential, so that friction's promise of passivity holds. The
/// stress forces of beams have none (docs/beams.md); the solver bounds each by the region's own force, so
/// that none pulls, and says so (`Status::stress_bounded`).

#include <palpate/contact/compliant_regions.hpp>
#include <palpate/core/absent.hpp>
#include <palpate/core/vector.hpp>

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

namespace palpate {

/// No region feels another.
struct IndependentRegions {
  static constexpr bool active = false;
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
template <class C>
inline constexpr bool is_compliant_regions = false;
template <ComplianceRatio R>
inline constexpr bool is_compliant_regions<CompliantRegions<R>> = true;
/// A coupling that adds forces to those of the regions.
template <class C>
concept PassesForces = C::active && !is_compliant_regions<C>;

/// Checked instead of a coupling that passes no forces.
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
struct CheckedCouplingOf {
  using type = NoCoupling<S>;
};
template <PassesForces C, class S>
struct CheckedCouplingOf<C, S> {
  using type = C;
};
template <class C, class S>
using CheckedCoupling = typename CheckedCouplingOf<C, S>::type;
}  // namespace detail

/// A coupling is absent when `active` is false; then nothing else is asked of it, nor of `CompliantRegions`,
/// which the solver knows.
template <class C, class S>
concept RegionForceCoupling =
    std::copyable<C> && HasActive<C> && HasContact<detail::CheckedCoupling<C, S>, S> &&
    HasFromOthers<detail::CheckedCoupling<C, S>, S> && HasShare<detail::CheckedCoupling<C, S>>;

/// Where a deformation model draws what regions do to each other, they feel it.
template <class Deformation>
using DefaultCoupling = std::conditional_t<Deformation::active, CompliantRegions<>, IndependentRegions>;

static_assert(RegionForceCoupling<IndependentRegions, float> &&
              RegionForceCoupling<IndependentRegions, double> &&
              RegionForceCoupling<CompliantRegions<>, float> &&
              RegionForceCoupling<CompliantRegions<>, double>);

}  // namespace palpate
