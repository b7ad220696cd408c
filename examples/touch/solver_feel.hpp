// SPDX-License-Identifier: MIT
#pragma once

/// @file The example's solver over any object, as the device calls it.

#include <palpate/detection/swept_pose.hpp>
#include <palpate/geometry/sampled_surface.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <optional>

#include "felt.hpp"

namespace touch {

template <class Object>
using Solver = palpate::ContactSolver<Object, palpate::DuffingMap<S>, palpate::PowerLawFriction<S>,
                                      palpate::Regions<max_regions>, Shape>;

template <class Object>
[[nodiscard]] Solver<Object> make_solver(Object object, const Tool& tool, Answer answer) {
  using namespace palpate;
  return Solver<Object>({
      .object = std::move(object),
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

[[nodiscard]] inline palpate::SampledSurface<Body> samples(const Body& body) {
  return {body, {.spacing = 0.01 * (body.upper() - body.lower()).norm()}};
}

/// The solver, and before it the sweep.
template <class Object>
class SolverFeel : public Feel {
 public:
  SolverFeel(const Options& options, Solver<Object> solver) : solver_(std::move(solver)) {
    if (options.sweep > 0) sweep_.emplace(options.sweep);
  }

  Felt tick(const palpate::Pose<S>& X, S dt) noexcept override {
    palpate::ReachedPose<S> at{X, palpate::Status::ok};
    if (sweep_) at = sweep_->advance(solver_.tool(), solver_.object(), X);
    const palpate::TickResult<S> result = solver_.tick(at.pose, dt);
    Felt felt;
    felt.wrench = result.wrench;
    felt.pose = at.pose;
    felt.status = result.status | at.status;
    for (const palpate::ContactState<S>& contact : solver_.contacts()) {
      ++felt.regions;
      felt.sliding = felt.sliding || contact.mode == palpate::ContactMode::sliding;
      felt.friction += contact.friction;
      felt.normal += contact.force - contact.friction;
      felt.contacts.push_back(contact);
    }
    return felt;
  }
  void reset() noexcept override {
    solver_.reset();
    if (sweep_) sweep_->reset();
  }
  palpate::Moved<S> draw(Shape::Contacts contacts, const Shape::Buffer& out) noexcept override {
    return solver_.draw(contacts, out);
  }
  void draw_rest(const Shape::Buffer& out) noexcept override { solver_.draw_rest(out); }
  [[nodiscard]] std::size_t tool_points() const noexcept override { return solver_.tool().size(); }

 protected:
  Solver<Object> solver_;
  std::optional<palpate::SweptPose<S>> sweep_;  ///< holds the tool back; empty: never
};

}  // namespace touch
