// SPDX-License-Identifier: MIT
// expect: HasDepth
// expect-gcc: the required expression 'law.depth\(force\)' is invalid
// expect-clang: no member named 'depth' in 'Spring'
#include <palpate/geometry/sphere.hpp>
#include <palpate/solver/contact_solver.hpp>

struct Spring {
  using Scalar = double;
  double force(double depth) const noexcept { return depth > 0 ? depth : 0; }
  double stiffness(double depth) const noexcept { return depth > 0 ? 1 : 0; }
  double energy(double depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
#ifndef PALPATE_MUST_FAIL
  double depth(double force) const noexcept { return force; }
#endif
  double max_depth() const noexcept { return 1e300; }
};

using Solver = palpate::ContactSolver<palpate::Sphere<double>, Spring>;

int main() { return static_cast<int>(Solver::max_regions) - 1; }
