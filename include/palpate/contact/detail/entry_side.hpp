// SPDX-License-Identifier: MIT
#pragma once

/// @file  Thin parts: a region that was pushed past the middle is not pushed out on the other side.

#include <palpate/core/pose.hpp>
#include <palpate/core/status.hpp>

#include <algorithm>

namespace palpate::detail {

/// What a region remembers of the side on which it came in.
///
/// Past the middle of a thin part the closest face is the far one, and the exit of every point turns round at
/// once. It is seen at the deepest point: its exit turns by more than 135 degrees while it moves along it by
/// less than it is deep before and after together, and so does the tool. Across, the deepest point may move
/// as far as it likes: those of a blunt tool are equally deep to rounding, and the one past the middle first
/// is the last to be the deepest. None of it happens round an edge of more than 45 degrees at any depth, nor
/// where a tool grips a part from both sides (its jaws are further apart than they are deep, until the part
/// is half as thick), nor where a tool is put elsewhere. Then `Status::beyond_reach` is reported, and
///
/// - as long as the force does not drop by half in a tick nor turn round, nothing else happens: a mallet
///   whose corner is through is carried by the rest of its face;
/// - then the wrench of the tick before stands, and fades out over a quarter of that depth of travel: it
///   cannot give back more than the way in has stored. From there on the region has no force until the tool
///   has left the object.
///
/// Above a depth at which no tool is past the middle nothing is remembered: most contacts pay for nothing.
/// Who comes from there to beyond the middle in one tick came from the other side, as below.
///
/// A tool whose first tick of contact is beyond the middle came from the other side, as far as can be known:
/// SweptPose is for that.
template <Real S>
class EntrySide {
 public:
  /// Forgets: the region is new.
  void begin() noexcept {
    past_middle_ = seen_ = lost_ = false;
    depth_ = S(0);
  }

  /// Looks at this tick's sum, and changes it where the region is lost. Above the depth `shallow` [m] there
  /// is nothing to remember.
  template <class Sum>
  Status update(const Pose<S>& X, S shallow, Sum& sum) noexcept {
    if (!seen_ && sum.deepest < shallow) {
      depth_ = S(0);
      return Status::ok;
    }
    if (lost_) [[unlikely]]
      return fade(X, sum);
    const S along = exit_.dot(sum.exit);
    if (depth_ > S(0) && (along < S(0) || seen_)) [[unlikely]] {
      if (turned(along, exit_, sum.exit) && is_opposite(X, sum.position, depth_ + sum.deepest))
        past_middle_ = seen_ = true;
      else if (along >= S(0))
        past_middle_ = false;  // it came back
      const S carried = force_.dot(sum.force);
      if ((past_middle_ && carried < S(0.5) * force_.squaredNorm()) ||
          (seen_ && turned(carried, force_, sum.force))) {
        lost_ = true;
        share_ = S(1);
        point_ = X.to_tool(position_);
        return fade(X, sum);
      }
    }
    if (!past_middle_) {
      exit_ = sum.exit;
      position_ = sum.position;
      point_ = X.to_tool(position_);
      depth_ = sum.deepest;
    }
    force_ = sum.force;
    torque_ = sum.torque;
    return past_middle_ ? Status::beyond_reach : Status::ok;
  }

 private:
  /// By more than 135 degrees, whose cosine is - sqrt(1/2); `product`: the dot product of the two.
  [[nodiscard]] static bool turned(S product, const Vec3<S>& from, const Vec3<S>& to) noexcept {
    return product < S(0) && product * product > S(0.5) * from.squaredNorm() * to.squaredNorm();
  }

  /// Whether the deepest point, now at `position`, has moved along its exit, and the tool at all, by less
  /// than both depths `both` [m].
  [[nodiscard]] bool is_opposite(const Pose<S>& X, const Vec3<S>& position, S both) const noexcept {
    const S along = exit_.dot(position - position_), square = both * both;
    return along * along < square * exit_.squaredNorm() && (X * point_ - position_).squaredNorm() < square;
  }

  template <class Sum>
  Status fade(const Pose<S>& X, Sum& sum) noexcept {
    const Vec3<S> now = X * point_;
    share_ = (std::max)(S(0), share_ - (now - position_).norm() / (depth_ / S(4)));
    position_ = now;
    sum.hold(share_ * force_, share_ * torque_, exit_);
    return Status::beyond_reach;
  }

  Vec3<S> exit_, position_;  // of the deepest point, on the side of entry; position: object coordinates [m]
  Vec3<S> force_, torque_;   // of the last tick [N], [N m]
  Vec3<S> point_;            // the same in tool coordinates; its travel fades the wrench [m]
  S depth_ = S(0);           // of the deepest point [m]
  S share_ = S(0);
  bool past_middle_ = false;  // now
  bool seen_ = false;         // past the middle at some tick of this contact
  bool lost_ = false;
};

}  // namespace palpate::detail
