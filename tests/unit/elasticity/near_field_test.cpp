// SPDX-License-Identifier: MIT
#include <palpate/elasticity/kelvin.hpp>
#include <palpate/elasticity/near_field.hpp>
#include <palpate/response/tick/held_compliance.hpp>
#include <palpate/response/tick/sphere_contact.hpp>

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
      CHECK_ABSOLUTE((vector(disc.flat(f.z(), t.dot(p), nu), t) - flat).norm() / flat.norm(), 0.0, 1e-5);
      const V hertz = disc_mean([&](const V& x, double c) {
        return V(3 * c * c * point_load<double>(r - x, m, V(0, 0, f.z()), nu));
      });
      CHECK_ABSOLUTE((vector(disc.hertz(f.z(), nu), t) - hertz).norm() / hertz.norm(), 0.0, 1e-4);
      const V pair =
          disc_mean([&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, x, nu)); });
      CHECK_ABSOLUTE((vector(disc.double_force(nu), t) - pair).norm() / pair.norm(), 0.0, 1e-4);
      Mat3<double> s = Mat3<double>::Zero();  // symmetric, without trace
      s.topLeftCorner<2, 2>() << f.x(), f.y(), f.y(), -f.x();
      const V shear =
          disc_mean([&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, V(s * x), nu)); });
      CHECK_ABSOLUTE((vector(disc.shear(p.dot(s * p), nu), V(s * p)) - shear).norm() / shear.norm(), 0.0,
                     1e-4);
      const V tilt = disc_mean(
          [&](const V& x, double) { return V(3 * x.dot(t) * point_load<double>(r - x, m, m, nu)); });
      CHECK_ABSOLUTE((vector(disc.tilt(t.dot(p), nu), t) - tilt).norm() / tilt.norm(), 0.0, 1e-4);
      const V twist = disc_mean(
          [&](const V& x, double) { return V(1.5 * point_load<double>(r - x, m, m.cross(x), nu)); });
      CHECK_ABSOLUTE((disc.twist() * m.cross(p) - twist).norm() / twist.norm(), 0.0, 1e-4);
    }
  }
}

TEST_CASE("flat disc: uniform displacement under it, Mindlin's and Boussinesq's compliance") {
  for (double nu : {0.0, 0.3, 0.5}) {
    for (double s : {0.0, 0.4, 0.9}) {
      const double a = 0.02;
      const V along = disc_load(V(s * a, 0, 0), V::UnitZ(), 0, a, V::UnitX(), nu),
              down = disc_load(V(s * a, 0, 0), V::UnitZ(), 0, a, V::UnitZ(), nu);
      CHECK_RELATIVE(along.x() / (4 * pi), (2 - nu) / (8 * a), 1e-12);
      CHECK_RELATIVE(down.z() / (4 * pi), (1 - nu) / (4 * a), 1e-12);
    }
  }
}

TEST_CASE("point load: traction is the stress of the displacement, and none on the free plane") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (double nu : {0.0, 0.3, 0.45}) {
    const V r(unit(random), unit(random), 0.4 + std::abs(unit(random))),
        n = V(unit(random), unit(random), unit(random)).normalized(), m = V::UnitZ();
    const double h = 1e-5;
    Mat3<double> expected;
    for (int k = 0; k < 3; ++k) {
      Mat3<double> G;
      for (int j = 0; j < 3; ++j)
        G.col(j) = (point_load<double>(r + h * V::Unit(j), m, V::Unit(k), nu) -
                    point_load<double>(r - h * V::Unit(j), m, V::Unit(k), nu)) /
                   (8 * pi * h);
      expected.col(k) = (G + G.transpose()) * n + 2 * nu / (1 - 2 * nu) * G.trace() * n;
    }
    // Central differences with h = 1e-5: 1e-9.
    CHECK_ABSOLUTE((point_load_traction(r, m, n, nu) - expected).norm() / expected.norm(), 0.0, 1e-7);
    const Mat3<double> free = point_load_traction(V(r.x(), r.y(), 0), m, -m, nu);
    CHECK_ABSOLUTE(free.norm(), 0.0, 1e-12);
  }
}

TEST_CASE("lanes agree with real numbers") {
  using detail::Lane;
  for (int first = 0; first < 8; first += int(detail::lane_size)) {
    Lane p2, z;
    for (int i = 0; i < int(detail::lane_size); ++i) {
      const int k = first + i;
      p2[i] = 0.3f * float(k * k), z[i] = 0.1f * float(k % 3);
    }
    const Disc<Lane, float> lanes(p2, z, 1.f);
    const auto u = lanes.flat(0.7f, detail::four(0.2f), 0.3f);
    const float most = -detail::least_of(-p2);
    const Lane angle = detail::arc_sine(p2 / most);
    for (int i = 0; i < int(detail::lane_size); ++i) {
      const auto one = Disc<double>(double(p2[i]), double(z[i]), 1.0).flat(0.7, 0.2, 0.3);
      // float and a polynomial arctangent of 1e-5
      CHECK_ABSOLUTE(u.normal[i], one.normal, 3e-4);
      CHECK_ABSOLUTE(u.along[i], one.along, 3e-4);
      CHECK_ABSOLUTE(angle[i], std::asin(double(p2[i] / most)), 1e-4);  // the polynomial's 7e-5
    }
  }
}

TEST_CASE("fading: its series and its roots agree with the power to the last digit") {
  for (double size2 = 1e-4; size2 < 100; size2 *= 1.01) {
    const long double exact = std::pow(1 + std::pow(static_cast<long double>(size2 / 3), 4), -0.125L);
    CHECK_ABSOLUTE(detail::fading(size2, 3), double(exact), test::ulps<double>(2));
  }
}

TEST_CASE("sphere: Hertz for shallow contact, series compliance softens, stiffness is the slope") {
  const double R = 0.015, modulus = 2e6, d = 1e-6;
  // Hertz is the limit; the exact sphere differs by O(d/R) = 7e-5.
  CHECK_RELATIVE(sphere_force(d, R, modulus, 0.0).force, 4.0 / 3 * modulus * std::sqrt(R) * std::pow(d, 1.5),
                 1e-4);
  const auto f = sphere_force(4e-3, R, modulus, 5e-6), up = sphere_force(4e-3 + 1e-7, R, modulus, 5e-6),
             down = sphere_force(4e-3 - 1e-7, R, modulus, 5e-6);
  CHECK(f.force < sphere_force(4e-3, R, modulus, 0.0).force);
  CHECK_RELATIVE(f.stiffness, (up.force - down.force) / 2e-7, 1e-6);  // central difference
  // What a stiff layer takes from the depth; held at half of it, where the force is that of twice the depth.
  // Newton's last step is up to 4 epsilon of the radius, of which the force is a power of 3 or a little more.
  const double own = sphere_force(4e-3, R, modulus, 0.0).force,
               stiff = sphere_force(4e-3, R, modulus, -5e-6).force;
  CHECK_RELATIVE(sphere_force(4e-3 + 5e-6 * stiff, R, modulus, 0.0).force, stiff, test::ulps<double>(64));
  CHECK(stiff > own);
  CHECK_RELATIVE(sphere_force(4e-3, R, modulus, -1.0).force, sphere_force(8e-3, R, modulus, 0.0).force,
                 test::ulps<double>(64));
  // Without the gap's fourth power (a paraboloid, to s^4) the same depth is a larger force, with softening a
  // smaller one.
  CHECK(sphere_force(4e-3, R, modulus, 0.0, 1.0).force > own);
  CHECK(sphere_force(4e-3, R, modulus, 0.0, 0.0, 0.05).force < own);
  for (const double softening : {0.05, -0.1}) {
    const auto at = [&](double depth) { return sphere_force(depth, R, modulus, 5e-6, 0.5, softening); };
    CHECK_RELATIVE(at(4e-3).stiffness, (at(4e-3 + 1e-7).force - at(4e-3 - 1e-7).force) / 2e-7, 1e-6);
    for (double depth = 1e-5; depth < 0.1; depth *= 1.1) CHECK(at(1.1 * depth).force >= at(depth).force);
  }
  CHECK(sphere_force(-1.0, R, modulus, 0.0).force == 0);
  CHECK(sphere_force(std::numeric_limits<double>::quiet_NaN(), R, modulus, 0.0).force == 0);
}
