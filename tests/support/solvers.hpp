// SPDX-License-Identifier: MIT
#pragma once

/// @file  Solvers that several tests use, compiled once: in solvers.cpp.

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/law/friction/power_law.hpp>
#include <palpate/solver/contact_solver.hpp>

namespace palpate {

#ifndef PALPATE_TEST_SOLVER
#define PALPATE_TEST_SOLVER extern template class
#endif
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SinglePoint>;
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, SingleRegion<AreaSharing>>;
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>, Regions<4, AreaSharing>>;
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, SinglePoint>;
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, SingleRegion<AreaSharing>>;
PALPATE_TEST_SOLVER
ContactSolver<Ellipsoid<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>;
PALPATE_TEST_SOLVER
ContactSolver<Box<double>, DuffingForce<double>, PowerLawFriction<double>, Regions<4, AreaSharing>>;
#undef PALPATE_TEST_SOLVER

}  // namespace palpate
