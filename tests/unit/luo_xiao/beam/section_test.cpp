// SPDX-License-Identifier: MIT

// Exact flexure stresses: against the printed closed forms, and as a solution of three-dimensional
// elasticity.

#include <palpate/luo_xiao/beam/rectangular_section.hpp>
#include <palpate/luo_xiao/beam/section.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <array>
#include <cmath>
#include <numbers>

using namespace palpate;

namespace {

using L = long double;
constexpr L pi = std::numbers::pi_v<L>;
constexpr std::array<double, 4> poisson{0.0, 0.25, 0.3, 0.5};

// Gauss-Legendre, 20 points on [-1, 1]: exact for the ellipse's polynomials, 1e-14 for the rectangle's
// fields.
struct Gauss {
  std::array<L, 20> x, w;
  Gauss() {
    for (int i = 0; i < 20; ++i) {
      L t = std::cos(pi * (i + 0.75L) / 20.5L), p = 0, q = 0, slope = 0;
      for (int step = 0; step < 30; ++step) {
        p = 1, q = 0;
        for (int n = 1; n <= 20; ++n) {
          const L r = q;
          q = p;
          p = ((2 * n - 1) * t * q - (n - 1) * r) / n;
        }
        slope = 20 * (t * p - q) / (t * t - 1);
        t -= p / slope;
      }
      x[static_cast<std::size_t>(i)] = t;
      w[static_cast<std::size_t>(i)] = 2 / ((1 - t * t) * slope * slope);
    }
  }
};

struct Resultant {
  L yx = 0, zx = 0, energy = 0, torque = 0;  // of tau_yx, tau_zx, tau^2, y tau_zx - z tau_yx
  template <class C>
  void add(const C& section, double nu, L y, L z, L weight) {
    const auto t =
        section.flexure_shear(typename C::Scalar(nu), typename C::Scalar(y), typename C::Scalar(z));
    yx += weight * t.yx, zx += weight * t.zx;
    energy += weight * (static_cast<L>(t.yx) * t.yx + static_cast<L>(t.zx) * t.zx);
    torque += weight * (y * t.zx - z * t.yx);
  }
};

template <class C>
Resultant over_ellipse(const C& section, double nu, L a, L b) {
  const Gauss g;
  Resultant sum;
  for (int k = 0; k < 24; ++k) {  // 24 angles: exact for trigonometric polynomials of these degrees
    for (std::size_t i = 0; i < 20; ++i) {
      const L r = (1 + g.x[i]) / 2, angle = 2 * pi * (k + 0.25L) / 24;
      sum.add(section, nu, a * r * std::cos(angle), b * r * std::sin(angle),
              g.w[i] / 2 * r * a * b * 2 * pi / 24);
    }
  }
  return sum;
}

// Halves and quarters towards the edge z = b, y = a, where the field is steepest.
template <class C>
Resultant over_rectangle(const C& section, double nu, L a, L b) {
  const Gauss g;
  Resultant sum;
  const std::array<L, 7> cut{0, 0.5L, 0.75L, 0.875L, 0.9375L, 0.98L, 1};
  for (std::size_t p = 0; p + 1 < cut.size(); ++p) {
    for (std::size_t q = 0; q + 1 < cut.size(); ++q) {
      const L hy = (cut[p + 1] - cut[p]) / 2, hz = (cut[q + 1] - cut[q]) / 2;
      for (std::size_t i = 0; i < 20; ++i) {
        for (std::size_t j = 0; j < 20; ++j) {
          const L y = a * (cut[p] + hy * (1 + g.x[i])), z = b * (cut[q] + hz * (1 + g.x[j]));
          const L weight = g.w[i] * g.w[j] * hy * hz * a * b;
          for (const int sy : {-1, 1}) {
            for (const int sz : {-1, 1}) sum.add(section, nu, sy * y, sz * z, weight);
          }
        }
      }
    }
  }
  return sum;
}

// Equilibrium and Beltrami-Michell by fourth-order differences at (y, z), h small against the section.
template <class C>
void check_elasticity(const C& section, double nu, L y, L z, L h) {
  const auto f = [&](L u, L v) { return section.flexure_shear(static_cast<L>(nu), u, v); };
  const auto first = [&](auto g) { return (8 * (g(h) - g(-h)) - (g(2 * h) - g(-2 * h))) / (12 * h); };
  const auto second = [&](auto g) {
    return (16 * (g(h) + g(-h)) - (g(2 * h) + g(-2 * h)) - 30 * g(0.0L)) / (12 * h * h);
  };
  const L I = section.second_moment_z();
  const L divergence =
      first([&](L s) { return f(y + s, z).yx; }) + first([&](L s) { return f(y, z + s).zx; });
  const L size = std::sqrt(section.area());
  // Truncation h^4 at h = 0.004 of the size and 1e-17/h^2 rounding both stay below this.
  CHECK_ABSOLUTE(divergence * I / size, -y / size, 1e-7);
  const L yx = second([&](L s) { return f(y + s, z).yx; }) + second([&](L s) { return f(y, z + s).yx; });
  const L zx = second([&](L s) { return f(y + s, z).zx; }) + second([&](L s) { return f(y, z + s).zx; });
  CHECK_ABSOLUTE(yx * I, -1 / (1 + static_cast<L>(nu)), 1e-6);
  CHECK_ABSOLUTE(zx * I, 0, 1e-6);
}

}  // namespace

TEST_CASE_TEMPLATE("circle: area, moments and stresses are the closed form", S, float, double) {
  const CircularSection<S> circle({.radius = S(0.004)});
  const L r = circle.radius(), I = pi * r * r * r * r / 4;
  CHECK_RELATIVE(circle.area(), pi * r * r, test::ulps<S>(4));
  CHECK_RELATIVE(circle.second_moment_y(), I, test::ulps<S>(8));
  CHECK_RELATIVE(circle.second_moment_z(), I, test::ulps<S>(8));
  for (const double n : poisson) {
    const S nu = S(n);
    for (const double v : {-0.8, 0.0, 0.3}) {
      for (const double w : {-0.5, 0.0, 0.55}) {
        const S y = S(v) * circle.radius(), z = S(w) * circle.radius();
        const auto t = circle.flexure_shear(nu, y, z);
        const L ny = y, nz = z, m = nu, scale = 1 / (pi * r * r);
        // Rounding of a dozen operations, of the mean shear.
        CHECK_ABSOLUTE(
            t.yx, (3 + 2 * m) / (8 * (1 + m) * I) * (r * r - ny * ny - (1 - 2 * m) / (3 + 2 * m) * nz * nz),
            scale * test::ulps<S>(16));
        CHECK_ABSOLUTE(t.zx, -(1 + 2 * m) * ny * nz / (4 * (1 + m) * I), scale * test::ulps<S>(16));
      }
    }
  }
  // Peak at nu = 1/2: 4F/(3S).
  CHECK_RELATIVE(circle.flexure_shear(S(0.5), S(0), S(0)).yx, 4 / (3 * pi * r * r), test::ulps<S>(8));
}

TEST_CASE("stresses are those of the bending function: circle, ellipse, rectangle") {
  const L a = 0.003L, b = 0.005L, y = 0.0011L, z = -0.0021L;
  const EllipticSection<double> ellipse({.semi_y = 0.003, .semi_z = 0.005});
  const RectangularSection<double> rectangle({.half_y = 0.003, .half_z = 0.005});
  for (const double n : poisson) {
    const L nu = n, A = a * a * (2 * (1 + nu) * a * a + b * b) / (3 * a * a + b * b);
    const L B = ((1 + nu) * a * a + nu * b * b) / (3 * (3 * a * a + b * b));
    const auto tau = [&](L phi_y, L phi_z, L I) {
      return std::array<L, 2>{(phi_y + nu * z * z - (1 + nu) * y * y) / (2 * (1 + nu) * I),
                              phi_z / (2 * (1 + nu) * I)};
    };
    const auto exact_e = tau(A + 3 * B * (y * y - z * z), -6 * B * y * z, pi * a * a * a * b / 4);
    const auto e = ellipse.flexure_shear(n, 0.0011, -0.0021);
    CHECK_RELATIVE(e.yx, exact_e[0], 1e-13);  // rounding, with the bracket's cancellation
    CHECK_RELATIVE(e.zx, exact_e[1], 1e-13);

    L phi_y = (1 + nu) * a * a - nu * b * b / 3, phi_z = 0;
    for (int k = 1; k <= 60; ++k) {  // y = a/3: terms fall by exp(-k pi (a-y)/b), 1e-34 at the end
      const L q = k * pi / b,
              s = (k % 2 ? -1.0L : 1.0L) / k / k * 4 * nu * b * b / (pi * pi) / std::cosh(q * a);
      phi_y -= s * std::cosh(q * y) * std::cos(q * z);
      phi_z += s * std::sinh(q * y) * std::sin(q * z);
    }
    const auto exact_r = tau(phi_y, phi_z, 4 * a * a * a * b / 3);
    const auto r = rectangle.flexure_shear(n, 0.0011, -0.0021);
    CHECK_RELATIVE(r.yx, exact_r[0], 1e-12);
    CHECK_ABSOLUTE(r.zx, exact_r[1], 1e-12 * static_cast<double>(exact_r[0]));
  }
}

TEST_CASE("sides are free of traction, the resultant is F, and there is no torque") {
  for (const double nu : poisson) {
    for (const double b : {0.001, 0.004, 0.016}) {
      const double a = 0.004;
      const EllipticSection<double> ellipse({.semi_y = a, .semi_z = b});
      for (int k = 0; k < 32; ++k) {
        const double c = std::cos(k * 0.2), s = std::sin(k * 0.2);
        const auto t = ellipse.flexure_shear(nu, a * c, b * s);
        CHECK_ABSOLUTE((t.yx * b * c + t.zx * a * s) / std::hypot(b * c, a * s) * ellipse.area(), 0,
                       1e-14);  // rounding
      }
      const Resultant e = over_ellipse(ellipse, nu, a, b);
      CHECK_RELATIVE(e.yx, 1, 1e-14);
      CHECK_ABSOLUTE(e.zx, 0, 1e-14);
      CHECK_ABSOLUTE(e.torque, 0, 1e-16);
      CHECK_RELATIVE(1 / ellipse.shear_coefficient(nu), e.energy * ellipse.area(), 1e-14);

      const RectangularSection<double> box({.half_y = a, .half_z = b});
      for (int k = -16; k <= 16; ++k) {
        const double mean = 1 / box.area();
        CHECK_ABSOLUTE(box.flexure_shear(nu, a, b * k / 16).yx, 0, mean * 1e-13);
        CHECK_ABSOLUTE(box.flexure_shear(nu, -a, b * k / 16).yx, 0, mean * 1e-13);
        CHECK_ABSOLUTE(box.flexure_shear(nu, a * k / 16, b).zx, 0, mean * 1e-13);
      }
      const Resultant r = over_rectangle(box, nu, a, b);
      CHECK_RELATIVE(r.yx, 1, 1e-12);  // series' own 1e-16, and the quadrature near the corner
      CHECK_ABSOLUTE(r.zx, 0, 1e-12);
      CHECK_ABSOLUTE(r.torque, 0, 1e-14);
      CHECK_RELATIVE(1 / box.shear_coefficient(nu), r.energy * box.area(),
                     1e-6);  // corner's logarithm limits the quadrature
    }
  }
}

TEST_CASE("stresses are in equilibrium and compatible in three dimensions") {
  for (const double nu : poisson) {
    const EllipticSection<L> ellipse({.semi_y = 1.0L, .semi_z = 1.5L});
    const RectangularSection<L> box({.half_y = 1.0L, .half_z = 1.5L});
    for (const L y : {-0.6L, 0.1L, 0.5L}) {
      for (const L z : {-0.7L, 0.2L, 0.6L}) {
        check_elasticity(ellipse, nu, y, z, 0.01L);
        check_elasticity(box, nu, y, z, 0.01L);
      }
    }
  }
}

TEST_CASE("rectangle: ratio of tau_yx to 3F/(2S) at the centre and at the edge z = b") {
  // Timoshenko and Goodier's table for nu = 1/4, and the same series in 30 digits for nu = 1/2, rounded to 3
  // decimals.
  struct Row {
    double nu, a_over_b, centre, edge;
  };
  constexpr Row table[] = {{0.25, 2, 0.983, 1.033},    {0.25, 1, 0.940, 1.126},  {0.25, 0.5, 0.856, 1.396},
                           {0.25, 0.25, 0.805, 1.988}, {0.5, 2, 0.972, 1.055},   {0.5, 1, 0.900, 1.210},
                           {0.5, 0.5, 0.760, 1.661},   {0.5, 0.25, 0.675, 2.647}};
  for (const Row& row : table) {
    const double b = 0.01, a = row.a_over_b * b;
    const RectangularSection<double> box({.half_y = a, .half_z = b});
    const double mean = 1.5 / box.area();
    CHECK_ABSOLUTE(box.flexure_shear(row.nu, 0, 0).yx / mean, row.centre,
                   0.0006);  // half a digit of the table
    CHECK_ABSOLUTE(box.flexure_shear(row.nu, 0, b).yx / mean, row.edge, 0.0006);
  }
  const RectangularSection<double> box({.half_y = 0.01, .half_z = 0.02});
  CHECK_RELATIVE(box.flexure_shear(0, 0.005, 0.013).yx, 1.5 / box.area() * 0.75,
                 1e-14);  // nu = 0: the parabola
  CHECK_RELATIVE(box.shear_coefficient(0), 5.0 / 6.0, 1e-14);
}

TEST_CASE_TEMPLATE("beam stress: bending and axial parts, with the sign of equilibrium", S, float, double) {
  const CircularSection<S> circle({.radius = S(0.01)});
  const Voigt<S> s = beam_stress(circle, S(0.3), BeamLoad<S>{S(-5), S(2)}, S(0.25), S(0.004), S(0.003));
  const L r = circle.radius(), I = pi * r * r * r * r / 4;
  CHECK_RELATIVE(s[0], -2 * 0.25L * static_cast<L>(S(0.004)) / I - 5 / (pi * r * r), test::ulps<S>(16));
  CHECK(s[1] == 0);
  CHECK(s[2] == 0);
  CHECK(s[3] == 0);
  const auto shear = circle.flexure_shear(S(0.3), S(0.004), S(0.003));
  CHECK(s[4] == S(2) * shear.zx);
  CHECK(s[5] == S(2) * shear.yx);
}

TEST_CASE("sections report a dimension that is not positive") {
  CHECK_THROWS_AS(CircularSection<double>({.radius = 0}), SetupError);
  CHECK_THROWS_AS(EllipticSection<double>({.semi_y = 1, .semi_z = -1}), SetupError);
  CHECK_THROWS_AS(RectangularSection<double>({.half_y = std::nan(""), .half_z = 1}), SetupError);
}
