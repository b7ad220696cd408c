// SPDX-License-Identifier: MIT
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/elasticity/flat_punch.hpp>
#include <palpate/elasticity/point_load.hpp>

#include "support/check.hpp"

#include <random>

namespace {
using namespace palpate;
using V = Vec3<double>;
constexpr double pi = std::numbers::pi;

// Mean of `field` over a disc of radius 1 with the flat punch's weight: uniform in sqrt(1 - s^2).
template <class Field>
V disc_mean(const Field& field) {
  constexpr int n = 120;
  V sum = V::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double c = (i + 0.5) / n, s = std::sqrt(1 - c * c), angle = 2 * pi * (j + 0.5) / n;
      sum += field(V(s * std::cos(angle), s * std::sin(angle), 0), c);
    }
  return sum / (n * n);
}
}  // namespace

TEST_CASE("disc loads equal the integral of point loads, nu = 0, 0.3, 1/2") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const V m = V::UnitZ();
  for (double nu : {0.0, 0.3, 0.5}) {
    for (int k = 0; k < 4; ++k) {
      const V r(1.5 * unit(random), 1.5 * unit(random), 0.5 + std::abs(unit(random))),
          f(unit(random), unit(random), unit(random));
      const double z = r.z();
      const V p(r.x(), r.y(), 0), t(f.x(), f.y(), 0);
      const Disc<double> disc(p.squaredNorm(), z, 1.0);
      const auto vector = [&](const auto& u, const V& along) {
        return V(u.in_plane * p + u.normal * m + u.along * along);
      };
      // Midpoint rule of 120 x 120: error about 1e-5; of weights that vanish or change sign more, below 1e-4.
      const V flat = disc_mean([&](const V& x, double) { return point_load<double>(r - x, m, f, nu); });
      CHECK_ABSOLUTE((vector(disc.flat_punch(f.z(), t.dot(p), nu), t) - flat).norm() / flat.norm(), 0.0,
                     1e-5);
      const V hertz = disc_mean([&](const V& x, double c) {
        return V(3 * c * c * point_load<double>(r - x, m, V(0, 0, f.z()), nu));
      });
      CHECK_ABSOLUTE((vector(disc.hertz(f.z(), nu), t) - hertz).norm() / hertz.norm(), 0.0, 1e-4);
      const V pair =
          disc_mean([&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, x, nu)); });
      CHECK_ABSOLUTE((vector(disc.force_dipole(nu), t) - pair).norm() / pair.norm(), 0.0, 1e-4);
      Mat3<double> s = Mat3<double>::Zero();  // symmetric, without trace
      s.topLeftCorner<2, 2>() << f.x(), f.y(), f.y(), -f.x();
      const V shear =
          disc_mean([&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, V(s * x), nu)); });
      CHECK_ABSOLUTE((vector(disc.shear_dipole(p.dot(s * p), nu), V(s * p)) - shear).norm() / shear.norm(),
                     0.0, 1e-4);
      const V tilt = disc_mean(
          [&](const V& x, double) { return V(3 * x.dot(t) * point_load<double>(r - x, m, m, nu)); });
      CHECK_ABSOLUTE((vector(disc.bending_couple(t.dot(p), nu), t) - tilt).norm() / tilt.norm(), 0.0, 1e-4);
      const V twist = disc_mean(
          [&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, m.cross(x), nu)); });
      CHECK_ABSOLUTE((disc.torsional_couple() * m.cross(p) - twist).norm() / twist.norm(), 0.0, 1e-4);
    }
  }
}

TEST_CASE("flat punch: uniform displacement under it, Mindlin's and Boussinesq's compliance") {
  for (double nu : {0.0, 0.3, 0.5}) {
    for (double s : {0.0, 0.4, 0.9}) {
      const double a = 0.02;
      const V along = flat_punch_load(V(s * a, 0, 0), V::UnitZ(), 0, a, V::UnitX(), nu),
              down = flat_punch_load(V(s * a, 0, 0), V::UnitZ(), 0, a, V::UnitZ(), nu);
      CHECK_RELATIVE(along.x() / (4 * pi), (2 - nu) / (8 * a), 1e-12);
      CHECK_RELATIVE(down.z() / (4 * pi), (1 - nu) / (4 * a), 1e-12);
    }
  }
}

TEST_CASE("a Simd agrees with real numbers") {
  using detail::Simd4;
  for (int first = 0; first < 8; first += 4) {
    Simd4 p2, z;
    for (int i = 0; i < 4; ++i) {
      const int k = first + i;
      p2.set(std::size_t(i), 0.3f * float(k * k)), z.set(std::size_t(i), 0.1f * float(k % 3));
    }
    const Disc<Simd4, float> four(p2, z, 1.f);
    const auto u = four.flat_punch(0.7f, detail::Simd4(0.2f), 0.3f);
    const float most = detail::reduce_max(p2);
    const Simd4 angle = detail::arc_sine(p2 / most);
    for (int i = 0; i < 4; ++i) {
      const auto one =
          Disc<double>(double(p2[std::size_t(i)]), double(z[std::size_t(i)]), 1.0).flat_punch(0.7, 0.2, 0.3);
      // float and a polynomial arctangent of 1e-5
      CHECK_ABSOLUTE(u.normal[std::size_t(i)], one.normal, 3e-4);
      CHECK_ABSOLUTE(u.along[std::size_t(i)], one.along, 3e-4);
      CHECK_ABSOLUTE(angle[std::size_t(i)], std::asin(double(p2[std::size_t(i)] / most)),
                     1e-4);  // the polynomial's 7e-5
    }
  }
}
