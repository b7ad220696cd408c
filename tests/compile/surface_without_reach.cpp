// SPDX-License-Identifier: MIT
// expect: HasReach
// expect: body.reach\(\)
// expect-gcc: the required expression 'body.reach\(\)' is invalid
// expect-clang: no member named 'reach' in 'Plane'
#include <palpate/geometry/concept.hpp>

using palpate::Penetration, palpate::SurfacePoint, palpate::Vec3;

/// The half-space z < 0.
struct Plane {
  using Scalar = double;
  SurfacePoint<double> closest(const Vec3<double>& x) const noexcept {
    return {Vec3<double>(x.x(), x.y(), 0), Vec3<double>::UnitZ(), x.z()};
  }
  Penetration<double> penetration(const Vec3<double>& x) const noexcept {
    return {-x.z(), Vec3<double>::UnitZ()};
  }
  bool separated(const Vec3<double>& x, double r) const noexcept { return x.z() > r; }
#ifndef PALPATE_MUST_FAIL
  double reach() const noexcept { return 1e300; }
#endif
};

template <palpate::ContactSurface Surface>
struct Solver {
  Surface surface;
};

int main() { return Solver<Plane>{}.surface.separated(Vec3<double>::Zero(), 1); }
