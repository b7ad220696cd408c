// SPDX-License-Identifier: MIT
#pragma once

/// @file  Fast tools and thin parts: the pose that the tool reaches without passing through the object.

#include <palpate/core/error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/detection/candidates.hpp>

#include <utility>

namespace palpate {

/// What SweptPose gives a tick: the pose to use, and Status::held_back where it is not the device's.
template <Real S>
struct ReachedPose {
  Pose<S> pose;
  Status status;
};

/// Follows the device's pose, but lets no point of the tool go deeper than `depth` in between. Absent unless
/// you use it, and then one line before the tick:
///
///     const auto swept = sweep.advance(solver.tool(), solver.object(), X);
///     auto result = solver.tick(swept.pose);          // result.status |= swept.status
///
/// | symbol | name    | unit | range                                                                |
/// |--------|---------|------|----------------------------------------------------------------------|
/// | L      | `depth` | m    | > 0, below 0.4 of the thickness of the thinnest part to be protected |
///
/// The tool's centre goes along a line and it turns at an even rate. Conservative advancement [mirtich1996]:
/// depth changes by no more than the path length of a point, so a tool whose deepest point is at delta may go
/// on by L - delta without a query. Nearer to L it tries steps of L / 4 and takes those that end no deeper
/// than L, so no point gets deeper than 1.25 L. Whatever crosses a part of half thickness 1.25 L would be
/// that deep in between, and is stopped.
///
/// Why the pose is held back instead of answered with a larger force: past the middle of a thin part the
/// closest face is the far one, so depth and force point on through it. Held back where it came in, depth is
/// measured from the face that the tool entered, and the force stays at most at the law's value for L.
///
/// L is one for the whole object, so a tool is also held back where it goes deeper into a thick part: for
/// thin objects, or with L as deep as you allow anyway. While it is held back the tool does not slide along
/// the face. It moves again when the straight line to the device's pose does not lead deeper. One that grazes
/// the surface over more than about 30 L in one tick runs out of queries, stops there for this tick and goes
/// on in the next.
///
/// advance() is noexcept, without heap; at most 33 queries, each at most a closest point for each node and
/// point of the tool. In free air it costs one separation test; after a query, nothing until the tool has
/// moved by L - delta. A device pose that is not usable is handed on to the solver, which refuses it, and the
/// next usable one is taken as it is; so is the first.
template <Real S>
class SweptPose {
 public:
  explicit SweptPose(S depth) : depth_(depth) {
    require_positive(depth, "SweptPose", "depth [m] must be > 0");
  }

  template <ContactSurface B>
    requires std::same_as<S, typename B::Scalar>
  [[nodiscard]] ReachedPose<S> advance(const ToolPoints<S>& tool, const B& surface,
                                       const Pose<S>& X) noexcept {
    const auto& ball = tool.nodes()[0];
    return advance(ball.centre, ball.radius, surface, X,
                   [&](const Pose<S>& at) { return deepest(tool, at, surface); });
  }
  template <ContactSurface B>
    requires std::same_as<S, typename B::Scalar>
  [[nodiscard]] ReachedPose<S> advance(const PointTool<S>& tool, const B& surface,
                                       const Pose<S>& X) noexcept {
    return advance(tool.tip, S(0), surface, X,
                   [&](const Pose<S>& at) { return -surface.closest(at * tool.tip).distance; });
  }

  /// The next pose is taken as it is.
  void reset() noexcept { known_ = false; }

 private:
  static constexpr int max_queries = 32;

  /// From `from` to `to`, a ball's centre along a line.
  struct Motion {
    Pose<S> from, to;
    Vec3<S> centre_T, begin,
        path;  // the ball's centre: tool coordinates, at the start, and from there to the end
    Eigen::AngleAxis<S> turn;

    Motion(const Pose<S>& a, const Pose<S>& b, const Vec3<S>& c)
        : from(a),
          to(b),
          centre_T(c),
          begin(a * c),
          path(b * c - a * c),
          turn(Mat3<S>(b.rotation * a.rotation.transpose())) {}
    [[nodiscard]] Pose<S> at(S s) const noexcept {
      const Mat3<S> R = Eigen::AngleAxis<S>(s * turn.angle(), turn.axis()).toRotationMatrix() * from.rotation;
      return {R, begin + s * path - R * centre_T};
    }
    /// Upper bound of every point's path length, also where the device's matrix is a rotation to 1e-3 only.
    [[nodiscard]] S length(S radius) const noexcept {
      return path.norm() + (std::abs(turn.angle()) + (at(S(1)).rotation - to.rotation).norm()) * radius;
    }
  };

  template <class B, class Deepest>
  [[nodiscard]] ReachedPose<S> advance(const Vec3<S>& centre, S radius, const B& surface, const Pose<S>& X,
                                       const Deepest& deepest) noexcept {
    if (!is_usable(X)) {
      known_ = false;
      return {X, Status::ok};
    }
    if (!known_) {
      known_ = true;
      return arrive(X, S(0));
    }
    const Motion motion(reached_, X, centre);
    const S length = motion.length(radius);
    if (length < clear_) return arrive(X, clear_ - length);
    S s = S(0), deep = deepest(reached_);
    for (int query = 0; query < max_queries; ++query) {
      const S left = (S(1) - s) * length, free = depth_ - deep;
      if (left < free) return arrive(X, free - left);
      if (surface.separated(motion.begin + s * motion.path, radius + left)) return arrive(X, depth_);
      // Near L the path may still lead out or along: try a short piece of it.
      const S step = (std::max)(free, depth_ / S(4));
      const bool last = step >= left;
      const S next = s + step / length, at = deepest(last ? X : motion.at(next));
      if (at > S(1.001L) * depth_) break;  // more than rounding
      if (last) return arrive(X, depth_ - at);
      s = next;
      deep = at;
    }
    if (s > S(0)) reached_ = motion.at(s);
    clear_ = S(0);
    return {reached_, Status::held_back};
  }

  [[nodiscard]] ReachedPose<S> arrive(const Pose<S>& X, S clear) noexcept {
    reached_ = X;
    clear_ = clear;
    return {X, Status::ok};
  }

  /// Largest depth of a point of the tool at X; < 0: its distance.
  template <class B>
  [[nodiscard]] static S deepest(const ToolPoints<S>& tool, const Pose<S>& X, const B& surface) noexcept {
    const auto nodes = tool.nodes();
    const S stretch = detail::max_stretch(X.rotation);
    S deepest = -(std::numeric_limits<S>::max)();
    for (std::uint32_t n = 0; n < nodes.size();) {
      const auto& node = nodes[n];
      if (stretch * node.radius - surface.closest(X * node.centre).distance <= deepest) {
        n = node.skip;
        continue;
      }
      if (node.skip == n + 1) {
        for (std::uint32_t i = node.begin; i < node.end; ++i)
          deepest = (std::max)(deepest, -surface.closest(X * tool.point(i)).distance);
      }
      ++n;
    }
    return deepest;
  }

  S depth_;
  Pose<S> reached_{};
  S clear_ = S(0);  // no point is deeper than L before the tool has moved by this [m]
  bool known_ = false;
};

}  // namespace palpate
