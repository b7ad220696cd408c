// SPDX-License-Identifier: MIT
// expect: HasPenetration
// expect: body.penetration\(x\)
// expect-gcc: is not 'noexcept'
// expect-clang: may throw an exception
#include <palpate/geometry/concept.hpp>

using palpate::Penetration, palpate::SurfacePoint, palpate::Vec3;

#ifdef PALPATE_MUST_FAIL
#define MAYBE_NOEXCEPT
#else
#define MAYBE_NOEXCEPT noexcept
#endif

/// The half-space z < 0.
struct Plane {
  using Scalar = double;
  SurfacePoint<double> closest(const Vec3<double>& x) const noexcept {
    return {Vec3<double>(x.x(), x.y(), 0), Vec3<double>::UnitZ(), x.z()};
  }
  Penetration<double> penetration(const Vec3<double>& x) const MAYBE_NOEXCEPT {
    return {-x.z(), Vec3<double>::UnitZ()};
  }
  bool separated(const Vec3<double>& x, double r) const noexcept { return x.z() > r; }
  double reach() const noexcept { return 1e300; }
};

template <palpate::ContactSurface Surface>
struct Solver {
  Surface surface;
};

int main() { return Solver<Plane>{}.surface.separated(Vec3<double>::Zero(), 1); }
