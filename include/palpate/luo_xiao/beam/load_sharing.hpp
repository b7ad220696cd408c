// SPDX-License-Identifier: MIT
#pragma once

/// @file  Load sharing: how the contact force divides among the beams of one skeleton, equations (6)-(8).

#include <palpate/core/cholesky.hpp>
#include <palpate/core/vector.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

namespace palpate {

/// One beam as the sharing sees it: double whatever the scene's scalar, because the system's condition
/// reaches (4/3)(l/r)^2.
struct SkeletonBeam {
  Vec3<double> axis;   ///< x_i: unit, from the extremal point to the contact
  double length;       ///< l_i [m] > 0, at least `Skeleton::min_length` of the longest
  double axial;        ///< ka = E S/l [N/m]
  double transverse;   ///< kt = 3 E I/l^3 or the theory's [N/m]
  Vec3<double> force;  ///< F_i at the common end [N]: the result
};

/// K_i d = ka x x^T d + kt (1 - x x^T) d: the force [N] that moves this beam's end by d [m].
[[nodiscard]] inline Vec3<double> end_force(const SkeletonBeam& beam, const Vec3<double>& d) noexcept {
  return beam.transverse * d + beam.axis * ((beam.axial - beam.transverse) * beam.axis.dot(d));
}

namespace detail {

/// The root W of the shortest beam's compliance, W W = K_s^-1. All systems are solved for W^-1 d: their
/// matrix W K W = 1 + ... is finite and well conditioned however short that beam is.
struct BeamScale {
  std::size_t index;
  Vec3<double> axis;
  double axial, transverse;  // eigenvalues of W [sqrt(m/N)]

  [[nodiscard]] Vec3<double> root(const Vec3<double>& v) const noexcept {
    return transverse * v + axis * ((axial - transverse) * axis.dot(v));
  }
};

[[nodiscard]] inline BeamScale shortest(std::span<const SkeletonBeam> beams) noexcept {
  std::size_t k = 0;
  for (std::size_t i = 1; i < beams.size(); ++i) {
    if (beams[i].length < beams[k].length) k = i;
  }
  return {k, beams[k].axis, 1.0 / std::sqrt(beams[k].axial), 1.0 / std::sqrt(beams[k].transverse)};
}

/// W K_i W of one beam, added to `sum`, between the scaled coordinates of two contacts.
inline void add_scaled(const SkeletonBeam& beam, const BeamScale& a, const BeamScale& b, double factor,
                       Mat3<double>& sum) noexcept {
  const Vec3<double> wa = a.root(beam.axis), wb = b.root(beam.axis);
  for (int j = 0; j < 3; ++j) {
    const Vec3<double> column = a.root(b.root(Vec3<double>::Unit(j)));
    sum.col(j) += factor * (beam.transverse * column + (beam.axial - beam.transverse) * wb[j] * wa);
  }
}

}  // namespace detail

/// One common end with one displacement d, so that x_i = d . x^_i and y_i is the part of d across x^_i:
///
///     K_i = ka_i x^ x^^T + kt_i (1 - x^ x^^T),   K = sum K_i,   K d = F,   F_i = K_i d
///
/// The ratios (6), (7) and the sum (8) then hold for any number of beams, in space:
///
///     F_x1 : .. : F_xn = x_1/l_1 : .. : x_n/l_n  (6),  F_y1 : .. : F_yn = y_1/l_1^3 : .. : y_n/l_n^3  (7)
///     sum F_i = F  (8)
///
/// K is positive definite for n >= 1; cond(K) <= max over beams of ka/kt and kt/ka, (4/3)(l/r)^2 for slender
/// circles. A beam of length 0 takes the whole load. d is not the contact's D (median 15 degrees apart): the
/// skeleton only shares F. Source: [luo2005], V.A.1, equations (4)-(8).
struct CommonEnd {
  /// Sets the beams' forces and d [m]; false when the numbers leave the range of double.
  [[nodiscard]] static bool share(std::span<SkeletonBeam> beams, const Vec3<double>& F,
                                  const Vec3<double>& /*D*/, Vec3<double>& d) noexcept {
    const detail::BeamScale s = detail::shortest(beams);
    Mat3<double> m = Mat3<double>::Identity(), root;
    for (int j = 0; j < 3; ++j) root.col(j) = s.root(Vec3<double>::Unit(j));
    double transverse = 0;
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (i == s.index) continue;
      const Vec3<double> w = s.root(beams[i].axis);
      transverse += beams[i].transverse;
      m += ((beams[i].axial - beams[i].transverse) * w) * w.transpose();
    }
    m += transverse * root.lazyProduct(root);

    detail::SpdSystem<3> system;
    const Vec3<double> right = s.root(F);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j <= i; ++j) system.at(i, j) = m(static_cast<int>(i), static_cast<int>(j));
      system.b[i] = right[static_cast<int>(i)];
    }
    if (!system.solve(3)) return false;
    d = s.root(Vec3<double>(system.b[0], system.b[1], system.b[2]));

    Vec3<double> rest = F;  // the shortest beam takes the rest: exact where K_i d is 0 times infinity
    for (std::size_t i = 0; i < beams.size(); ++i) {
      if (i == s.index) continue;
      beams[i].force = end_force(beams[i], d);
      rest -= beams[i].force;
    }
    beams[s.index].force = rest;
    return is_finite(d) && is_finite(rest);
  }
};

/// (6)-(8) as printed: x_i, y_i are the parts of the contact's known D in beam i's frame, E, S, I cancel, and
/// two multipliers c_x, c_y are left:
///
///     F_i = c_x (x_i/l_i) x^_i + c_y (y_i/l_i^3) y^_i,   sum F_i = F
///
/// For the plane only: in space (8) is three equations. Even there it has no unique answer for a skeleton
/// symmetric about D (rank 1: the cube's top centre, the ellipsoid's pole), and unequal beams may push the
/// wrong way. `share` returns false, and every F_i is 0, unless the vectors of c_x and c_y differ in
/// direction by more than `min_angle` and F lies in their plane to within `max_residual`.
struct PlanarRatios {
  /// [rad]; below, c_x and c_y lose six of their 16 digits.
  static constexpr double min_angle = 1e-6;
  /// Of |F|; coordinates in float are no flatter than that.
  static constexpr double max_residual = 1e-6;

  [[nodiscard]] static bool share(std::span<SkeletonBeam> beams, const Vec3<double>& F, const Vec3<double>& D,
                                  Vec3<double>& d) noexcept {
    d = D;
    const double unit =
        beams[detail::shortest(beams).index].length;  // lengths over the shortest: nothing overflows
    Vec3<double> a = Vec3<double>::Zero(), b = a;
    for (const SkeletonBeam& beam : beams) {
      const double q = unit / beam.length;
      a += along(beam, D) * q;
      b += (D - along(beam, D)) * (q * q * q);
    }
    const double size_a = stable_norm(a), size_b = stable_norm(b), size_F = stable_norm(F);
    if (!(size_a > 0 && size_b > 0 && size_F > 0)) return false;
    a /= size_a;
    b /= size_b;
    const Vec3<double> across = b - a * a.dot(b);
    const double sine2 = across.squaredNorm();
    if (!(sine2 > min_angle * min_angle)) return false;
    const double y = across.dot(F) / sine2, x = a.dot(F) - y * a.dot(b);
    if (!(stable_norm<double>(F - x * a - y * b) <= max_residual * size_F)) return false;
    for (SkeletonBeam& beam : beams) {
      const double q = unit / beam.length;
      beam.force = along(beam, D) * (x / size_a * q) + (D - along(beam, D)) * (y / size_b * q * q * q);
    }
    return true;
  }

 private:
  [[nodiscard]] static Vec3<double> along(const SkeletonBeam& beam, const Vec3<double>& D) noexcept {
    return beam.axis * beam.axis.dot(D);
  }
};

/// Shares F [N] among the beams: sets their forces, and d [m], the end's displacement; D [m] is the contact's
/// own. False when it cannot.
template <class P>
concept LoadSharing = requires(std::span<SkeletonBeam> beams, const Vec3<double>& v, Vec3<double>& d) {
  { P::share(beams, v, v, d) } noexcept -> std::same_as<bool>;
};

static_assert(LoadSharing<CommonEnd> && LoadSharing<PlanarRatios>);

}  // namespace palpate
