// SPDX-License-Identifier: MIT
#pragma once

/// @file Skew rules: the force of a displacement D = D_n + D_t (sections IV.B and IV.C). The chooser is in
/// law/friction/concept.hpp.

#include <palpate/law/friction/concept.hpp>
#include <palpate/law/friction/detail/root_below.hpp>

#include <algorithm>
#include <cmath>

namespace palpate {

/// Skew rule of IV.B: each part of D gives its own force, F_cn = law(|D_n|), F_ct = law(|D_t|).
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
};

}  // namespace palpate
