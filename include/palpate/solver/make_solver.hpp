// SPDX-License-Identifier: MIT
#pragma once

/// @file A contact solver from its parts.

#include <palpate/solver/contact_solver.hpp>

#include <utility>

namespace palpate {

/// A solver from its parts in the order of their roles; types are deduced. A `PointTool` has one contact; of
/// `ToolPoints` all are one region where no topology is given.
template <ContactSurface Object, class Tool, ForceModel Force,
          FrictionLaw Friction = Frictionless<typename Object::Scalar>,
          Topology Contacts = detail::TopologyOf<Tool>,
          DeformationModel Deformation = NoDeformation<typename Object::Scalar>>
[[nodiscard]] ContactSolver<Object, Force, Friction, Contacts, Deformation> make_solver(
    Object object, Tool tool, Force force, Friction friction = {}, Contacts contacts = {},
    Deformation deformation = {}) {
  return ContactSolver<Object, Force, Friction, Contacts, Deformation>(
      {.object = std::move(object),
       .tool = std::move(tool),
       .force = std::move(force),
       .friction = std::move(friction),
       .contacts = std::move(contacts),
       .deformation = std::move(deformation)});
}

}  // namespace palpate
