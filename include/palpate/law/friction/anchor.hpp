// SPDX-License-Identifier: MIT
#pragma once

/// @file The origin of the deformation and what sticks to it: the geometry of IV.B for one equivalent
/// contact.

#include <palpate/core/pose.hpp>
#include <palpate/law/friction/slip.hpp>
#include <palpate/law/friction/twist.hpp>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace palpate {

/// The tangential spring between a tool point and the point of the object where it would be unloaded.
///
///     D_t = (1 - n n^T)(X q - origin),   F_t = -F_ct(|D_t|) D_t/|D_t|, acting at X q
///
/// While the contact sticks q, origin and n are constant, so the force derives from a potential and a closed
/// path does no work and leaves no drift. In a slip the stretch is shortened to the slip rule's value, n
/// turns to the contact's present normal and q creeps to the present pressure centre; each by an amount in
/// proportion to the motion, so force and torque stay continuous, and none of it adds elastic energy.
template <Real S>
struct Anchor {
  Vec3<S> point_T;  ///< q, tool coordinates [m]
  Vec3<S> origin;   ///< object coordinates [m]; p0 is the surface point closest to it
  Vec3<S> normal;   ///< n, unit, outward
  Vec3<S> tip;      ///< X q in the last tick [m]
  SlipState<S> slip;

  /// A contact that begins: no stretch. `centre` [m] is the pressure centre, `depth` [m] the equivalent D_n.
  [[nodiscard]] static Anchor begin(const Pose<S>& X, const Vec3<S>& centre, const Vec3<S>& normal,
                                    S depth) noexcept {
    return {X.to_tool(centre), centre + depth * normal, normal, centre, {}};
  }

  /// The stretch D_t [m] with the tool at X.
  [[nodiscard]] Vec3<S> stretch(const Pose<S>& X) const noexcept {
    return tangential<S>(X * point_T - origin, normal);
  }
};

/// What one tick of stick and slip gives.
template <Real S>
struct AnchoredForce {
  Vec3<S> friction;  ///< tangential force on the tool [N], acts at `at`
  Vec3<S> at;        ///< [m]
  Vec3<S> stretch;   ///< D_t [m]
  S normal_force;    ///< F_cn after skewing [N]
};

/// Stands for the torsional spring of a contact that has none.
struct NoTwist {};

/// One tick: moves the anchor by the slip rule and returns the friction on the tool (IV.B, steps 1 to 4).
/// `normal` is the contact's present unit normal, `centre` its pressure centre, `depth` D_n, `normal_force`
/// F_cn. With a `Twist` the region resists rotation about its normal too, with `disc()`, a TwistedDisc, asked
/// only where the tool has turned: force f and torque tau slip together, the slip rule being given the
/// stretch of sqrt(f^2 + (tau/lever)^2), and what it lets go goes from both by the normal of the limit
/// surface.
template <FrictionLaw F, ForceLaw L, class Twisting = NoTwist, class Disc = NoTwist>
[[nodiscard]] inline AnchoredForce<typename L::Scalar> advance(
    Anchor<typename L::Scalar>& anchor, const F& friction, const L& law, const Pose<typename L::Scalar>& X,
    const Vec3<typename L::Scalar>& normal, const Vec3<typename L::Scalar>& centre, typename L::Scalar depth,
    typename L::Scalar normal_force, Twisting&& twist = {}, const Disc& disc = {}) noexcept {
  using S = typename L::Scalar;
  using Slip = typename F::Slip;
  constexpr bool twists = !std::is_same_v<std::remove_cvref_t<Twisting>, NoTwist>;
  const auto& skew = detail::skew_of(friction);
  Vec3<S> tip = X * anchor.point_T;
  Vec3<S> D_t = tangential<S>(tip - anchor.origin, anchor.normal);
  const Vec3<S> motion = tip - anchor.tip;
  const S trial = D_t.norm();
  const S travel = motion.norm();
  const S before = tangential<S>(anchor.tip - anchor.origin, anchor.normal).norm();
  SlipTrial<S> step{depth, normal_force, trial, before, travel};
  [[maybe_unused]] detail::TwistTrial<S> turned;
  if constexpr (twists)
    turned = detail::turn(twist, anchor.slip, skew, law, X.rotation, anchor.normal, disc, step);
  SlipResult<S> now = Slip::advance(friction, skew, law, step, anchor.slip);
  // Where the slip rule takes off no more than a rounding, the contact sticks: q must not creep then.
  constexpr S stuck = S(1) - S(64) * std::numeric_limits<S>::epsilon();
  S slipped = now.stretch < trial * stuck ? (trial - now.stretch) / trial : S(0);
  if constexpr (twists) {
    if (turned.active) slipped = detail::settle(twist, anchor.slip, skew, law, trial, step, turned, now);
  }

  Vec3<S> along;
  if constexpr (Slip::shifts_by_travel) {
    if (anchor.slip.sliding) {
      anchor.origin += tangential<S>(motion, anchor.normal);
      anchor.normal = normal;
      D_t = tangential<S>(tip - anchor.origin, anchor.normal);
    }
    along = unit_or<S>(D_t, Vec3<S>::Zero());
  } else if (slipped > S(0)) {
    // p0 trails the tip by the stretch, so n lags the present normal by that distance.
    const Vec3<S> turned_normal = anchor.normal + (normal - anchor.normal) * slipped;
    anchor.normal = unit_or<S>(turned_normal, normal);
    along = unit_or<S>(tangential<S>(D_t, anchor.normal), Vec3<S>::Zero());
    D_t = now.stretch * along;
    const Vec3<S> creep = centre - tip;
    const S distance = creep.norm();
    if (distance > S(0)) {
      tip += creep * ((std::min)(step.travel, distance) / distance);
      anchor.point_T = X.to_tool(tip);
    }
    anchor.origin = tip - D_t + depth * anchor.normal;
  } else {
    along = unit_or<S>(D_t, Vec3<S>::Zero());
  }
  anchor.tip = tip;
  if constexpr (twists) {
    if (turned.active) detail::set_twist(twist, X.rotation, anchor.normal, turned.angle, slipped);
  }
  return {-now.force.tangential * along, tip, D_t, now.force.normal};
}

}  // namespace palpate
