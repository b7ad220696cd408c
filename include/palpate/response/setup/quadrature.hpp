// SPDX-License-Identifier: MIT
#pragma once

/// @file Quadrature on triangles: Radon's rule of degree 5, a rule of degree 2, and Duffy's map towards a
/// point, which takes 1/R out of an integrand. Set-up only. Sources: [radon1948], [duffy1982],
/// [johnston2005].

#include <palpate/core/vector.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace palpate {

/// A point of a triangle by barycentric weights, and its share of the triangle's area; shares sum to 1.
struct TrianglePoint {
  Vec3<double> weight;
  double share;
};

/// Degree 5, 7 points.
[[nodiscard]] inline std::array<TrianglePoint, 7> radon_rule() noexcept {
  const double s = std::sqrt(15.0), a = (6 - s) / 21, b = (6 + s) / 21;
  const double wa = (155 - s) / 1200, wb = (155 + s) / 1200;
  return {{{{1.0 / 3, 1.0 / 3, 1.0 / 3}, 9.0 / 40},
           {{1 - 2 * a, a, a}, wa},
           {{a, 1 - 2 * a, a}, wa},
           {{a, a, 1 - 2 * a}, wa},
           {{1 - 2 * b, b, b}, wb},
           {{b, 1 - 2 * b, b}, wb},
           {{b, b, 1 - 2 * b}, wb}}};
}
/// Degree 2, 3 points.
[[nodiscard]] inline std::array<TrianglePoint, 3> three_point_rule() noexcept {
  return {{{{2.0 / 3, 1.0 / 6, 1.0 / 6}, 1.0 / 3},
           {{1.0 / 6, 2.0 / 3, 1.0 / 6}, 1.0 / 3},
           {{1.0 / 6, 1.0 / 6, 2.0 / 3}, 1.0 / 3}}};
}

/// Gauss-Legendre on [0, 1].
template <std::size_t N>
struct Gauss {
  std::array<double, N> x, w;
};
template <std::size_t N>
[[nodiscard]] inline Gauss<N> gauss_rule() noexcept {
  Gauss<N> rule{};
  for (std::size_t i = 0; i < N; ++i) {
    double x = std::cos(std::numbers::pi * (double(i) + 0.75) / (double(N) + 0.5)), slope = 1;
    for (int newton = 0; newton < 50; ++newton) {  // Legendre's recursion
      double p0 = 1, p1 = x;
      for (std::size_t k = 2; k <= N; ++k) {
        const double p2 = ((2 * double(k) - 1) * x * p1 - (double(k) - 1) * p0) / double(k);
        p0 = p1;
        p1 = p2;
      }
      slope = double(N) * (x * p1 - p0) / (x * x - 1);
      const double step = p1 / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.x[N - 1 - i] = 0.5 * (1 + x);
    rule.w[N - 1 - i] = 1 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

/// N x N points crowded towards the corner `apex` of the triangle with corners at the barycentric positions
/// `corner`. For an integrand that is singular at a distance from the apex, beside the triangle: `distance`,
/// over the triangle's size, more than 0. Then it is smooth in s, u = distance sinh(s asinh(1 / distance)).
template <std::size_t N>
[[nodiscard]] inline std::array<TrianglePoint, N * N> duffy_rule(const Vec3<double>& apex,
                                                                 const Vec3<double>& b, const Vec3<double>& c,
                                                                 double share, double distance = 0) noexcept {
  const Gauss<N> g = gauss_rule<N>();
  Gauss<N> along = g;
  if (distance > 0) {
    const double whole = std::asinh(1 / distance);
    for (std::size_t i = 0; i < N; ++i) {
      along.x[i] = distance * std::sinh(whole * g.x[i]);
      along.w[i] = g.w[i] * distance * whole * std::cosh(whole * g.x[i]);
    }
  }
  std::array<TrianglePoint, N * N> points;
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j) {
      const double u = along.x[i], v = g.x[j];
      points[i * N + j] = {(1 - u) * apex + u * ((1 - v) * b + v * c), share * 2 * u * along.w[i] * g.w[j]};
    }
  return points;
}

}  // namespace palpate
