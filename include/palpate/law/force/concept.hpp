// SPDX-License-Identifier: MIT
#pragma once

/// @file What a force law must offer. Read this before writing one.
///
/// | shipped             | law                         | use it when                                        |
/// |---------------------|-----------------------------|----------------------------------------------------|
/// | `DuffingForce`      | F = c1 D + c3 D^3, eq. (3)  | the default: stiffens (c3 > 0) or softens (c3 < 0) |
/// | `LinearForce`       | F = k D                     | a baseline, or a virtual wall                      |
/// | `PowerLawForce`     | F = k D^p                   | Hertz (p = 3/2), cone (p = 2)                      |
/// | `HertzForce`        | D = (F/k)^(2/3) + C F       | a ball on a body of finite size                    |
/// | `TabulatedForce`    | monotone curve through data | measured or computed force-displacement curves     |
/// | `SaturatedForce<L>` | min(L, limit), smooth       | decorator: caps what a law can ask of the device   |
/// | `DampedForce<L>`    | L + rate term, eq. (1)      | decorator: the transient term; needs dt            |
/// | `PlasticForce<L>`   | L(D - set), yields          | decorator: a dent that stays; has a state          |
/// | `RelaxingForce<L>`  | L, less a Prony series      | decorator: relaxes and creeps; has a state         |
///
/// Convention: depth D [m] > 0 is compression and force F [N] > 0 pushes the tool out; D <= 0 is no contact
/// and gives exactly 0, and so does NaN, whatever the host's flags. No answer is NaN: what leaves the range
/// of the scalar, up to an infinite depth, stays at the law's maximum or is infinity, which the solver
/// refuses. Laws use no heap and no Eigen; what a law remembers is a value that the solver keeps for each
/// region. Absent on purpose: adhesion, because the friction limits are those of F >= 0.

#include <palpate/core/scalar.hpp>

#include <concepts>
#include <span>
#include <type_traits>

namespace palpate {

template <class L>
concept HasScalar = Real<typename L::Scalar>;

template <class L>  // F(D) [N]
concept HasForce = requires(const L& law, typename L::Scalar depth) {
  { law.force(depth) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // dF/dD [N/m], the exact derivative of force()
concept HasStiffness = requires(const L& law, typename L::Scalar depth) {
  { law.stiffness(depth) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // integral of F from 0 to D [J]
concept HasEnergy = requires(const L& law, typename L::Scalar depth) {
  { law.energy(depth) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // the inverse D(F) [m]; F beyond max_force() gives max_depth()
concept HasDepth = requires(const L& law, typename L::Scalar force) {
  { law.depth(force) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // largest depth [m] of the stable (rising) branch, infinity where there is none
concept HasMaxDepth = requires(const L& law) {
  { law.max_depth() } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L,
          class V>  // optional: F of depths in [0, max_depth()], V a register that counts as a number does
concept HasForces = requires(const L& law, const V& depth) {
  { law.forces(depth) } noexcept -> std::same_as<V>;
};

template <class L>  // optional: of D, at the force F, by how much the body as such is displaced [m], >= 0
concept HasBodyDisplacement = requires(const L& law, typename L::Scalar force) {
  { law.body_displacement(force) } noexcept -> std::same_as<typename L::Scalar>;
};

/// Contact force as a function of displacement. Beyond `max_depth()` force() stays at its maximum and
/// stiffness() is 0, so that no law ever returns to another branch.
template <class L>
concept ForceLaw = HasScalar<L> && HasForce<L> && HasStiffness<L> && HasEnergy<L> && HasDepth<L> &&
                   HasMaxDepth<L> && std::copyable<L>;

/// A force law with a rate term as well: `force(depth, rate)` [N] at dD/dt = rate [m/s], never negative.
template <class L>
concept RateDependentForceLaw =
    ForceLaw<L> && requires(const L& law, typename L::Scalar depth, typename L::Scalar rate) {
      { law.force(depth, rate) } noexcept -> std::same_as<typename L::Scalar>;
    };

template <class L>  // what a region remembers; L::State{} has never been touched
concept HasState =
    std::is_trivially_copyable_v<typename L::State> && std::default_initializable<typename L::State>;

template <class L>  // the state dt [s] later, at the depth D [m] reached by then; D <= 0: out of contact
concept HasAdvance =
    requires(const L& law, const typename L::State& state, typename L::Scalar depth, typename L::Scalar dt) {
      { law.advance(state, depth, dt) } noexcept -> std::same_as<typename L::State>;
    };

template <class L>  // F(D) [N] in this state
concept HasStateForce = requires(const L& law, typename L::Scalar depth, const typename L::State& state) {
  { law.force(depth, state) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // dF/dD [N/m] at a constant state, the exact derivative of force()
concept HasStateStiffness = requires(const L& law, typename L::Scalar depth, const typename L::State& state) {
  { law.stiffness(depth, state) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // free energy [J]: what the body could still give back
concept HasStateEnergy = requires(const L& law, typename L::Scalar depth, const typename L::State& state) {
  { law.energy(depth, state) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // the inverse D(F) [m] in this state
concept HasStateDepth = requires(const L& law, typename L::Scalar force, const typename L::State& state) {
  { law.depth(force, state) } noexcept -> std::same_as<typename L::Scalar>;
};

template <class L>  // optional: how near [m] to where a contact ended a new one takes over its state
concept HasExtent = requires(const L& law) {
  { law.extent() } noexcept -> std::same_as<typename L::Scalar>;
};

/// A state that goes on in another region, where regions merged or split.
template <class L>
struct CarriedState {
  typename L::State state;
  typename L::Scalar depth;  ///< D of its region in the last tick [m]
  typename L::Scalar share;  ///< [-] > 0; the shares of all parts add up to 1
};

template <
    class L>  // optional: the state at the depth D [m] that gives the parts' mean share of the law's force
concept HasCarried =
    requires(const L& law, std::span<const CarriedState<L>> parts, typename L::Scalar depth) {
      { law.carried(parts, depth) } noexcept -> std::same_as<typename L::State>;
    };

/// A force law with memory. Its state is a value, one for each region, that `advance` takes over a tick, also
/// while nothing touches; all else reads it. As a `ForceLaw`, without a state, it is the law of what was
/// never touched. Over any path of D, F dD is at least what the free energy rises by: a law with memory only
/// loses energy. Without `extent` the state ends with the contact; without `carried` merged regions go on in
/// the state of the one with most energy, and the force may jump.
template <class L>
concept StatefulForceLaw = ForceLaw<L> && HasState<L> && HasAdvance<L> && HasStateForce<L> &&
                           HasStateStiffness<L> && HasStateEnergy<L> && HasStateDepth<L>;

}  // namespace palpate
