// SPDX-License-Identifier: MIT
#pragma once

/// @file  Phong displacement: the paper's interpolation (V.A.2).

#include <palpate/core/inverse_root.hpp>
#include <palpate/interpolation/concept.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

namespace detail {

/// (-1)^k / (K (K+1) ... (K+2k-1)).
template <int K>
[[nodiscard]] constexpr double series_factor(int k) noexcept {
  double factor = 1;
  for (int j = 1; j <= k; ++j) factor /= -(K + 2 * j - 2) * (K + 2 * j - 1);
  return factor;
}
/// sum_k series_factor<K>(k) x^k: Taylor's series of cos y (K = 1) and (sin y)/y (K = 2) in x = y^2, for |y| <= pi/2 to
/// 2 ulp of 1. Without a branch, so that loops vectorise.
template <Real S, int K, int First = 0>
[[nodiscard]] inline S alternating_series(S x) noexcept {
  constexpr int last = sizeof(S) == 4 ? 6 : 10;
  constexpr S factor = static_cast<S>(series_factor<K>(First));
  if constexpr (First == last)
    return factor;
  else
    return factor + x * alternating_series<S, K, First + 1>(x);
}

}  // namespace detail

/// Magnitude |u| and displacement angle theta (between u and the outward normal) of the corners, interpolated
/// linearly over each face: an extension of Phong shading.
///
///     |u| = sum_i w_i |u_i|                    theta = sum_i w_i g_i theta_i / sum_i w_i g_i
///     u = |u| (cos theta n + sin theta t)      t = (sum_i w_i g_i s_i) projected across n, normalised
///
/// | symbol  | name                    | unit | range                                                    |
/// |---------|-------------------------|------|----------------------------------------------------------|
/// | u_i     | corners, and D          | m    | below 1e6; otherwise nothing moves                       |
/// | theta_i | angle of u_i            | rad  | [0, pi], to the normal at corner i                       |
/// | s_i     | tangential part         | -    | of u_i/|u_i| at corner i                                 |
/// | n       | `partition().normal()`  | -    | undeformed surface's at the vertex                       |
/// | g_i     | what a corner lends     | -    | min(1, 16 |u_i| / max_j |u_j|): a corner that stands     |
/// |         |                         |      | still has no direction and lends none, without a jump    |
/// | w_i     | weights                 | -    | of `FacePartition`, the contact's among them             |
///
/// Where the tangential directions cancel, t has none: its length is then at most 4 |sum w g s| / sum w g, and the
/// missing part e of sin theta is taken from the linear interpolation L of the vectors: u = (1 - e) |u| (...) + e L.
///
/// Limits: not linear in the load; a rigid translation is not reproduced (its angle to the normal differs from
/// corner to corner); |u| is never above the largest corner's.
/// Source: paper V.A.2; azimuth, g_i and the fall-back are this library's reading (docs/shape.md).
template <Real S>
class PhongInterpolation {
 public:
  using Scalar = S;

  /// What a corner contributes, times its weight: |u|, g, g theta, g s (3), u (3).
  static constexpr std::size_t terms = 9;
  using Corner = std::array<S, terms>;

  struct Load {
    bool active = false;
    PointWeights<S> at;
    std::array<Corner, max_extremal_points> corner;  // read for active loads only
    Corner contact{};
  };

  explicit PhongInterpolation(FacePartition<S> partition) : partition_(std::move(partition)) {}

  [[nodiscard]] const FacePartition<S>& partition() const noexcept { return partition_; }

  void prepare(std::span<const Vec3<S>> corners, const ContactDisplacement<S>& contact,
               Load& load) const noexcept {
    load.active = false;
    const auto points = partition_.points();
    if (corners.size() != points.size() || !is_drawable(contact)) return;
    S largest = contact.displacement.stableNorm();
    for (const Vec3<S>& u : corners) {
      if (!is_drawable(u)) return;
      largest = (std::max)(largest, u.stableNorm());
    }
    load.at = partition_.locate(contact.place);
    if (!load.at.valid || !is_finite(largest) || !(largest > S(16) * (std::numeric_limits<S>::min)())) return;
    for (std::size_t i = 0; i < corners.size(); ++i)
      load.corner[i] = terms_of(corners[i], points[i].normal, largest);
    load.contact = terms_of(contact.displacement, contact.normal, largest);
    load.active = true;
  }

  [[nodiscard]] bool moves(const Load& load, std::size_t face) const noexcept {
    if (!load.active) return false;
    const Face<S>& f = partition_.faces()[face];
    for (std::size_t k = 0; k < f.corners; ++k) {
      if (load.corner[f.corner[k]][magnitude] > S(0)) return true;
    }
    return load.contact[magnitude] > S(0) && partition_.share(load.at, face) > S(0);
  }

  [[nodiscard]] bool same(const Load& a, const Load& b, std::size_t face) const noexcept {
    if (!a.active || !b.active) return !moves(a, face) && !moves(b, face);
    return detail::same_values(partition_, a, b, face);
  }

  void add(const Load& load, std::size_t face, std::size_t first, const S* scale, S* x, S* y,
           S* z) const noexcept {
    if (!load.active) return;
    const Face<S>& f = partition_.faces()[face];
    WeightBlock<S> w;
    partition_.weights(load.at, face, first, w);

    Block<S> m, g, theta, tx, ty, tz, stretch, missing;
    sum(load, f, w, magnitude, m, g, theta);
    sum(load, f, w, tangent, tx, ty, tz);
    Block<S> less;  // by how much the contact's weight is reduced
    const bool reduced = scale != nullptr && w.rows > f.corners;
    if (reduced) {
      const S* PALPATE_RESTRICT const mu = w.row[f.corners];
      for (std::size_t i = 0; i < block_size; ++i) less[i] = mu[i] * (scale[i] - S(1));
      const S D = load.contact[magnitude];
      for (std::size_t i = 0; i < block_size; ++i) m[i] += less[i] * D;
    }
    const S* PALPATE_RESTRICT const nx = partition_.normal(0) + first;
    const S* PALPATE_RESTRICT const ny = partition_.normal(1) + first;
    const S* PALPATE_RESTRICT const nz = partition_.normal(2) + first;
    direction(nx, ny, nz, g, theta, tx, ty, tz, stretch, missing);
    if (detail::largest(missing) > S(0)) {
      Block<S> u[3];
      sum(load, f, w, linear, u[0], u[1], u[2]);
      S* const out[3] = {x, y, z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const S D = load.contact[linear + axis];
        if (reduced) {
          for (std::size_t i = 0; i < block_size; ++i) u[axis][i] += less[i] * D;
        }
        S* PALPATE_RESTRICT const o = out[axis];
        for (std::size_t i = 0; i < block_size; ++i) o[i] += missing[i] * u[axis][i];
      }
      for (std::size_t i = 0; i < block_size; ++i) m[i] *= S(1) - missing[i];
    }
    add_displacements(nx, ny, nz, m, theta, stretch, tx, ty, tz, x, y, z);
  }

 private:
  static constexpr std::size_t magnitude = 0, lent = 1, angle = 2, tangent = 3,
                               linear = 6;  // places in Corner

  // Sums of three neighbouring terms.
  static void sum(const Load& load, const Face<S>& f, const WeightBlock<S>& w, std::size_t term, Block<S>& x,
                  Block<S>& y, Block<S>& z) noexcept {
    std::array<const S*, max_face_corners + 1> value;
    for (std::size_t k = 0; k < f.corners; ++k) value[k] = load.corner[f.corner[k]].data() + term;
    value[f.corners] = load.contact.data() + term;
    detail::sum_rows<false>(w, value, x.value, y.value, z.value);
  }

  // Sums of terms to cosine (in theta), tangential vectors and their stretch, and what is missing of the sine. One
  // short loop after the other: their results are far apart, and a long loop would wait for them.
  static void direction(const S* PALPATE_RESTRICT nx, const S* PALPATE_RESTRICT ny,
                        const S* PALPATE_RESTRICT nz, Block<S>& PALPATE_RESTRICT g,
                        Block<S>& PALPATE_RESTRICT theta, Block<S>& PALPATE_RESTRICT tx,
                        Block<S>& PALPATE_RESTRICT ty, Block<S>& PALPATE_RESTRICT tz,
                        Block<S>& PALPATE_RESTRICT stretch, Block<S>& PALPATE_RESTRICT missing) noexcept {
    constexpr S tiny = (std::numeric_limits<S>::min)(), most_stretch = S(4);
    Block<S> length2, sine;
    for (std::size_t i = 0; i < block_size; ++i)
      g[i] = g[i] > tiny ? g[i] : tiny;  // nothing lent: m is 0 as well
    for (std::size_t i = 0; i < block_size; ++i) g[i] = S(1) / g[i];
    for (std::size_t i = 0; i < block_size; ++i) {
      const S turned = theta[i] * g[i] - S(1.57079632679489661923132169163975144L), square = turned * turned;
      sine[i] = detail::alternating_series<S, 1>(square);
      theta[i] = -turned * detail::alternating_series<S, 2>(square);  // from here on: cosine
    }
    for (std::size_t i = 0; i < block_size; ++i) {
      const S across = tx[i] * nx[i] + ty[i] * ny[i] + tz[i] * nz[i];
      tx[i] = (tx[i] - nx[i] * across) * g[i];
      ty[i] = (ty[i] - ny[i] * across) * g[i];
      tz[i] = (tz[i] - nz[i] * across) * g[i];
      length2[i] = tx[i] * tx[i] + ty[i] * ty[i] + tz[i] * tz[i];
    }
    for (std::size_t i = 0; i < block_size; ++i) {
      const S per_length = detail::inverse_root(length2[i]), wanted = sine[i] * per_length;
      // Nothing, not even a rounding, where less than `most_stretch` is enough.
      const S lacking = sine[i] - most_stretch * length2[i] * per_length;
      missing[i] = lacking > S(0) ? lacking : S(0);
      stretch[i] = wanted < most_stretch ? wanted : most_stretch;
    }
  }

  static void add_displacements(const S* PALPATE_RESTRICT nx, const S* PALPATE_RESTRICT ny,
                                const S* PALPATE_RESTRICT nz, const Block<S>& PALPATE_RESTRICT m,
                                const Block<S>& PALPATE_RESTRICT cosine,
                                const Block<S>& PALPATE_RESTRICT stretch, const Block<S>& PALPATE_RESTRICT tx,
                                const Block<S>& PALPATE_RESTRICT ty, const Block<S>& PALPATE_RESTRICT tz,
                                S* PALPATE_RESTRICT x, S* PALPATE_RESTRICT y,
                                S* PALPATE_RESTRICT z) noexcept {
    for (std::size_t i = 0; i < block_size; ++i) {
      const S along = m[i] * cosine[i], aside = m[i] * stretch[i];
      x[i] += along * nx[i] + aside * tx[i];
      y[i] += along * ny[i] + aside * ty[i];
      z[i] += along * nz[i] + aside * tz[i];
    }
  }

  static Corner terms_of(const Vec3<S>& u, const Vec3<S>& normal, S largest) noexcept {
    const S size = u.stableNorm();
    if (!(size > (std::numeric_limits<S>::min)())) return {};
    const Vec3<S> n = unit_or<S>(normal, Vec3<S>::UnitY()), direction = u / size,
                  s = tangential(direction, n);
    const S g = (std::min)(S(1), S(16) * size / largest), theta = std::atan2(s.norm(), direction.dot(n));
    return {size, g, g * theta, g * s.x(), g * s.y(), g * s.z(), u.x(), u.y(), u.z()};
  }

  FacePartition<S> partition_;
};

static_assert(Interpolation<PhongInterpolation<float>> && Interpolation<PhongInterpolation<double>>);

}  // namespace palpate
