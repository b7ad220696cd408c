// SPDX-License-Identifier: MIT
// expect: ForceMap
// expect-gcc: the required expression 'local.configurational_force\(depth\)' is invalid
// expect-clang: no member named 'configurational_force' in 'Spring'
#include <palpate/geometry/sphere.hpp>
#include <palpate/solver/contact_solver.hpp>

struct Spring {
  using Scalar = double;
  double force(double depth) const noexcept { return depth > 0 ? depth : 0; }
  double stiffness(double depth) const noexcept { return depth > 0 ? 1 : 0; }
  double energy(double depth) const noexcept { return depth > 0 ? depth * depth / 2 : 0; }
  double depth(double force) const noexcept { return force; }
  double max_depth() const noexcept { return 1e300; }
#ifndef PALPATE_MUST_FAIL
  palpate::Vec3<double> configurational_force(double) const noexcept { return palpate::Vec3<double>::Zero(); }
#endif
};
struct Map {
  using Scalar = double;
  using Local = Spring;
  Spring at(const palpate::Vec3<double>&) const noexcept { return {}; }
  double max_depth() const noexcept { return 1e300; }
};

using Solver = palpate::ContactSolver<palpate::Sphere<double>, Map>;

int main() { return static_cast<int>(Solver::max_regions) - 1; }
