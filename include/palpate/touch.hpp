// SPDX-License-Identifier: MIT
#pragma once

/// @file The short way in: a body, a tool, a friction law; force for the hand, shape for the eye.
///
///     const palpate::ElasticBody body(mesh, {.E = 20e3, .nu = 0.49, .fixed = palpate::below(0.05)});
///     palpate::Touch touch(body, palpate::ball(5e-3), palpate::CoulombFriction<double>({...}));
///     const auto felt = touch.tick(pose, dt);  // servo thread
///     touch.draw(buffer);                      // render thread
///
/// What is chosen for you, and how to ask: docs/touch.md.

#include <palpate/core/fixed_vector.hpp>
#include <palpate/device/triple_buffer.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/none.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/touch/touch_parts.hpp>

#include <span>
#include <utility>

namespace palpate {

/// What the hand feels in a tick, in object coordinates.
struct Felt {
  Wrench<double> wrench;  ///< on the tool: force [N], torque about its centre of mass [N m]
  Status status;
  std::span<const ContactState<double>> contacts;  ///< a whole tool's as one; valid until the next tick
  std::span<const PointContact<double>> points;    ///< force, pressure, stick or slip; none of a point_ball
};

/// A tool on an elastic body: force and shape from the body's response field, contact resolved at the tool's
/// points (docs/resolved.md); a `point_ball` is one point with a law that is fitted to the field.
///
/// | call     | thread        | real time                                                        |
/// |----------|---------------|------------------------------------------------------------------|
/// | `tick()` | servo         | noexcept, no heap, lock or I/O                                   |
/// | `draw()` | any one other | the same; contacts of the newest tick, handed over without locks |
///
/// Coordinates are the object's [m], y up, unless an object pose is given. It stays where it was made, for
/// threads hold on to it. Set-up takes up to some seconds: a `point_ball`'s law is fitted all over the body.
/// Reports what its parts report.
template <class Tool, FrictionLaw Friction = Frictionless<double>>
  requires std::same_as<typename Friction::Scalar, double>
class Touch {
  using Parts = detail::TouchParts<Tool>;
  static constexpr bool is_resolved = ResolvedTopology<typename Parts::Contacts>;

 public:
  using Solver = ContactSolver<typename Parts::Object, typename Parts::Force, Friction,
                               typename Parts::Contacts, typename Parts::Shape>;

  explicit Touch(const ElasticBody& body, const Tool& tool, Friction friction = {})
      : Touch(body, tool, Parts(body, tool), std::move(friction)) {}
  Touch(const Touch&) = delete;
  Touch& operator=(const Touch&) = delete;

  /// One servo tick, dt [s] after the last; `pose`: tool to object coordinates. A pose that is not finite or
  /// no rotation: no force, Status::invalid_pose.
  [[nodiscard]] Felt tick(const Pose<double>& pose, double dt) noexcept {
    const TickResult<double> result = solver_.tick(pose, dt);
    hand_over();
    if constexpr (is_resolved)
      return {result.wrench, result.status, solver_.contacts(), solver_.state().points()};
    else
      return {result.wrench, result.status, solver_.contacts(), {}};
  }
  /// The same where the object moves: both poses to world coordinates, in which the wrenches come, on the
  /// tool and on the object.
  [[nodiscard]] WorldResult<double> tick(const Pose<double>& tool, const Pose<double>& object,
                                         double dt) noexcept {
    const WorldResult<double> result = solver_.tick(tool, object, dt);
    hand_over();
    return result;
  }

  /// What the tool pushes the body with after the last tick, for other tools on it; until the next call.
  [[nodiscard]] std::span<const SurfaceLoad<double>> loads() noexcept
    requires(is_resolved)
  {
    solver_.state().loads(loads_);
    return {loads_.begin(), loads_.size()};
  }
  /// For several tools on one body: loads() of the others, for the next tick, until which they stay where
  /// they are. The body is displaced by them, too, and is drawn under all.
  void set_beside(std::span<const SurfaceLoad<double>> loads) noexcept
    requires(is_resolved)
  {
    beside_ = loads;
    solver_.set_beside(loads);
  }

  /// The deformed body of the newest tick, in object coordinates: a vertex of `buffer` for each vertex of
  /// `body().mesh()`. Returns what was written: nothing where the last call's buffer is up to date.
  template <Real T>
  Moved<double> draw(const VertexBuffer<T>& buffer) noexcept {
    handed_over_.fetch();
    const Drawn& drawn = handed_over_.front();
    const bool is_other = drawn_ != buffer.positions;
    if (is_other) solver_.draw_rest(buffer);
    drawn_ = buffer.positions;
    Moved<double> moved = solver_.draw({drawn.begin(), drawn.size()}, buffer);
    if (is_other && moved.vertices == 0) {
      moved.vertices = body_.mesh().vertices().size();
      moved.lower = body_.mesh().lower();
      moved.upper = body_.mesh().upper();
    }
    return moved;
  }

  /// Forgets all contact, as after a calibration of the device.
  void reset() noexcept {
    solver_.reset();
    hand_over();
  }

  [[nodiscard]] const ElasticBody& body() const noexcept { return body_; }
  /// As it was made; of a MeshTool the spacing that its coarse points have on this body.
  [[nodiscard]] const Tool& tool() const noexcept { return tool_; }
  [[nodiscard]] const Solver& solver() const noexcept { return solver_; }
  /// A `point_ball`'s force law F(D) at x, a position near the surface [m].
  [[nodiscard]] auto law_at(const Vec3<double>& x) const noexcept
    requires(!is_resolved)
  {
    return solver_.force_law().at(x);
  }
  [[nodiscard]] const TouchFit& fit() const noexcept
    requires(!is_resolved)
  {
    return fit_;
  }

 private:
  // What the shape is drawn from: contacts, or loads at points.
  using Drawn = FixedVector<DrawnBy<typename Parts::Shape>, Parts::max_drawn>;

  Touch(const ElasticBody& body, const Tool& tool, Parts&& parts, Friction friction)
      : body_(body),
        tool_(tool),
        fit_(parts.fit),
        solver_({.object = std::move(parts.object),
                 .tool = std::move(parts.tool),
                 .force = std::move(parts.force),
                 .friction = std::move(friction),
                 .contacts = parts.contacts,
                 .deformation = std::move(parts.shape)}) {
    if constexpr (is_resolved) tool_.spacing = parts.spacing;
  }

  void hand_over() noexcept {
    Drawn& drawn = handed_over_.back();
    if constexpr (is_resolved) {
      solver_.state().loads(drawn);
      for (const SurfaceLoad<double>& load : beside_) {
        if (!drawn.full()) drawn.push_back(load);
      }
      beside_ = {};
    } else {
      drawn.clear();
      for (const ContactState<double>& contact : solver_.contacts()) drawn.push_back(contact);
    }
    handed_over_.publish();
  }

  ElasticBody body_;
  Tool tool_;
  PALPATE_NO_UNIQUE_ADDRESS decltype(Parts::fit) fit_;
  Solver solver_;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<is_resolved, Drawn, Absent<1>> loads_;  // of loads()
  using Loads = std::span<const SurfaceLoad<double>>;
  PALPATE_NO_UNIQUE_ADDRESS std::conditional_t<is_resolved, Loads, Absent<2>> beside_;
  TripleBuffer<Drawn> handed_over_;
  const void* drawn_ = nullptr;  // the last draw's buffer
};

}  // namespace palpate
