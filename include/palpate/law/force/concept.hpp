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
///
/// Convention: depth D [m] > 0 is compression and force F [N] > 0 pushes the tool out; D <= 0 is no contact
/// and gives exactly 0, and so does NaN, whatever the host's flags. Laws have no state, use no heap and no
/// Eigen. Absent on purpose: adhesion, because the friction limits are those of F >= 0.

#include <palpate/core/scalar.hpp>

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

}  // namespace palpate
