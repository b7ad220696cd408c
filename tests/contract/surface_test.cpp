// SPDX-License-Identifier: MIT
// The surface suite on every exact surface, float and double.

#include "contract/surface.hpp"

#include <palpate/geometry/box.hpp>
#include <palpate/geometry/cylinder.hpp>
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/geometry/sphere.hpp>
#include <palpate/geometry/superellipsoid.hpp>

using namespace palpate;
using test::Long3;

namespace {

template <Real S, class Make>
void run(Make make, std::function<long double(const Long3&)> gauge, const Vec3<S>& centre,
         double area_ratio) {
  using Body = std::invoke_result_t<Make, S>;
  const auto made = [make](S scale) { return std::make_unique<const test::Surface<Body>>(make(scale)); };
  test::SurfaceSuite<S>(made, std::move(gauge), centre, area_ratio).run();
}

template <Real S>
const Vec3<S> off_origin(S(0.01), S(-0.02), S(0.005));

}  // namespace

TEST_CASE_TEMPLATE("sphere keeps the surface contract", S, float, double) {
  for (const Vec3<S>& m : {Vec3<S>(Vec3<S>::Zero()), off_origin<S>}) {
    run<S>([m](S k) { return Sphere<S>({.radius = k * S(0.03), .centre = k * m}); },
           [](const Long3& x) { return x.norm() / static_cast<long double>(S(0.03)); }, m, 2);
  }
}

TEST_CASE_TEMPLATE("ellipsoid keeps the surface contract", S, float, double) {
  for (const Vec3<S>& m : {Vec3<S>(Vec3<S>::Zero()), off_origin<S>}) {
    for (const Vec3<S>& a : {Vec3<S>(S(0.03), S(0.02), S(0.02)), Vec3<S>(S(0.02), S(0.03), S(0.025)),
                             Vec3<S>(S(0.01), S(0.03), S(0.03)), Vec3<S>(S(0.02), S(0.02), S(0.02))}) {
      run<S>([=](S k) { return Ellipsoid<S>({.axes = k * a, .centre = k * m}); },
             [=](const Long3& x) { return x.cwiseQuotient(a.template cast<long double>()).norm(); }, m,
             2 * static_cast<double>(a.maxCoeff() / a.minCoeff()));
    }
  }
}

TEST_CASE_TEMPLATE("box keeps the surface contract", S, float, double) {
  for (const Vec3<S>& m : {Vec3<S>(Vec3<S>::Zero()), off_origin<S>}) {
    for (const Vec3<S>& h : {Vec3<S>(S(0.03), S(0.02), S(0.01)), Vec3<S>(S(0.02), S(0.02), S(0.02))}) {
      run<S>([=](S k) { return Box<S>({.half = k * h, .centre = k * m}); },
             [=](const Long3& x) {
               return x.cwiseAbs().cwiseQuotient(h.template cast<long double>()).maxCoeff();
             },
             m, 4);
    }
  }
}

TEST_CASE_TEMPLATE("cylinder keeps the surface contract", S, float, double) {
  for (const Vec3<S>& m : {Vec3<S>(Vec3<S>::Zero()), off_origin<S>}) {
    for (const S h : {S(0.01), S(0.02), S(0.05)}) {
      run<S>([=](S k) { return Cylinder<S>({.radius = k * S(0.02), .half_height = k * h, .centre = k * m}); },
             [=](const Long3& x) {
               return std::max(std::hypot(x.x(), x.z()) / static_cast<long double>(S(0.02)),
                               std::fabs(x.y()) / static_cast<long double>(h));
             },
             m, 4);
    }
  }
}

TEST_CASE_TEMPLATE("superellipsoid keeps the surface contract", S, float, double) {
  struct Shape {
    Vec3<S> axes;
    S e1, e2;
  };
  for (const Shape& s : {Shape{{S(0.03), S(0.02), S(0.025)}, S(0.5), S(0.5)},
                         Shape{{S(0.03), S(0.02), S(0.01)}, S(1), S(0.25)},
                         Shape{{S(0.02), S(0.02), S(0.02)}, S(0.1), S(1)}}) {
    const Vec3<S> m = off_origin<S>;
    run<S>(
        [=](S k) { return Superellipsoid<S>({.axes = k * s.axes, .e1 = s.e1, .e2 = s.e2, .centre = k * m}); },
        [=](const Long3& x) {
          const Long3 z = x.cwiseAbs().cwiseQuotient(s.axes.template cast<long double>());
          const long double p = 2 / static_cast<long double>(s.e2), q = 2 / static_cast<long double>(s.e1);
          const long double flat = std::pow(std::pow(z.x(), p) + std::pow(z.y(), p), 1 / p);
          return std::pow(std::pow(flat, q) + std::pow(z.z(), q), 1 / q);
        },
        m, 5 * static_cast<double>(s.axes.maxCoeff() / s.axes.minCoeff()));
  }
}
