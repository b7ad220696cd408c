// SPDX-License-Identifier: MIT
#pragma once

/// @file Hertz's law in series with the body, with coefficients that vary over the object: a ball that slides
/// over it.

#include <palpate/law/force/hertz.hpp>
#include <palpate/law/map/detail/spline_map.hpp>

namespace palpate {

/// Hertz's law at one point, with how its coefficients p = k^(-2/3) and C change from there.
template <Real S>
class LocalHertz : public HertzForce<S> {
 public:
  using Law = HertzForce<S>;
  using Pair = Eigen::Array<S, 2, 1, Eigen::DontAlign>;  // p, C: the depth is linear in them
  static constexpr const char* name = "HertzMap";

  /// Precondition: p > 0.
  LocalHertz(const Pair& c, const Vec3<S>& p_gradient, const Vec3<S>& compliance_gradient) noexcept
      : Law({.k = S(1) / (c[0] * std::sqrt(c[0])), .compliance = c[1]}, typename Law::Known{}),
        p_(c[0]),
        p_gradient_(p_gradient),
        compliance_gradient_(compliance_gradient) {}

  [[nodiscard]] static Pair pair(const typename Law::Params& params) noexcept {
    const S root = std::cbrt(params.k);
    return {S(1) / (root * root), params.compliance};
  }
  [[nodiscard]] static bool may_sharpen(const Pair& given, const Pair& sharp) noexcept {
    return sharp[0] > given[0] / S(2) && std::abs(sharp[1] - given[1]) <= std::abs(given[1]) / S(2);
  }

  /// Between the nodes k may be that of one and C that of another: reports a map whose stiffest k and largest
  /// C make no law.
  static void check_blends(const Pair& least, const Pair& most) {
    const S C = (std::max)(std::abs(least[1]), std::abs(most[1]));
    for (const S p : {least[0], most[0]}) (void)Law({.k = S(1) / (p * std::sqrt(p)), .compliance = C});
  }

  /// - dU/dx [N] at depth D [m]: (3/5) F^(5/3) dp/dx + (1/2) F^2 dC/dx; where HertzForce's series has ended,
  /// at D_e with F_e, ((3/5) F_e^(5/3) + (3/5) (F D - F_e D_e) / p) dp/dx + (1/2) F_e^2 dC/dx. 0 for D <= 0,
  /// for NaN and where it leaves the scalar's range.
  [[nodiscard]] Vec3<S> configurational_force(S depth) const noexcept {
    if (!is_positive(depth)) return Vec3<S>::Zero();
    depth = this->finite(depth);
    const auto s = this->at(depth);
    const Vec3<S> f =
        (S(0.6L) / p_ * (s.series_force * s.depth * s.own + this->beyond_series(s, depth))) * p_gradient_ +
        (s.series_force / S(2) * s.series_force) * compliance_gradient_;
    return is_finite(f) ? f : Vec3<S>(Vec3<S>::Zero());
  }

 private:
  S p_;
  Vec3<S> p_gradient_, compliance_gradient_;  // [N^(-2/3)], [1/N]
};

/// k and C over the object.
template <Real S>
using HertzMap = SplineMap<LocalHertz<S>>;

static_assert(ForceMap<HertzMap<float>> && ForceMap<HertzMap<double>>);

}  // namespace palpate
