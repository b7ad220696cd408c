// SPDX-License-Identifier: MIT
// expect: typename Friction::Scalar
// expect: same_as
#include <palpate/friction/coulomb.hpp>
#include <palpate/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>
#include <palpate/surface/sphere.hpp>

#ifdef PALPATE_MUST_FAIL
using Friction = palpate::CoulombFriction<float>;
#else
using Friction = palpate::CoulombFriction<double>;
#endif

using Solver = palpate::ContactSolver<palpate::Sphere<double>, palpate::LinearForce<double>, Friction>;

int main() { return static_cast<int>(Solver::max_regions) - 1; }
