// SPDX-License-Identifier: MIT
#pragma once

/// @file Regions that feel each other through the body's compliance (VI): what presses here sinks there.
///
/// | shipped               | compliance ratio           | use it when                             |
/// |-----------------------|----------------------------|-----------------------------------------|
/// | `HalfSpaceCompliance` | 1/sqrt(1 + (pi r/(2 a))^2) | the default: a thick body, any material |

#include <palpate/core/scalar.hpp>

#include <cmath>
#include <concepts>
#include <numbers>

namespace palpate {

/// How much a patch of radius a [m] sinks with another at the distance r [m] that is pressed alike, over how
/// much it sinks itself, on a half-space:
///
///     R = 1 / sqrt(1 + (pi r/(2 a))^2)
///
/// The flat punch's own surface is (2/pi) asin(a/r) [johnson1985]. R is 0.03 below it at r = 2 a, 0.009 at
/// 3 a and equal far away; unlike it, R is positive definite for any number of patches in any position
/// [schoenberg1938], so that no combination of presses gives energy back. It does not depend on E and nu. Two
/// pins on cubes of 60 and 100 mm get the response field's force within 4 % (docs/contact.md).
struct HalfSpaceCompliance {
  [[nodiscard]] double ratio(double distance, double radius) const noexcept {
    const double s = std::numbers::pi / 2 * distance / radius;
    return 1 / std::sqrt(1 + s * s);
  }
};

/// ratio(r, a) [-] at r >= 0 [m] for patches of radius a > 0 [m]: in [0, 1], 1 at r = 0.
template <class C>
concept ComplianceRatio = std::copyable<C> && requires(const C& compliance, double length) {
  { compliance.ratio(length, length) } noexcept -> std::same_as<double>;
};

/// Coupling of the regions by compliance, the default wherever there is a deformation. With U_j the energy
/// that patch j of the tool has alone and its amplitude e_j = sqrt(2 U_j):
///
///     W = x.R x/2,   x >= 0,   R x >= e,   x.(R x - e) = 0
///
/// | symbol | name                                                                     | unit  |
/// |--------|--------------------------------------------------------------------------|-------|
/// | U_j    | sum over the touching points of their shares of the law's energy         | J     |
/// | x_j    | amplitude of the force: dW/de_j; the patch's force is x_j/e_j of its own | J^1/2 |
/// | R_jk   | sqrt(s_j s_k) ratio(r_jk), R_jj = 1: constant, because the tool is rigid | -     |
/// | s_j    | the patch's area over the tool's nominal contact area A_0, at most 1     | -     |
///
/// For a linear law it is (C_own + C_jk) F = delta with F >= 0. For any law W is a potential, 0 <= x_j/e_j <=
/// 1, and a patch without force changes nothing: reciprocal, passive, never a pull. A patch within another's
/// dent that no longer touches gets none (III, phase 3). Derivation and figures: docs/contact.md.
///
/// Of a law with memory U_j is the share in what the region gives back in its state, and the state goes on at
/// the depth that the region's own force presses to (docs/contact.md).
///
/// Patches (detail/tool_patches.hpp) belong to the tool, not to the tick: nothing jumps when regions merge.
/// What is nearer to each other than the diameter of A_0 on one part of the tool is not coupled: the force
/// law, which is that of all of A_0, already holds it. Not told apart: which way a patch faces, so that jaws
/// on opposite sides of a thin body relieve each other, which in truth they do not.
template <ComplianceRatio C = HalfSpaceCompliance>
struct CompliantRegions {
  static constexpr bool active = true;
  using Compliance = C;
  struct Result {};

  C compliance{};
};

static_assert(ComplianceRatio<HalfSpaceCompliance>);

}  // namespace palpate
