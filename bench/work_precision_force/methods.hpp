// SPDX-License-Identifier: MIT
#pragma once

/// @file Methods that the library does not ship, to compare it with: textbook forms, written as a user would.

#include <palpate/core/vector.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace bench {

/// Inverse of F = c1 D + c3 D^3, c3 > 0.
template <class S>
struct CubicInverse {
  S c1, c3;

  [[nodiscard]] S value(S D) const { return D * (c1 + c3 * D * D); }
  [[nodiscard]] S slope(S D) const { return c1 + 3 * c3 * D * D; }

  /// Newton's method from `guess`: monotone from above, because the law is convex.
  [[nodiscard]] S newton(S F, S guess, int steps) const {
    S D = guess;
    for (int i = 0; i < steps; ++i) D -= (value(D) - F) / slope(D);
    return D;
  }
  [[nodiscard]] S newton_linear(S F, int steps) const { return newton(F, F / c1, steps); }
  [[nodiscard]] S newton_bound(S F, int steps) const {
    return newton(F, (std::min)(F / c1, std::cbrt(F / c3)), steps);
  }
  [[nodiscard]] S bisection(S F, int steps) const {
    S low = 0, high = F / c1;
    for (int i = 0; i < steps; ++i) {
      const S middle = (low + high) / 2;
      (value(middle) > F ? high : low) = middle;
    }
    return (low + high) / 2;
  }
  /// Cardano's formula as printed: two cube roots whose sum cancels for small F.
  [[nodiscard]] S cardano(S F) const {
    const S p = c1 / (3 * c3), q = F / (2 * c3), root = std::sqrt(q * q + p * p * p);
    return std::cbrt(q + root) + std::cbrt(q - root);
  }
  /// The trigonometric form of the same.
  [[nodiscard]] S hyperbolic(S F) const {
    const S p = c1 / (3 * c3), q = F / (2 * c3), r = std::sqrt(p);
    return 2 * r * std::sinh(std::asinh(q / (p * r)) / 3);
  }
};

/// Table of the inverse with even steps of the force up to `high`, interpolated linearly.
template <class S>
struct InverseTable {
  std::vector<S> depth;
  S per_force;
  InverseTable(const CubicInverse<S>& law, S high, std::size_t cells) : per_force(S(cells) / high) {
    for (std::size_t i = 0; i <= cells + 1; ++i)
      depth.push_back(law.newton_bound(S(i) / per_force, i == 0 ? 0 : 60));
  }
  [[nodiscard]] S operator()(S F) const {
    const S x = F * per_force;
    const auto i = (std::min)(static_cast<std::size_t>(x), depth.size() - 2);
    return depth[i] + (x - S(i)) * (depth[i + 1] - depth[i]);
  }
};

/// Closest point of an ellipsoid with semi-axes a to x, by the root t of sum (a_i x_i / (t + a_i^2))^2 = 1.
template <class S>
struct EllipsoidPoint {
  using V = palpate::Vec3<S>;
  V a;

  [[nodiscard]] V foot(const V& x, S t) const {
    return (a.cwiseAbs2().cwiseProduct(x)).cwiseQuotient(V(a.cwiseAbs2().array() + t));
  }
  [[nodiscard]] S excess(const V& x, S t) const {
    return a.cwiseProduct(x).cwiseQuotient(V(a.cwiseAbs2().array() + t)).squaredNorm() - 1;
  }
  [[nodiscard]] S lower(const V& x) const {
    return (a.cwiseProduct(x.cwiseAbs()) - a.cwiseAbs2()).maxCoeff();
  }
  [[nodiscard]] V bisection(const V& x, int steps) const {
    S low = lower(x), high = a.cwiseProduct(x).norm() - a.cwiseAbs2().minCoeff();
    for (int i = 0; i < steps; ++i) {
      const S middle = (low + high) / 2;
      (excess(x, middle) > 0 ? low : high) = middle;
    }
    return foot(x, (low + high) / 2);
  }
  /// Newton's method from the left, where the excess is convex and falling.
  [[nodiscard]] V newton(const V& x, int steps) const {
    S t = lower(x);
    for (int i = 0; i < steps; ++i) {
      const V d = a.cwiseAbs2().array() + t, g = a.cwiseProduct(x).cwiseQuotient(d);
      t += (g.squaredNorm() - 1) / (2 * g.cwiseAbs2().cwiseQuotient(d).sum());
    }
    return foot(x, t);
  }
  /// Along the ray from the centre.
  [[nodiscard]] V radial(const V& x) const { return x / x.cwiseQuotient(a).norm(); }
  /// Repeated: a step along the gradient to first order.
  [[nodiscard]] V gradient(const V& x, int steps) const {
    V p = x;
    for (int i = 0; i < steps; ++i) {
      const V g = p.cwiseQuotient(a.cwiseAbs2());
      p -= (p.dot(g) - 1) / 2 * g / g.squaredNorm();
    }
    return p;
  }
};

/// cn(u | m) by descending Landen steps of the arithmetic-geometric mean. [abramowitz1964] 16.4
inline long double jacobi_cn(long double u, long double m) {
  std::array<long double, 16> a{}, c{};
  a[0] = 1;
  c[0] = std::sqrt(m);
  long double b = std::sqrt(1 - m);
  std::size_t n = 0;
  for (; n + 1 < a.size() && c[n] > 1e-20L; ++n) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
  }
  long double phi = std::ldexp(a[n] * u, static_cast<int>(n));
  for (; n > 0; --n) phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
  return std::cos(phi);
}

/// x'' + a x + b x^3 = 0: integrators that take `n` steps of h from (x, v).
template <class S>
struct Oscillator {
  S a, b;
  struct State {
    S x, v;
  };
  [[nodiscard]] S pull(S x) const { return -(a + b * x * x) * x; }

  void explicit_euler(State& s, S h) const {
    const S f = pull(s.x);
    s.x += h * s.v;
    s.v += h * f;
  }
  void symplectic_euler(State& s, S h) const {
    s.v += h * pull(s.x);
    s.x += h * s.v;
  }
  void verlet(State& s, S h) const {
    s.v += h / 2 * pull(s.x);
    s.x += h * s.v;
    s.v += h / 2 * pull(s.x);
  }
  void yoshida4(State& s, S h) const {  // three Verlet steps [yoshida1990]
    const S w = 1 / (2 - std::cbrt(S(2)));
    verlet(s, w * h);
    verlet(s, (1 - 2 * w) * h);
    verlet(s, w * h);
  }
  void newmark(State& s, S h) const {  // average acceleration, Newton's method
    const S f = pull(s.x), known = s.x + h * s.v + h * h / 4 * f;
    S x = s.x + h * s.v;
    for (int i = 0; i < 4; ++i)
      x -= (x - known - h * h / 4 * pull(x)) / (1 + h * h / 4 * (a + 3 * b * x * x));
    s.v += h / 2 * (f + pull(x));
    s.x = x;
  }
  void runge_kutta4(State& s, S h) const {
    const S v1 = s.v, f1 = pull(s.x), v2 = s.v + h / 2 * f1, f2 = pull(s.x + h / 2 * v1);
    const S v3 = s.v + h / 2 * f2, f3 = pull(s.x + h / 2 * v2), v4 = s.v + h * f3, f4 = pull(s.x + h * v3);
    s.x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    s.v += h / 6 * (f1 + 2 * f2 + 2 * f3 + f4);
  }
};

}  // namespace bench
