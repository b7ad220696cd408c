// SPDX-License-Identifier: MIT
#pragma once

/// @file  Phong displacement: the paper's interpolation (V.A.2).

#include <palpate/interpolation/concept.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

namespace detail {

/// Taylor's series of cos y and (sin y)/y for |y| <= pi/2 to 2 ulp of 1, square = y^2; without a branch, so that
/// loops vectorise.
template <Real S, int K = 1>
[[nodiscard]] inline S cosine_series(S square) noexcept {
  constexpr int last = sizeof(S) == 4 ? 6 : 10;
  constexpr S factor = S(1) / static_cast<S>((2 * K - 1) * (2 * K));
  if constexpr (K == last)
    return S(1) - square * factor;
  else
    return S(1) - square * factor * cosine_series<S, K + 1>(square);
}
template <Real S, int K = 1>
[[nodiscard]] inline S sine_series(S square) noexcept {
  constexpr int last = sizeof(S) == 4 ? 6 : 10;
  constexpr S factor = S(1) / static_cast<S>((2 * K) * (2 * K + 1));
  if constexpr (K == last)
    return S(1) - square * factor;
  else
    return S(1) - square * factor * sine_series<S, K + 1>(square);
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
    const Face<S>& f = partition_.faces()[face];
    for (std::size_t k = 0; k < f.corners; ++k) {
      if (a.corner[f.corner[k]] != b.corner[f.corner[k]]) return false;
    }
    const bool split = partition_.share(a.at, face) > S(0) || partition_.share(b.at, face) > S(0);
    return !split || (a.contact == b.contact && a.at.weight == b.at.weight);
  }

  void add(const Load& load, std::size_t face, std::size_t first, const S* scale, S* x, S* y,
           S* z) const noexcept {
    if (!load.active) return;
    const Face<S>& f = partition_.faces()[face];
    WeightBlock<S> w;
    partition_.weights(load.at, face, first, w);

    Block<S> sum[terms];  // over the corners, of weight times term
    for (std::size_t term = 0; term < terms; ++term) {
      std::array<S, max_face_corners + 1> value;
      for (std::size_t k = 0; k < f.corners; ++k) value[k] = load.corner[f.corner[k]][term];
      value[f.corners] = load.contact[term];
      for (std::size_t i = 0; i < block_size; ++i) sum[term][i] = S(0);
      detail::add_rows(w, value.data(), sum[term].value);
    }
    if (scale != nullptr && w.rows > f.corners) {
      for (const std::size_t term : {magnitude, linear, linear + 1, linear + 2}) {
        for (std::size_t i = 0; i < block_size; ++i)
          sum[term][i] += w.row[f.corners][i] * (scale[i] - S(1)) * load.contact[term];
      }
    }
    direct(sum, partition_.normal(0) + first, partition_.normal(1) + first, partition_.normal(2) + first, x,
           y, z);
  }

 private:
  static constexpr std::size_t magnitude = 0, lent = 1, angle = 2, tangent = 3,
                               linear = 6;  // places in Corner
  static constexpr S most_stretch = S(4);

  // Turns the sums into displacements. Short loops: one would not vectorise for the limits in its middle.
  static void direct(Block<S>* sum, const S* PALPATE_RESTRICT nx, const S* PALPATE_RESTRICT ny,
                     const S* PALPATE_RESTRICT nz, S* PALPATE_RESTRICT x, S* PALPATE_RESTRICT y,
                     S* PALPATE_RESTRICT z) noexcept {
    constexpr S tiny = (std::numeric_limits<S>::min)();
    S* PALPATE_RESTRICT const g = sum[lent].value;
    S* PALPATE_RESTRICT const m = sum[magnitude].value;
    S* PALPATE_RESTRICT const theta = sum[angle].value;
    S* PALPATE_RESTRICT const tx = sum[tangent].value;
    S* PALPATE_RESTRICT const ty = sum[tangent + 1].value;
    S* PALPATE_RESTRICT const tz = sum[tangent + 2].value;
    const S* PALPATE_RESTRICT const lx = sum[linear].value;
    const S* PALPATE_RESTRICT const ly = sum[linear + 1].value;
    const S* PALPATE_RESTRICT const lz = sum[linear + 2].value;
    Block<S> length, stretch, missing, sine;
    for (std::size_t i = 0; i < block_size; ++i)
      g[i] = g[i] > tiny ? g[i] : tiny;  // nothing lent: m is 0 as well
    for (std::size_t i = 0; i < block_size; ++i) {
      const S per_lent = S(1) / g[i];
      const S turned = theta[i] * per_lent - S(1.57079632679489661923132169163975144L),
              square = turned * turned;
      sine[i] = detail::cosine_series(square);
      theta[i] = -turned * detail::sine_series(square);  // from here on: cosine
      const S across = tx[i] * nx[i] + ty[i] * ny[i] + tz[i] * nz[i];
      tx[i] = (tx[i] - nx[i] * across) * per_lent;
      ty[i] = (ty[i] - ny[i] * across) * per_lent;
      tz[i] = (tz[i] - nz[i] * across) * per_lent;
      const S length2 = tx[i] * tx[i] + ty[i] * ty[i] + tz[i] * tz[i],
              per_length = detail::inverse_root(length2);
      length[i] = length2 * per_length;
      stretch[i] = sine[i] * per_length;
    }
    for (std::size_t i = 0; i < block_size; ++i)
      stretch[i] = stretch[i] < most_stretch ? stretch[i] : most_stretch;
    for (std::size_t i = 0; i < block_size; ++i) {
      const S lacking = sine[i] - length[i] * stretch[i];
      missing[i] = lacking > S(0) ? lacking : S(0);
    }
    for (std::size_t i = 0; i < block_size; ++i) {
      const S size = m[i] * (S(1) - missing[i]), along = size * theta[i], aside = size * stretch[i];
      x[i] += along * nx[i] + aside * tx[i] + missing[i] * lx[i];
      y[i] += along * ny[i] + aside * ty[i] + missing[i] * ly[i];
      z[i] += along * nz[i] + aside * tz[i] + missing[i] * lz[i];
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
