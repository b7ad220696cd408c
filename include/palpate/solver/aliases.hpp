// SPDX-License-Identifier: MIT
#pragma once

/// @file Solvers that people want, by name.
///
/// | name              | what it is                                                   | use it when               |
/// |-------------------|--------------------------------------------------------------|---------------------------|
/// | `PointSolver<O>`  | one point, Duffing's law, Coulomb friction, no shape         | a stylus; the least time  |
/// | `RegionSolver<O>` | up to four regions of a tool's points, the same laws         | forces of a tool mesh     |
/// | `PaperSolver<O>`  | [luo2005] whole: the same with its friction law and shape    | the paper's force and look |
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
