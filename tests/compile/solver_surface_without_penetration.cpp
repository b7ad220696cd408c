// SPDX-License-Identifier: MIT
// expect: HasPenetration
// expect-gcc: the required expression 'body.penetration\(x\)' is invalid
// expect-clang: no member named 'penetration' in 'Plane'
#include <palpate/law/force/linear.hpp>
#include <palpate/solver/contact_solver.hpp>

using palpate::Penetration, palpate::SurfacePoint, palpate::Vec3;

/// The half-space z < 0.
struct Plane {
  using Scalar = double;
  SurfacePoint<double> closest(const Vec3<double>& x) const noexcept {
    return {Vec3<double>(x.x(), x.y(), 0), Vec3<double>::UnitZ(), x.z()};
  }
#ifndef PALPATE_MUST_FAIL
  Penetration<double> penetration(const Vec3<double>& x) const noexcept {
    return {-x.z(), Vec3<double>::UnitZ()};
  }
#endif
  bool separated(const Vec3<double>& x, double r) const noexcept { return x.z() > r; }
  double reach() const noexcept { return 1e300; }
};

using Solver = palpate::ContactSolver<Plane, palpate::LinearForce<double>>;

int main() { return static_cast<int>(Solver::max_regions) - 1; }
