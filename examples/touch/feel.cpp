// SPDX-License-Identifier: MIT

/// @file The example's solver: any object through its samples, on its shape at rest or on that of the last
/// tick.

#include <palpate/detection/swept_pose.hpp>
#include <palpate/geometry/deformed_surface.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/largest_stiffness.hpp>
#include <palpate/solver/make_solver.hpp>

#include <optional>

#include "felt.hpp"

namespace touch {

using namespace palpate;

namespace {

using Object = DeformedSurface<SampledSurface<Body>>;
using Solver = ContactSolver<Object, DuffingMap<S>, PowerLawFriction<S>, Regions<max_regions>, Shape>;

Solver make_solver(const Body& body, const Tool& tool, Answer answer) {
  const S spacing = 0.01 * (body.upper() - body.lower()).norm();  // a hundredth of the body's size
  return Solver({
      .object = Object({body, {.spacing = spacing}}, TriangleMesh<S>(body.display)),
      .tool = ToolPoints<S>(TriangleMesh<S>(tool.mesh),
                            {.contact_area = tool.contact_area, .centre_of_mass = tool.centre_of_mass},
                            tool.spacing),
      .force = std::move(answer.force),
      // The paper's K = 10 and beta = 0.75, read in dyn.
      .friction = PowerLawFriction<S>(
          {.K = PowerLawFriction<S>::si_coefficient(10, 0.75, 1e-5), .beta = 0.75, .mu_dynamic = 0.3}),
      .contacts = {.distance = 2.5 * tool.spacing},
      .deformation = std::move(answer.shape),
  });
}

/// With --detect deformed the object takes the shape of each tick for the next one. The force is not passive
/// by itself then: the device's passivity controller stands behind it.
class SolverFeel final : public Feel {
 public:
  SolverFeel(const Options& options, const Body& body, const Tool& tool, Answer answer) {
    if (options.sweep > 0) sweep_.emplace(options.sweep);
    if (options.deformed) {
      if (!answer.shape.exists()) refuse("--detect deformed needs a shape");
      followed_.emplace(answer.shape);
      position_ = body.display.vertices;
      followed_->write_rest(positions());
    }
    solver_.emplace(make_solver(body, tool, std::move(answer)));
  }

  Felt tick(const Pose<S>& X, S dt) noexcept override {
    ReachedPose<S> at{X, Status::ok};
    if (sweep_) at = sweep_->advance(solver_->tool(), solver_->object(), X);
    const TickResult<S> result = solver_->tick(at.pose, dt);
    Felt felt;
    felt.wrench = result.wrench;
    felt.pose = at.pose;
    felt.status = result.status | at.status;
    for (const ContactState<S>& contact : solver_->contacts()) {
      ++felt.regions;
      felt.sliding = felt.sliding || contact.mode == ContactMode::sliding;
      felt.friction += contact.friction;
      felt.normal += contact.force - contact.friction;
      felt.contacts.push_back(contact);
    }
    if (followed_ && followed_->write(solver_->contacts(), positions()).vertices > 0) {
      Object& object = solver_->mutable_object();
      object.update(position_);
      highest_ = (std::max)(highest_, object.highest_bulge());
    }
    return felt;
  }
  void reset() noexcept override {
    solver_->reset();
    if (sweep_) sweep_->reset();
  }
  Moved<S> draw(Shape::Contacts contacts, const Shape::Buffer& out) noexcept override {
    return solver_->draw(contacts, out);
  }
  void draw_rest(const Shape::Buffer& out) noexcept override { solver_->draw_rest(out); }
  [[nodiscard]] std::size_t tool_points() const noexcept override { return solver_->tool().size(); }
  [[nodiscard]] S highest_bulge() const noexcept override { return highest_; }
  [[nodiscard]] S stiffness_below(const V& from, S travel, S force) const override {
    Pose<S> X;
    X.translation = from;
    return largest_stiffness(*solver_,
                             {.from = X, .along = -V::UnitY(), .travel = travel, .max_force = force})
        .translation;
  }

 private:
  [[nodiscard]] Shape::Buffer positions() noexcept {
    return {.positions = position_.front().data(), .position_stride = sizeof(V)};
  }

  std::optional<Solver> solver_;
  std::optional<SweptPose<S>> sweep_;  ///< holds the tool back; empty: never
  std::optional<Shape> followed_;      ///< of the servo thread; the solver's own is the one that is drawn
  std::vector<V> position_;
  S highest_ = 0;
};

}  // namespace

std::unique_ptr<Feel> make_feel(const Options& options, const Body& body, const Tool& tool, Answer answer) {
  return std::make_unique<SolverFeel>(options, body, tool, std::move(answer));
}

}  // namespace touch
