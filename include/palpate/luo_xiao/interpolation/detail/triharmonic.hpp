// SPDX-License-Identifier: MIT
#pragma once

/// @file  Triharmonic spline through values at a few sites, one of which may move.

#include <palpate/core/error.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/geometry/extremal_points.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace palpate {

/// Triharmonic spline in space: of all functions through the values, the one of minimum bending energy of
/// third order (the integral of the squared third derivatives). No equation: V.A.2 asks for minimum elastic
/// energy and leaves open how.
///
///     f(x) = sum_j c_j |x - e_j|^3 + b + A x,   sum_j c_j = 0,  sum_j c_j e_j = 0
///
/// Coordinates are centred on the sites and divided by their max distance; the solve is in double. Rank test:
/// sites in one plane (line, point) to 1e-6 of their extent cannot determine A across it. Then x is projected
/// on that plane first, so f does not vary across it. Affine functions are reproduced exactly (within the
/// plane). Values between the sites may overshoot.
///
/// A further, moving site p gets the function `moving()` that is 0 at the sites and 1 at p. Nearer to a site
/// than a quarter of that site's distance to the next one, it fades into that site's own function, because
/// two sites at one position have no solution; it is 1 at p throughout. The quarter is chosen: the fades of
/// two sites do not meet.
///
/// | symbol | name    | unit | range                                       |
/// |--------|---------|------|---------------------------------------------|
/// | e_j    | `sites` | m    | 1 .. 64, distinct by 1e-6 of their extent   |
///
/// Source: [duchon1977], [wendland2004].
class TriharmonicSpline {
 public:
  static constexpr std::size_t max_sites = max_extremal_points;
  static constexpr std::size_t max_terms = max_sites + 4;

  /// Coefficients of one scalar function: kernels of the sites, kernel of the moving site, then b, A_x, A_y,
  /// A_z.
  struct Function {
    std::array<double, max_sites> kernel{};
    double moving = 0;
    std::array<double, 4> affine{};
  };

  explicit TriharmonicSpline(std::span<const Vec3<double>> sites) : count_(sites.size()) {
    if (sites.empty() || sites.size() > max_sites)
      fail(name, "takes 1 to 64 sites", static_cast<double>(sites.size()));
    for (std::size_t i = 0; i < count_; ++i) {
      if (!is_finite(sites[i])) fail_at(name, "must be finite", "site", i);
      centre_ += sites[i] / static_cast<double>(count_);
    }
    for (const Vec3<double>& e : sites) extent_ = (std::max)(extent_, (e - centre_).norm());
    if (!(extent_ > 0)) extent_ = 1;  // a single site
    const int rank = find_plane(sites);
    for (const Vec3<double>& e : sites) sites_.push_back(reduced(e));
    measure_gaps();
    solve(rank);
  }

  [[nodiscard]] std::size_t size() const noexcept { return count_; }
  /// x in the coordinates of the coefficients: centred, scaled and, for sites in a plane, projected.
  [[nodiscard]] Vec3<double> reduced(const Vec3<double>& x) const noexcept {
    return onto_ * (x - centre_) / extent_;
  }
  /// Reduced sites.
  [[nodiscard]] std::span<const Vec3<double>> sites() const noexcept { return sites_; }
  [[nodiscard]] static double kernel(const Vec3<double>& r) noexcept {
    const double square = r.squaredNorm();
    return square * std::sqrt(square);
  }

  /// The spline through `values`, one per site.
  void through(const double* values, Function& f) const noexcept {
    f = Function{};
    for (std::size_t i = 0; i < count_; ++i) add_cardinal(i, values[i], f);
  }

  /// Values at the reduced point p of the functions that are 1 at one site and 0 at the others.
  void cardinals(const Vec3<double>& p, double* values) const noexcept {
    std::array<double, max_sites> k;
    for (std::size_t j = 0; j < count_; ++j) k[j] = kernel(p - sites_[j]);
    for (std::size_t i = 0; i < count_; ++i) {
      double value = term(count_, i) + term(count_ + 1, i) * p.x() + term(count_ + 2, i) * p.y() +
                     term(count_ + 3, i) * p.z();
      for (std::size_t j = 0; j < count_; ++j) value += term(j, i) * k[j];
      values[i] = value;
    }
  }

  /// The function of the moving site at reduced p; `cardinal` are cardinals(p).
  void moving(const Vec3<double>& p, const double* cardinal, Function& f) const noexcept {
    f = Function{};
    std::array<double, max_sites> k, residual;
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < count_; ++j) {
      k[j] = kernel(p - sites_[j]);
      if (k[j] < k[nearest]) nearest = j;
    }
    // g(v) = |v-p|^3 - sum_j L_j(p) |v-e_j|^3, less its spline through the sites, is 0 there; `peak` is its
    // value at p.
    double peak = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      residual[i] = k[i];
      for (std::size_t j = 0; j < count_; ++j) residual[i] -= cardinal[j] * kernel(sites_[i] - sites_[j]);
      peak -= cardinal[i] * (k[i] + residual[i]);
    }
    const double q = (p - sites_[nearest]).squaredNorm() / (gap_[nearest] * gap_[nearest]);
    const double own = q < 1 ? q * (2 - q) : 1;         // 1 - fade, without cancellation
    const double scale = own / (std::max)(peak, 1e-9);  // peak ~ q near a site; at it 0 / 1e-9 = 0
    f.moving = scale;
    for (std::size_t j = 0; j < count_; ++j) f.kernel[j] -= scale * cardinal[j];
    for (std::size_t j = 0; j < count_; ++j) add_cardinal(j, -scale * residual[j], f);
    // So near to the site its cardinal function is close to 1; 0.25 keeps the quotient bounded.
    if (own < 1) add_cardinal(nearest, (1 - own) / (std::max)(cardinal[nearest], 0.25), f);
  }

  /// f at reduced x, with the moving site at reduced p.
  [[nodiscard]] double value(const Function& f, const Vec3<double>& x, const Vec3<double>& p) const noexcept {
    double sum = f.affine[0] + f.affine[1] * x.x() + f.affine[2] * x.y() + f.affine[3] * x.z();
    for (std::size_t j = 0; j < count_; ++j) sum += f.kernel[j] * kernel(x - sites_[j]);
    return sum + f.moving * kernel(x - p);
  }

 private:
  [[nodiscard]] double term(std::size_t row, std::size_t site) const noexcept {
    return terms_[site * (count_ + 4) + row];
  }

  void add_cardinal(std::size_t site, double factor, Function& f) const noexcept {
    for (std::size_t j = 0; j < count_; ++j) f.kernel[j] += factor * term(j, site);
    for (std::size_t a = 0; a < 4; ++a) f.affine[a] += factor * term(count_ + a, site);
  }

  // Rank of the sites' spread by Gram-Schmidt, the most distant site first; sets `axes_` to its directions
  // and `onto_` to the projection on them.
  int find_plane(std::span<const Vec3<double>> sites) {
    std::vector<Vec3<double>> left;
    for (const Vec3<double>& e : sites) left.push_back((e - centre_) / extent_);
    int rank = 0;
    while (rank < 3) {
      const auto most_distant = std::max_element(
          left.begin(), left.end(),
          [](const Vec3<double>& a, const Vec3<double>& b) { return a.squaredNorm() < b.squaredNorm(); });
      if (!(most_distant->norm() > 1e-6)) break;  // of the sites' extent, see above; chosen
      const Vec3<double> axis = most_distant->normalized();
      axes_.row(rank++) = axis.transpose();
      for (Vec3<double>& r : left) r -= axis * axis.dot(r);
    }
    if (rank == 3) {
      axes_.setIdentity();
      return rank;  // onto_ is the identity
    }
    onto_.setZero();
    for (int i = 0; i < rank; ++i) onto_ += axes_.row(i).transpose() * axes_.row(i);
    return rank;
  }

  void measure_gaps() {
    for (std::size_t i = 0; i < count_; ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < count_; ++j) {
        if (j != i) nearest = (std::min)(nearest, (sites_[i] - sites_[j]).norm());
      }
      if (!(nearest > 1e-6)) fail_at(name, "must be distinct", "site", i);
      gap_.push_back(count_ > 1 ? nearest / 4 : 0.25);  // a single site: a quarter of the unit of length
    }
  }

  // Coefficients of all cardinal functions: Gauss-Jordan elimination with column pivots of
  //   [ |e_i - e_j|^3  1  e_i ] [ c ]   [ unit vectors ]
  //   [ 1   e_j        0   0  ] [ b ] = [      0       ]
  void solve(int rank) {
    const std::size_t n = count_, size = n + 1 + static_cast<std::size_t>(rank), width = size + n;
    std::vector<double> m(size * width, 0.0);
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return m[i * width + j]; };
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) at(i, j) = kernel(sites_[i] - sites_[j]);
      at(i, n) = at(n, i) = at(i, size + i) = 1;
      for (std::size_t a = 0; a + n + 1 < size; ++a)
        at(i, n + 1 + a) = at(n + 1 + a, i) = axes_.row(static_cast<int>(a)).dot(sites_[i]);
    }
    for (std::size_t k = 0; k < size; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < size; ++i) {
        if (std::abs(at(i, k)) > std::abs(at(pivot, k))) pivot = i;
      }
      // Entries are at most 8; rounding leaves less than this of a pivot that is zero.
      if (!(std::abs(at(pivot, k)) > 1e-14)) fail(name, "sites give a singular system");
      if (pivot != k) {
        for (std::size_t j = 0; j < width; ++j) std::swap(at(k, j), at(pivot, j));
      }
      const double scale = 1 / at(k, k);
      for (std::size_t j = k; j < width; ++j) at(k, j) *= scale;
      for (std::size_t i = 0; i < size; ++i) {
        const double factor = at(i, k);
        if (i == k || factor == 0) continue;
        for (std::size_t j = k; j < width; ++j) at(i, j) -= factor * at(k, j);
      }
    }
    terms_.assign(n * (n + 4), 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      double* const column = &terms_[i * (n + 4)];
      for (std::size_t j = 0; j <= n; ++j) column[j] = at(j, size + i);
      for (std::size_t a = 0; a + n + 1 < size; ++a) {
        for (int axis = 0; axis < 3; ++axis)
          column[n + 1 + static_cast<std::size_t>(axis)] +=
              at(n + 1 + a, size + i) * axes_(static_cast<int>(a), axis);
      }
    }
  }

  static constexpr const char* name = "TriharmonicSpline";

  std::size_t count_;
  Vec3<double> centre_ = Vec3<double>::Zero();
  double extent_ = 0;
  Mat3<double> axes_ = Mat3<double>::Identity(), onto_ = Mat3<double>::Identity();
  std::vector<Vec3<double>> sites_;
  std::vector<double> gap_;    // radius of the fade around each site
  std::vector<double> terms_;  // coefficients of the cardinal functions, site by site
};

}  // namespace palpate
