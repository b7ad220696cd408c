// SPDX-License-Identifier: MIT
#pragma once

/// @file  Duffing's law with coefficients that vary over the object.

#include <palpate/law/force/duffing.hpp>
#include <palpate/law/map/detail/spline_map.hpp>

namespace palpate {

/// Duffing's law at one point, with how its coefficients change from there.
template <Real S>
class LocalDuffing : public DuffingForce<S> {
 public:
  using Law = DuffingForce<S>;
  using Pair = Eigen::Array<S, 2, 1, Eigen::DontAlign>;  // c1, c3
  static constexpr const char* name = "DuffingMap";

  /// Precondition: `DuffingForce` would take the coefficients.
  LocalDuffing(const Pair& c, const Vec3<S>& c1_gradient, const Vec3<S>& c3_gradient) noexcept
      : Law({c[0], c[1]}, typename Law::Known{}), c1_gradient_(c1_gradient), c3_gradient_(c3_gradient) {}

  [[nodiscard]] static Pair pair(const typename Law::Params& params) noexcept {
    return {params.c1, params.c3};
  }
  [[nodiscard]] static bool may_sharpen(const Pair& given, const Pair& sharp) noexcept {
    return sharp[0] > given[0] / S(2);
  }

  /// - dU/dx [N] at depth D [m], U = c1 D^2/2 + c3 D^4/4; beyond max_depth() U goes on linearly. 0 for NaN,
  /// for D <= 0 and where it leaves the scalar's range.
  [[nodiscard]] Vec3<S> configurational_force(S depth) const noexcept {
    if (!is_positive(depth)) return Vec3<S>::Zero();
    const S d = (std::min)(depth, this->max_depth()), beyond = depth - d;
    const Vec3<S> f =
        -(d * (d / S(2) + beyond)) * c1_gradient_ - (d * d) * (d * (d / S(4) + beyond)) * c3_gradient_;
    return is_finite(f) ? f : Vec3<S>(Vec3<S>::Zero());
  }

 private:
  Vec3<S> c1_gradient_, c3_gradient_;  // [N/m^2], [N/m^4]
};

/// c1 and c3 over the object. c1/|c3| of a blend is not below the smallest of its nodes, so no blend folds
/// earlier than all of them.
template <Real S>
using DuffingMap = SplineMap<LocalDuffing<S>>;

static_assert(ForceMap<DuffingMap<float>> && ForceMap<DuffingMap<double>>);

}  // namespace palpate
