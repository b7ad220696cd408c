// SPDX-License-Identifier: MIT
#pragma once

/// @file A point on a body that bends away: the collector (gather.hpp) of laws that know its displacement.

#include <palpate/contact/topology.hpp>
#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/law/map/concept.hpp>
#include <palpate/solver/detail/gather.hpp>

namespace palpate::detail {

/// The body beneath the point is displaced by w = - C F m, m the exit direction, so the surface is asked at
///
///     x - w,   D = depth(x - w) - m.w,   F = law(D)
///
/// with w of the last tick's size. On a plane no force depends on w; a thin part that bends away by more than
/// its half is not met from its far side. Where w is along m the force is the gradient of a potential: the
/// contact's energy at x - w, and w^2/(2 C). So a map is asked at x: it would have a part in w at x - w.
template <Real S>
class BentState : public OneRegion<S> {
 public:
  void reset() noexcept { OneRegion<S>::reset(), forget(); }
  void forget() noexcept { w_ = Vec3<S>::Zero(), has_settled_ = true; }
  /// Whether another tick at the same pose would ask the surface at the same point.
  [[nodiscard]] bool has_settled() const noexcept { return has_settled_; }
  /// x on the undeformed body.
  [[nodiscard]] Vec3<S> undeformed(const Vec3<S>& x) const noexcept { return x - w_; }
  [[nodiscard]] bool is_displaced() const noexcept { return !w_.isZero(S(0)); }
  void take_back(S share) noexcept { w_ *= share; }
  /// Depth D [m] of a point that is `in` at undeformed(x).
  [[nodiscard]] S depth(const Penetration<S>& in) const noexcept {
    return in.depth - unit_or<S>(in.gradient, in.gradient).dot(w_);
  }
  /// Turns w to the exit direction found; false where it has been along it.
  [[nodiscard]] bool turn(const Vec3<S>& exit) noexcept {
    displace(exit, w_.norm());
    return !has_settled_;
  }
  /// w of this tick, of the size `displacement` [m] along the exit direction.
  void displace(const Vec3<S>& exit, S displacement) noexcept {
    const Vec3<S> w = -displacement * unit_or<S>(exit, exit);
    has_settled_ = (w - w_).squaredNorm() <= settled * settled * w.squaredNorm();
    w_ = w;
  }

 private:
  static constexpr S settled = S(1e-6L);  // of w: less than 1e-6 of the work is lost

  Vec3<S> w_ = Vec3<S>::Zero();  // object coordinates [m]
  bool has_settled_ = true;
};

template <Real S, class Coupling>
class PointOnBody : public Collector<SinglePoint, S, Coupling> {
  using Base = Collector<SinglePoint, S, Coupling>;

 public:
  using Base::Base;
  using State = BentState<S>;
  [[nodiscard]] State initial_state() const noexcept { return {}; }

  template <ContactSurface Object, ForceModel Force, class Sums>
  Status collect(const Object& object, const PointTool<S>& tool, const Force& force, const Pose<S>& X,
                 State& state, Sums& sums) const noexcept {
    const Vec3<S> x = X * tool.tip;
    Penetration<S> in = look(object, x, state);
    for (int turns = 0; turns < most_turns && in.depth > S(0) && state.turn(in.gradient); ++turns)
      in = look(object, x, state);
    const S inside = in.depth;
    if (inside > S(0)) in.depth = state.depth(in);
    const bool touching = in.depth > S(0);
    state.update(touching);
    if (!touching) {
      state.forget();
      return Status::ok;
    }
    const auto& law = law_at(force, x);
    const S f = law.force(in.depth);
    state.displace(in.gradient, law.body_displacement(f));
    return depth_status(object, force, inside) |
           Base::template add<Force>(object, tool, law, X, x, in, f, state, sums);
  }

 private:
  static constexpr int most_turns = 3;
  static constexpr int most_tries = 8;

  /// Where the tool came back in a tick by more than it was deep, w is taken back by eighths: at once from 0
  /// a thin part would be met from its far side.
  template <ContactSurface Object>
  [[nodiscard]] static Penetration<S> look(const Object& object, const Vec3<S>& x, State& state) noexcept {
    Penetration<S> in = object.penetration(state.undeformed(x));
    for (int left = most_tries - 1; left >= 0 && !(in.depth > S(0)) && state.is_displaced(); --left) {
      state.take_back(S(left) / S(left + 1));
      in = object.penetration(state.undeformed(x));
    }
    return in;
  }
};

}  // namespace palpate::detail
