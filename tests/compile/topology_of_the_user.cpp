// SPDX-License-Identifier: MIT
// expect: Topology
// expect: is_shipped_topology
#include <palpate/geometry/sphere.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

#ifdef PALPATE_MUST_FAIL
struct Contacts : palpate::Regions<2> {};
#else
using Contacts = palpate::Regions<2>;
#endif

using Solver = palpate::ContactSolver<palpate::Sphere<double>, palpate::LinearForce<double>,
                                      palpate::Frictionless<double>, Contacts>;

int main() { return static_cast<int>(Solver::max_regions) - 2; }
