// SPDX-License-Identifier: MIT
#pragma once

/// @file Skew rules: the force of a displacement D = D_n + D_t (sections IV.B and IV.C). The chooser is in
/// law/friction/concept.hpp.

#include <palpate/core/error.hpp>
#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/detail/root_below.hpp>

#include <algorithm>
#include <cmath>

namespace palpate {

/// Skew rule of IV.B: each part of D gives its own force, F_cn = law(|D_n|), F_ct = law(|D_t|). As stiff
/// across as along, it is the BondedDisc of nu = 0.
struct ByComponents {
  /// `normal_force` is the region's F_cn, already summed; stretch is |D_t| [m].
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SkewedForce<S> force(const L& law, S /*depth*/, S normal_force, S stretch) noexcept {
    return {normal_force, law.force(stretch)};
  }
  /// The stretch |D_t| [m] at which the tangential force is f [N].
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S stretch(const L& law, S /*depth*/, S f) noexcept {
    return law.depth(f);
  }
  /// The largest stretch <= trial [m] whose tangential force is within limit(F_cn).
  template <ForceLaw L, class Limit, Real S = typename L::Scalar>
  [[nodiscard]] static S admissible(const L& law, S /*depth*/, S normal_force, S trial,
                                    const Limit& limit) noexcept {
    const S f_max = limit(normal_force);
    if (law.force(trial) <= f_max) return trial;  // sticks: no inverse needed
    return (std::min)(trial, law.depth(f_max));
  }
  /// Energy [J] that the stretch |D_t| [m] adds.
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S energy(const L& law, S /*depth*/, S stretch) noexcept {
    return law.energy(stretch);
  }
  /// k_t over a^2 dF_n/dD [-] (law/friction/twist.hpp), at nu = 0.
  [[nodiscard]] static constexpr double torsional_ratio() noexcept { return 4.0 / 3.0; }
};

/// Skew rule of a disc bonded to a half-space: as ByComponents, but softer across than along.
///
///     F_ct = r law(|D_t|),   r = (1 - nu)/(1 - nu/2);   torsion: k_t = (4/3)(1 - nu) a^2 dF_n/dD
///
/// | symbol | name | unit | range                                   |
/// |--------|------|------|-----------------------------------------|
/// | nu     | `nu` | -    | [0, 1/2]: r = 1 (ByComponents) to 2/3   |
///
/// From the disc's stiffness 4 G a/(1 - nu) along, 8 G a/(2 - nu) across, 16/3 G a^3 against twist. Bad
/// parameters: SetupError. Own reading of IV.B, which prints r = 1. Source: [johnson1985] ch. 3 and 7,
/// [reissner1944].
template <Real S>
class BondedDisc {
 public:
  struct Params {
    S nu;  ///< Poisson's ratio of the object [-]
  };

  constexpr explicit BondedDisc(const Params& params) : p_(params) {
    if (!is_finite(p_.nu) || !(p_.nu >= S(0) && p_.nu <= S(0.5)))
      fail("BondedDisc", "nu [-] must be in [0, 1/2]", static_cast<double>(p_.nu));
    across_ = (S(1) - p_.nu) / (S(1) - p_.nu / S(2));
  }

  template <ForceLaw L>
  [[nodiscard]] SkewedForce<S> force(const L& law, S /*depth*/, S normal_force, S stretch) const noexcept {
    return {normal_force, across_ * law.force(stretch)};
  }
  template <ForceLaw L>
  [[nodiscard]] S stretch(const L& law, S /*depth*/, S f) const noexcept {
    return law.depth(f / across_);
  }
  template <ForceLaw L, class Limit>
  [[nodiscard]] S admissible(const L& law, S depth, S normal_force, S trial,
                             const Limit& limit) const noexcept {
    const S f_max = limit(normal_force);
    if (across_ * law.force(trial) <= f_max) return trial;  // sticks: no inverse needed
    return (std::min)(trial, stretch(law, depth, f_max));
  }
  template <ForceLaw L>
  [[nodiscard]] S energy(const L& law, S /*depth*/, S stretch) const noexcept {
    return across_ * law.energy(stretch);
  }
  [[nodiscard]] constexpr double torsional_ratio() const noexcept {
    return 4.0 / 3.0 * (1.0 - static_cast<double>(p_.nu));
  }
  [[nodiscard]] constexpr const Params& params() const noexcept { return p_; }

 private:
  Params p_;
  S across_;  // r
};

/// Skew rule of IV.C: F = law(|D|) against D, decomposed into F D_n/|D| and F D_t/|D|. It differs from
/// ByComponents by the law's nonlinear part; the two agree for a linear law.
struct Radial {
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static SkewedForce<S> force(const L& law, S depth, S normal_force, S stretch) noexcept {
    if (!(stretch > S(0))) return {normal_force, S(0)};
    const S length = std::hypot(depth, stretch);
    const S ratio = law.force(length) / length;
    // normal_force is law(depth), and more with a rate term or where a region asks for more than the law's
    // maximum.
    const S unskewed = law.force(depth);
    return {unskewed > S(0) ? normal_force * (ratio * depth / unskewed) : normal_force, ratio * stretch};
  }
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S stretch(const L& law, S depth, S f) noexcept {
    // The ratio law(|D|)/|D| lies between its values at depth and at |D|. Doubling finds an upper end, 60
    // times at most: by then it is 1e18 times as far.
    S high = (std::max)(law.depth(f), depth);
    for (int i = 0; i < 60 && force(law, depth, S(0), high).tangential < f; ++i) high *= S(2);
    return detail::root_below(high, [&](S t) { return force(law, depth, S(0), t).tangential - f; });
  }
  template <ForceLaw L, class Limit, Real S = typename L::Scalar>
  [[nodiscard]] static S admissible(const L& law, S depth, S normal_force, S trial,
                                    const Limit& limit) noexcept {
    const auto excess = [&](S t) {
      const SkewedForce<S> f = force(law, depth, normal_force, t);
      return f.tangential - limit(f.normal);
    };
    return excess(trial) > S(0) ? detail::root_below(trial, excess) : trial;
  }
  template <ForceLaw L, Real S = typename L::Scalar>
  [[nodiscard]] static S energy(const L& law, S depth, S stretch) noexcept {
    return law.energy(std::hypot(depth, stretch)) - law.energy(depth);
  }
  /// As ByComponents.
  [[nodiscard]] static constexpr double torsional_ratio() noexcept { return 4.0 / 3.0; }
};

}  // namespace palpate
