// SPDX-License-Identifier: MIT
#pragma once

/// @file Solvers that people want, by name.
///
/// | name              | what it is                                               | use it when         |
/// |-------------------|----------------------------------------------------------|---------------------|
/// | `PointSolver<O>`  | one point, Duffing's law, Coulomb friction, no shape     | a stylus            |
/// | `RegionSolver<O>` | the same laws for up to four regions of a tool's points  | forces of a mesh    |
/// | `PaperSolver<O>`  | [luo2005] whole: its friction law and its shape as well  | the paper's results |
///
/// `O` is the object's surface; its scalar is the solver's.

#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/luo_xiao/make_beam_skeleton.hpp>
#include <palpate/solver/contact_solver.hpp>

namespace palpate {

template <ContactSurface O>
using PointSolver = ContactSolver<O, DuffingForce<typename O::Scalar>, CoulombFriction<typename O::Scalar>>;

template <ContactSurface O>
using RegionSolver =
    ContactSolver<O, DuffingForce<typename O::Scalar>, CoulombFriction<typename O::Scalar>, Regions<4>>;

template <ContactSurface O>
using PaperSolver = ContactSolver<
    O, DuffingForce<typename O::Scalar>, PowerLawFriction<typename O::Scalar>, Regions<4>,
    BeamSkeleton<EulerBernoulli<double>, VolumePreserving<double>, PhongInterpolation<typename O::Scalar>>>;

}  // namespace palpate
