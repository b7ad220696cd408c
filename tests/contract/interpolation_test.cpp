// SPDX-License-Identifier: MIT
#include "contract/interpolation.hpp"

#include <palpate/luo_xiao/interpolation/blocks.hpp>
#include <palpate/luo_xiao/interpolation/linear.hpp>
#include <palpate/luo_xiao/interpolation/phong.hpp>
#include <palpate/luo_xiao/interpolation/smooth.hpp>

#include <doctest/doctest.h>

using namespace palpate;
using palpate::test::check_interpolation;
using palpate::test::InterpolationBody;
using palpate::test::ulps;

namespace {

/// What a user would write: w^2 / sum w^2 in place of w.
template <Real S>
struct Quadratic {
  using Scalar = S;
  Vec3<S> displacement(std::span<const S> weights, std::span<const FaceCorner<S>> corners,
                       const Vec3<S>&) const noexcept {
    Vec3<S> u = Vec3<S>::Zero();
    S sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      u += weights[k] * weights[k] * corners[k].displacement;
      sum += weights[k] * weights[k];
    }
    return u / sum;
  }
};
template <class S>
class QuadraticBlocks : public InterpolationBlocks<Quadratic<S>> {
 public:
  explicit QuadraticBlocks(FacePartition<S> partition)
      : InterpolationBlocks<Quadratic<S>>(std::move(partition), {}) {}
};

template <template <class> class I, class S>
void check_on_all_bodies(long double tolerance) {
  const auto check = [&](const InterpolationBody<S>& body) {
    check_interpolation(
        body, [](const FacePartition<S>& partition) { return I<S>(partition); }, tolerance);
  };
  SUBCASE("sphere") { check(Sphere<S>({.radius = S(0.03)})); }
  SUBCASE("ellipsoid") { check(Ellipsoid<S>({.axes = {S(0.03), S(0.02), S(0.025)}})); }
  SUBCASE("box") { check(Box<S>(typename Box<S>::Params{})); }
  SUBCASE("cylinder") { check(Cylinder<S>(typename Cylinder<S>::Params{})); }
  SUBCASE("superellipsoid") { check(Superellipsoid<S>(typename Superellipsoid<S>::Params{})); }
}

}  // namespace

// Weights are sums of at most nine products; 40 ulp of the largest displacement.
TEST_CASE_TEMPLATE("interpolation contract: linear", S, float, double) {
  check_on_all_bodies<LinearInterpolation, S>(ulps<S>(40));
}
// A direction from an angle and back again: sine, cosine and a root on top of that.
TEST_CASE_TEMPLATE("interpolation contract: Phong", S, float, double) {
  check_on_all_bodies<PhongInterpolation, S>(ulps<S>(100));
}
// Weights squared have twice the rounding errors.
TEST_CASE_TEMPLATE("interpolation contract: a user's of one vertex", S, float, double) {
  check_on_all_bodies<QuadraticBlocks, S>(ulps<S>(80));
}
// Coefficients of the spline cancel: they are up to 20 times the displacements, and there are up to 18 of
// them.
TEST_CASE_TEMPLATE("interpolation contract: smooth", S, float, double) {
  check_on_all_bodies<SmoothInterpolation, S>(ulps<S>(2000));
}
