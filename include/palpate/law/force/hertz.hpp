// SPDX-License-Identifier: MIT
#pragma once

/// @file A contact that grows with depth, in series with the body behind it: a ball or another smooth tool on
/// a body of finite size.

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {

/// Hertz's contact in series with a spring.
///
///     D = (F/k)^(2/3) + C F,   energy = (2/5) k^(-2/3) F^(5/3) + C F^2 / 2      (F = 0 for D <= 0)
///
/// | symbol | name         | unit    | range                                                             |
/// |--------|--------------|---------|-------------------------------------------------------------------|
/// | D      | argument     | m       | any; D <= 0 and NaN give 0                                        |
/// | k      | `k`          | N/m^1.5 | > 0: (4/3) E/(1-nu^2) sqrt(R), R the relative radius of curvature |
/// | C      | `compliance` | m/N     | of the whole body; 0: half-space, < 0: layer on a stiff base      |
///
/// F = k D^(3/2) where D is small, D/C where it is large. dF/dD is 0 at D = 0. Within 8 epsilon of the exact
/// root. With C < 0 D ends before F does: from e = C k sqrt(D) = -0.3 on, F = 2.06 k D^(3/2). Bad parameters:
/// SetupError. Does not model: friction beneath the tool, depths near R, adhesion. No equation of the paper;
/// sources: [hertz1882], [johnson1985] ch. 4.
template <Real S>
class HertzForce {
 public:
  using Scalar = S;

  struct Params {
    S k;                  ///< [N/m^1.5] > 0
    S compliance = S(0);  ///< [m/N]
  };

  explicit HertzForce(const Params& params) : p_(params) {
    require_positive(p_.k, "HertzForce", "k [N/m^1.5] must be > 0 and finite");
    require_finite(p_.compliance, "HertzForce", "compliance [m/N] must be finite");
    // e = C k sqrt(D) must stay a number up to the largest D, and the series' end above the smallest.
    const S stiff = std::abs(p_.compliance) * p_.k;
    if (!(stiff <= S(0.1L) * std::sqrt((std::numeric_limits<S>::max)())))
      fail("HertzForce", "compliance times k [m^-0.5] is out of the scalar's range",
           static_cast<double>(stiff));
  }

  /// F [N] at depth D [m].
  [[nodiscard]] S force(S depth) const noexcept { return is_positive(depth) ? at(depth).force : S(0); }
  /// dF/dD [N/m] at depth D [m].
  [[nodiscard]] S stiffness(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    depth = finite(depth);
    const Split s = at(depth);
    return s.force / (depth * (depth > s.depth ? S(2) / S(3) : S(1) - s.own / S(3)));
  }
  /// Integral of F from 0 to D [J].
  [[nodiscard]] S energy(S depth) const noexcept {
    if (!is_positive(depth)) return S(0);
    // Exact: int F dD = 2/5 F (D - C F) + 1/2 C F^2 in the series, 2/5 F D of a law D^(3/2) beyond its end.
    depth = finite(depth);
    const Split s = at(depth);
    return s.series_force * s.depth * (S(0.5) - S(0.1L) * s.own) + S(0.4L) * beyond_series(s, depth);
  }
  /// D [m] at the force F [N].
  [[nodiscard]] S depth(S force) const noexcept {
    if (!is_positive(force)) return S(0);
    force = finite(force);
    if (p_.compliance < S(0)) {
      const Split end = at(series_depth());
      if (force > end.force) {
        const S root = std::cbrt(force / (p_.k * end.own * std::sqrt(end.own)));
        return root * root;
      }
    }
    const S root = std::cbrt(force / p_.k);
    // At least 0: the square may be below the smallest number.
    return (std::max)(root * root + p_.compliance * force, S(0));
  }
  /// What is the body's of the depth at the force F [m]; 0 of a layer on a stiff base.
  [[nodiscard]] S body_displacement(S force) const noexcept {
    return (std::max)(p_.compliance, S(0)) * force;
  }
  /// No limit: infinity.
  [[nodiscard]] S max_depth() const noexcept { return std::numeric_limits<S>::infinity(); }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 protected:
  struct Known {};
  HertzForce(const Params& params, Known) noexcept : p_(params) {}

  struct Split {
    S force;         // F [N]
    S depth;         // D, or where the series ends
    S series_force;  // F there [N]
    S own;           // (F/k)^(2/3) / D there: the contact's own share of the depth
  };
  // With F = k D^(3/2) v^3: v^2 + e v^3 = 1, e = C k sqrt(D). The start is within 13 %, and has the slope of
  // v at e = 0; three of Halley's steps, of cubic convergence, leave rounding alone.
  [[nodiscard]] Split at(S depth) const noexcept {
    const S d = (std::min)(depth, series_depth()), root = std::sqrt(d), e = p_.compliance * p_.k * root;
    S v = S(1) / std::cbrt(S(1) + S(1.5) * e);  // slope -1/2 at e = 0
    for (int i = 0; i < 3; ++i) {
      const S ev = e * v, f = v * v * (S(1) + ev) - S(1), f1 = v * (S(2) + S(3) * ev), f2 = S(2) + S(6) * ev;
      v -= S(2) * f * f1 / (S(2) * f1 * f1 - f * f2);
    }
    const S cube = v * v * v, force = p_.k * root * d * cube;
    return {depth > d ? p_.k * std::sqrt(depth) * depth * cube : force, d, force, v * v};
  }
  // F D - F_e D_e [J] beyond where the series ends, else 0; in this order max() gives 0 for infinity less
  // infinity, where F_e D_e alone is out of the range.
  [[nodiscard]] static S beyond_series(const Split& s, S depth) noexcept {
    return (std::max)(S(0), s.force * depth - s.series_force * s.depth);
  }
  // Infinity times or over another number of this law would be NaN.
  [[nodiscard]] static S finite(S x) noexcept { return (std::min)(x, (std::numeric_limits<S>::max)()); }
  // Where the series ends: e = -0.3, chosen before the fold at e = -0.385, -2/(3 sqrt(3)).
  [[nodiscard]] S series_depth() const noexcept {
    if (!(p_.compliance < S(0))) return (std::numeric_limits<S>::max)();
    const S root = S(-0.3L) / (p_.compliance * p_.k);
    return (std::min)(root * root, (std::numeric_limits<S>::max)());
  }

 private:
  Params p_;
};

static_assert(ForceLaw<HertzForce<float>> && ForceLaw<HertzForce<double>>);

}  // namespace palpate
