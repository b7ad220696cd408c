// SPDX-License-Identifier: MIT
#pragma once

/// @file What the servo thread does in a tick and what it hands over: the solver, and the sums over its
/// regions.

#include <palpate/detection/swept_pose.hpp>
#include <palpate/device/energy_limit.hpp>
#include <palpate/luo_xiao/beam/region_skeletons.hpp>
#include <palpate/palpate.hpp>

#include <optional>

#include "tools.hpp"

namespace touch {

inline constexpr std::size_t most_regions = 4;

/// What the example keeps of a tick: plain values, so that another thread may have them.
struct Felt {
  palpate::Wrench<S> wrench;
  palpate::Pose<S> pose;  ///< where the tool was felt: the device's pose, or where it was held back
  palpate::Status status = palpate::Status::ok;
  std::uint32_t regions = 0;
  bool sliding = false;
  V normal = V::Zero();                                                   ///< normal part of the force [N]
  V friction = V::Zero();                                                 ///< friction part [N]
  palpate::FixedVector<palpate::ContactState<S>, most_regions> contacts;  ///< what the shape is made of
};

/// The object stays the undeformed one.
struct FollowNothing {
  template <class Solver>
  void operator()(const Felt&, Solver&) const noexcept {}
};

/// What the device calls, whatever the object is: one virtual call a tick.
class Feel {
 public:
  Feel() = default;
  Feel(const Feel&) = delete;
  Feel& operator=(const Feel&) = delete;
  virtual ~Feel() = default;
  virtual Felt tick(const palpate::Pose<S>& X, S dt) noexcept = 0;
  virtual void reset() noexcept = 0;
  [[nodiscard]] virtual std::size_t tool_points() const noexcept = 0;
};

/// A solver and what stands around it.
template <class Solver, class Follow = FollowNothing>
struct SolverFeel final : Feel {
  Solver solver;
  std::optional<palpate::SweptPose<S>> sweep;    ///< holds the tool back; empty: never
  std::optional<palpate::EnergyLimit<S>> limit;  ///< for an object whose force is not passive by itself
  Follow follow;                                 ///< what the object does after a tick, for the next one

  SolverFeel(Solver at, std::optional<palpate::SweptPose<S>> swept,
             std::optional<palpate::EnergyLimit<S>> limited = {}, Follow then = {})
      : solver(std::move(at)), sweep(std::move(swept)), limit(std::move(limited)), follow(std::move(then)) {}

  Felt tick(const palpate::Pose<S>& X, S dt) noexcept override {
    palpate::ReachedPose<S> at{X, palpate::Status::ok};
    if (sweep) at = sweep->advance(solver.tool(), solver.object(), X);
    const palpate::TickResult<S> result = solver.tick(at.pose, dt);
    Felt felt;
    felt.wrench = limit ? limit->pass(result.wrench, X, solver.contacts()) : result.wrench;
    felt.pose = at.pose;
    felt.status = result.status | at.status;
    for (const palpate::ContactState<S>& contact : solver.contacts()) {
      ++felt.regions;
      felt.sliding = felt.sliding || contact.mode == palpate::ContactMode::sliding;
      felt.friction += contact.friction;
      felt.normal += contact.force - contact.friction;
      felt.contacts.push_back(contact);
    }
    follow(felt, solver);
    return felt;
  }
  void reset() noexcept override {
    solver.reset();
    if (sweep) sweep->reset();
    if (limit) limit->reset();
  }
  [[nodiscard]] std::size_t tool_points() const noexcept override { return solver.tool().size(); }
};

/// The example's solver over any body.
template <class Body, class Coupling = palpate::IndependentRegions, class Force = palpate::DuffingForce<S>>
using Contact =
    palpate::ContactSolver<Body, Force, palpate::PowerLawFriction<S>, palpate::Regions<most_regions>,
                           palpate::NoDeformation<S>, palpate::AtContact, Coupling>;

/// The paper's parameters (section VII): lengths in mm, m = 1 kg, and K = 10 read in dyn.
inline const palpate::DuffingForce<S> paper_force({.c1 = 40, .c3 = 3e8});

template <class Body, class Force, class Coupling = palpate::IndependentRegions>
[[nodiscard]] Contact<Body, Coupling, Force> make_contact(const Body& body, const Tool& tool,
                                                          const Force& force, const Coupling& coupling = {}) {
  using namespace palpate;
  return Contact<Body, Coupling, Force>({
      .object = body,
      .tool = ToolPoints<S>(TriangleMesh<S>(tool.mesh),
                            {.contact_area = tool.contact_area, .centre_of_mass = tool.centre_of_mass},
                            tool.spacing),
      .force = force,
      .friction = PowerLawFriction<S>(
          {.K = PowerLawFriction<S>::si_coefficient(10, 0.75, 1e-5), .beta = 0.75, .mu_dynamic = 0.3}),
      .contacts = {.distance = 2.5 * tool.spacing},
      .coupling = coupling,
  });
}

}  // namespace touch
