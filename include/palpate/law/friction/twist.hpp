// SPDX-License-Identifier: MIT
#pragma once

/// @file The torsional spring of a region that sticks: torque against twist about the contact's normal.

#include <palpate/core/vector.hpp>
#include <palpate/law/friction/concept.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate {

/// The region as a disc: what its torsional spring is made of.
template <Real S>
struct TwistedDisc {
  S radius;     ///< a [m], of the area that carries the force; 0: a point, without torque
  S stiffness;  ///< k_t [N m/rad]: SkewRule::torsional_ratio() a^2 dF_n/dD
};

/// Torque of a bonded disc that is turned about its normal, and what it remembers.
///
///     tau = k_t theta,   k_t = 16/3 G a^3 = (4/3)(1 - nu) a^2 dF_n/dD       (bonded disc on a half-space)
///     slip: (f/f_max)^2 + (tau/tau_max)^2 <= 1,   tau_max = (2/3) a f_max    (disc under even pressure)
///
/// theta is the twist of the tool's rotation since `reference` about the normal n (swing-twist
/// decomposition); the torque is minus the gradient of k_t theta^2/2, so a path that sticks and closes does
/// no work. k_t grows with the region: what is added comes unstressed, the torque stays and the energy falls.
/// It does not shrink with the region while the contact sticks, or a trembling hand would wear the torque
/// off; a slip lets it, as far as the energy that it sets free allows. Source: [reissner1944], [johnson1985];
/// slip: [howe1996].
template <Real S>
struct Twist {
  Mat3<S> reference = Mat3<S>::Identity();  ///< the tool's rotation that gives no torque
  S stiffness = S(0);                       ///< k_t [N m/rad]
  S angle = S(0);                           ///< theta of the last tick [rad]
  Vec3<S> torque = Vec3<S>::Zero();         ///< on the tool, of the last tick [N m]

  /// No torque with the tool turned as now.
  void release(const Mat3<S>& rotation) noexcept { *this = {rotation, S(0), S(0), Vec3<S>::Zero()}; }
  /// About n [N m].
  [[nodiscard]] S about_normal() const noexcept { return stiffness * angle; }
};

namespace detail {

/// Of the disc with this area [m].
template <Real S>
[[nodiscard]] inline S radius_of(S area) noexcept {
  return std::sqrt(area / std::numbers::pi_v<S>);
}

/// The lever at which friction acts on a disc under even pressure: tau_max = lever f_max.
template <Real S>
[[nodiscard]] constexpr S friction_lever(S radius) noexcept {
  return S(2) / S(3) * radius;
}

/// A rotation as swing after a twist about the unit vector n.
template <Real S>
struct SwingTwist {
  Eigen::Quaternion<S> swing;
  S twist;  // [rad], within a half turn

  SwingTwist(const Eigen::Quaternion<S>& q, const Vec3<S>& n) noexcept {
    const S along = n.dot(q.vec()), w = q.w() < S(0) ? -q.w() : q.w(), t = q.w() < S(0) ? -along : along;
    twist = S(2) * std::atan2(t, w);
    swing = q * about(n, -twist);
  }
  static Eigen::Quaternion<S> about(const Vec3<S>& n, S angle) noexcept {
    const Vec3<S> v = std::sin(angle / S(2)) * n;
    return Eigen::Quaternion<S>(std::cos(angle / S(2)), v.x(), v.y(), v.z());
  }
};

/// d theta/d(rotation vector of the tool) of the twist about n of the rotation q: n, but for what swing there
/// is.
template <Real S>
[[nodiscard]] Vec3<S> twist_gradient(const Eigen::Quaternion<S>& q, const Vec3<S>& n) noexcept {
  const Vec3<S> v = q.vec();
  const S w = q.w(), t = n.dot(v);
  return (w * w * n + w * v.cross(n) + t * v) / (w * w + t * t);
}

/// The twist of `state` with the tool turned to `rotation`. A tool that has not turned has none: no work.
template <Real S>
[[nodiscard]] inline S twist_angle(const Twist<S>& state, const Mat3<S>& rotation,
                                   const Vec3<S>& n) noexcept {
  if (rotation == state.reference) return S(0);
  return SwingTwist<S>(Eigen::Quaternion<S>(Mat3<S>(rotation * state.reference.transpose())), n).twist;
}

/// Sets `state` so that its twist about n is `angle`, with the share `slipped` of its swing gone, and its
/// torque.
template <Real S>
inline void set_twist(Twist<S>& state, const Mat3<S>& rotation, const Vec3<S>& n, S angle,
                      S slipped) noexcept {
  Eigen::Quaternion<S> q(Mat3<S>(rotation * state.reference.transpose()));
  const SwingTwist<S> parts(q, n);
  // Rolled by more than a quarter turn without a slip: begins anew from here.
  const bool far = parts.swing.w() * parts.swing.w() < S(0.5);
  if (slipped > S(0) || far || parts.twist != angle) {
    const Eigen::Quaternion<S> none = Eigen::Quaternion<S>::Identity();
    q = (far ? none : none.slerp(S(1) - slipped, parts.swing)) * SwingTwist<S>::about(n, angle);
    state.reference = (q.conjugate() * Eigen::Quaternion<S>(rotation)).normalized().toRotationMatrix();
  }
  state.angle = angle;
  state.torque = -state.stiffness * angle * twist_gradient(q, n);
}

/// The point of the disc f^2 + t^2 = R^2 that [f, t], outside it, comes back to by the normal of the disc, f
/// being a force in a spring 1 and t in one p times as stiff: [f/(1 + g), t/(1 + p g)]. Newton's method for
/// 1/|.| = 1/R, nearly straight in g; what it leaves is scaled away.
template <Real S>
inline void return_to_disc(S R, S p, S& f, S& t) noexcept {
  S g = S(0), a = f, b = t;
  for (int i = 0; i < 6; ++i) {
    const S u = S(1) + g, v = S(1) + p * g;
    a = f / u;
    b = t / v;
    const S norm2 = a * a + b * b, norm = std::sqrt(norm2);
    const S slope = a * a / u + p * b * b / v;
    if (!(norm > R) || !(slope > S(0)) || !(R > S(0))) break;
    g += (norm / R - S(1)) * norm2 / slope;
  }
  const S norm = std::hypot(a, b), scale = norm > S(0) ? (std::min)(R / norm, S(1)) : S(0);
  f = a * scale;
  t = b * scale;
}

/// One tick's rotation of a region that sticks, as the slip rule sees it.
template <Real S>
struct TwistTrial {
  bool active = false;  // there is a torque
  S force = S(0);       // f, if the contact stuck in this tick [N]
  S torque = S(0);      // tau about n, likewise [N m]
  S lever = S(0);       // [m]
  S present = S(0);     // k_t of the region as it is [N m/rad]
  S angle = S(0);       // theta that is left [rad]
};

/// Adds the torque of the tool's rotation to the stretch, its value before, and the travel of `step`.
template <Real S, class Skew, ForceLaw L, class Disc>
[[nodiscard]] inline TwistTrial<S> turn(Twist<S>& twist, const SlipState<S>& slip, const Skew& skew,
                                        const L& law, const Mat3<S>& rotation, const Vec3<S>& n,
                                        const Disc& disc, SlipTrial<S>& step) noexcept {
  const S angle = twist_angle(twist, rotation, n);
  if (angle == S(0) && twist.angle == S(0)) {
    twist.stiffness = S(0);  // nothing is stored in it
    twist.torque = Vec3<S>::Zero();
    return {};
  }
  const TwistedDisc<S> region = disc();
  TwistTrial<S> trial;
  trial.lever = friction_lever(region.radius);
  // No lever: its square, by which is divided, is none in S.
  if (!(trial.lever * trial.lever > (std::numeric_limits<S>::min)()) || !is_finite(region.stiffness)) {
    twist.release(rotation);
    return {};
  }
  trial.active = true;
  trial.present = region.stiffness;
  // What the region has grown by comes unstressed: it takes part in this tick's rotation alone.
  trial.torque = region.stiffness > twist.stiffness
                     ? twist.about_normal() + region.stiffness * (angle - twist.angle)
                     : twist.stiffness * angle;
  const S torque_before = twist.about_normal();
  const S travel = trial.lever * (angle - twist.angle);
  twist.stiffness = (std::max)(twist.stiffness, region.stiffness);
  // A spring that is linear in the angle means nothing beyond a quarter turn (chosen), and must not pass a
  // half.
  const S most = std::numbers::pi_v<S> / S(2) * twist.stiffness;
  trial.torque = std::clamp(trial.torque, -most, most);
  const auto force = [&](S stretch) {
    return slip.springs * skew.force(law, step.depth, step.normal_force, stretch).tangential;
  };
  const auto joint = [&](S f, S torque) {
    return skew.stretch(law, step.depth, std::hypot(f, torque / trial.lever) / slip.springs);
  };
  trial.force = force(step.stretch);
  step.stretch = joint(trial.force, trial.torque);
  step.before = joint(force(step.before), torque_before);
  step.travel = std::hypot(step.travel, travel);
  return trial;
}

/// Shares what the slip rule left between force and torque: `result`, for the joint stretch of `step`,
/// becomes that of the contact's own stretch. Returns the part that slipped.
template <Real S, class Skew, ForceLaw L>
[[nodiscard]] inline S settle(Twist<S>& twist, const SlipState<S>& slip, const Skew& skew, const L& law,
                              S stuck, const SlipTrial<S>& step, TwistTrial<S>& trial,
                              SlipResult<S>& result) noexcept {
  const S joint = std::hypot(trial.force, trial.torque / trial.lever), left = result.force.tangential;
  S f = trial.force, t = trial.torque / trial.lever, slipped = S(0);
  const bool slips = left < joint * (S(1) - S(64) * std::numeric_limits<S>::epsilon());
  if (slips || result.stretch < step.stretch) {
    const S across = stuck > S(0) ? trial.force / stuck : S(0);
    const S ratio = across > S(0) ? twist.stiffness / (trial.lever * trial.lever) / across : S(1);
    return_to_disc(left, ratio, f, t);
    slipped = slips ? S(1) - left / joint : S(0);  // a rounding is none
  }
  const S torque = t * trial.lever;
  result.stretch =
      f < trial.force ? (std::min)(stuck, skew.stretch(law, step.depth, f / slip.springs)) : stuck;
  result.force = skew.force(law, step.depth, step.normal_force, result.stretch);
  result.force.tangential *= slip.springs;
  if (slipped > S(0)) {  // k_t shrinks with the region, by no more than keeps tau^2/k_t below what it was
    const S kept = torque / trial.torque;
    if (trial.torque != S(0))
      twist.stiffness = (std::min)(twist.stiffness, (std::max)(trial.present, twist.stiffness * kept * kept));
  }
  trial.angle = twist.stiffness > S(0) ? torque / twist.stiffness : S(0);
  return slipped;
}

}  // namespace detail

}  // namespace palpate
