// SPDX-License-Identifier: MIT
// expect: typename Friction::Scalar
// expect: same_as
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/solver/contact_solver.hpp>

#ifdef PALPATE_MUST_FAIL
using Friction = palpate::CoulombFriction<float>;
#else
using Friction = palpate::CoulombFriction<double>;
#endif

using Solver = palpate::ContactSolver<palpate::Sphere<double>, palpate::LinearForce<double>, Friction>;

int main() { return static_cast<int>(Solver::max_regions) - 1; }
