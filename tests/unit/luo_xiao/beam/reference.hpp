// SPDX-License-Identifier: MIT
#pragma once

/// @file  The skeleton, slow and literal in long double: dense matrices, Gauss with pivoting, nothing scaled.

#include <palpate/core/vector.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace palpate::test {

using L = long double;
using VecL = Vec3<L>;
using MatL = Mat3<L>;

/// Solves A x = b, n x n, by Gauss with partial pivoting.
inline std::vector<L> gauss(std::vector<std::vector<L>> a, std::vector<L> b) {
  const std::size_t n = b.size();
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t p = c;
    for (std::size_t r = c + 1; r < n; ++r) {
      if (std::fabs(a[r][c]) > std::fabs(a[p][c])) p = r;
    }
    std::swap(a[c], a[p]);
    std::swap(b[c], b[p]);
    for (std::size_t r = c + 1; r < n; ++r) {
      const L f = a[r][c] / a[c][c];
      for (std::size_t k = c; k < n; ++k) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  for (std::size_t c = n; c-- > 0;) {
    for (std::size_t k = c + 1; k < n; ++k) b[c] -= a[c][k] * b[k];
    b[c] /= a[c][c];
  }
  return b;
}

/// (E S/l) x x^T + (3 E I/l^3)(1 - x x^T) of a circular beam of section area S from e to p; shear as
/// Timoshenko's.
inline MatL beam_stiffness(const VecL& e, const VecL& p, L E, L S, L kappa_G = 0) {
  const VecL x = (p - e).normalized();
  const L l = (p - e).norm(), I = S * S / (4 * std::numbers::pi_v<L>);
  const L kt = 1 / (l * l * l / (3 * E * I) + (kappa_G > 0 ? l / (kappa_G * S) : 0));
  const MatL along = x * x.transpose();
  return E * S / l * along + kt * (MatL::Identity() - along);
}

/// All contacts' displacements; `share` is a_jk, `coupled` adds the blocks between contacts.
struct ReferenceRegions {
  std::vector<VecL> points, positions, forces;
  std::vector<std::vector<L>> share;
  L E, volume;
  bool coupled = true;

  [[nodiscard]] L area(std::size_t j) const {
    L sum = 0;
    for (const VecL& e : points) sum += (positions[j] - e).norm();
    return volume / sum;
  }
  [[nodiscard]] MatL own(std::size_t j, std::size_t i) const {
    return beam_stiffness(points[i], positions[j], E, area(j));
  }
  // Of contact j's skeleton to contact k: shared, mean section when coupled, j's own when not.
  [[nodiscard]] MatL between(std::size_t j, std::size_t k) const {
    const MatL a = beam_stiffness(positions[k], positions[j], E, area(j)),
               b = beam_stiffness(positions[k], positions[j], E, area(k));
    return share[j][k] * (coupled ? MatL((a + b) / 2) : a);
  }
  [[nodiscard]] std::vector<VecL> displacements() const {
    const std::size_t m = positions.size();
    std::vector<std::vector<L>> a(3 * m, std::vector<L>(3 * m, 0));
    std::vector<L> b(3 * m);
    const auto add = [&](std::size_t j, std::size_t k, const MatL& block) {
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c)
          a[3 * j + r][3 * k + c] += block(static_cast<int>(r), static_cast<int>(c));
      }
    };
    for (std::size_t j = 0; j < m; ++j) {
      for (std::size_t i = 0; i < points.size(); ++i) add(j, j, own(j, i));
      for (std::size_t k = 0; k < m; ++k) {
        if (k == j) continue;
        add(j, j, between(j, k));
        if (coupled) add(j, k, -between(j, k));
      }
      for (std::size_t c = 0; c < 3; ++c) b[3 * j + c] = forces[j][static_cast<int>(c)];
    }
    const std::vector<L> x = gauss(a, b);
    std::vector<VecL> d;
    for (std::size_t j = 0; j < m; ++j) d.push_back(VecL(x[3 * j], x[3 * j + 1], x[3 * j + 2]));
    return d;
  }
};

/// A vector of independent normal components.
template <Real S>
inline Vec3<S> random_vector(std::mt19937_64& random, double size) {
  std::normal_distribution<double> n(0, size);
  const double x = n(random), y = n(random), z = n(random);
  return Vec3<S>(S(x), S(y), S(z));
}

/// A random rotation from four normal numbers.
inline Mat3<double> random_rotation(std::mt19937_64& random) {
  const Vec3<double> x = random_vector<double>(random, 1).normalized();
  Vec3<double> y = random_vector<double>(random, 1);
  y = (y - x * x.dot(y)).normalized();
  Mat3<double> r;
  r << x, y, x.cross(y);
  return r;
}

}  // namespace palpate::test
