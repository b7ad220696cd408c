// SPDX-License-Identifier: MIT
#pragma once

/// @file What decorators that give a law memory have in common: without a state, the law itself.

#include <palpate/law/force/concept.hpp>

#include <utility>

namespace palpate::detail {

/// The law of what was never touched. A decorator takes these in with `using`, beside those of a state.
template <ForceLaw L>
class WithLaw {
  static_assert(!RateDependentForceLaw<L> && !StatefulForceLaw<L>,
                "a law with memory would drop the rate term or the state of the law that it is made of");

 public:
  using Scalar = typename L::Scalar;

  [[nodiscard]] Scalar force(Scalar depth) const noexcept { return law_.force(depth); }
  [[nodiscard]] Scalar stiffness(Scalar depth) const noexcept { return law_.stiffness(depth); }
  [[nodiscard]] Scalar energy(Scalar depth) const noexcept { return law_.energy(depth); }
  [[nodiscard]] Scalar depth(Scalar force) const noexcept { return law_.depth(force); }
  [[nodiscard]] Scalar max_depth() const noexcept { return law_.max_depth(); }
  template <class V>
    requires HasForces<L, V>
  [[nodiscard]] V forces(const V& depth) const noexcept {
    return law_.forces(depth);
  }
  [[nodiscard]] const L& law() const noexcept { return law_; }

 protected:
  explicit WithLaw(L law) : law_(std::move(law)) {}

  L law_;
};

}  // namespace palpate::detail
