// SPDX-License-Identifier: MIT
#pragma once

/// @file What a load at a point of the half-space does at another.
///
///     K_ij = ((1 + b) I + (1 - b) e e^T + b (m e^T - e m^T)) / r,   e = (X_i - X_j)/r,   b = 1 - 2 nu
///
/// X_i: where a point's load acts on the undeformed surface, m: the mean of both points' directions of
/// pressing. Source: Boussinesq and Cerruti, [johnson1985], ch. 3.

#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_vec3.hpp>

namespace palpate::detail {

/// Point i seen from j.
template <class V>
struct PointPair {
  V inverse;      ///< 1/r
  SimdVec3<V> e;  ///< from j to i
  SimdVec3<V> m;  ///< mean of both directions of pressing
};

/// r: X_i - X_j; area of a cell there.
template <class V>
[[nodiscard]] PALPATE_INLINE PointPair<V> point_pair(const SimdVec3<V>& r, const SimdVec3<V>& mi,
                                                     const SimdVec3<V>& mj, const V& area) noexcept {
  // Loads of a steep wall act at nearly one position: no nearer than half a cell, or the matrix is not
  // positive.
  const V inverse = inverse_sqrt((max)(dot(r, r), V(0.26f) * area));
  return {inverse, inverse * r, V(0.5f) * (mi + mj)};
}

/// j seen from i.
template <class V>
[[nodiscard]] PALPATE_INLINE PointPair<V> reversed(const PointPair<V>& p) noexcept {
  return {p.inverse, V(-1.f) * p.e, p.m};
}

/// u + K_ij f. `coupled`: false if b = 0.
template <bool coupled = true, class V>
[[nodiscard]] PALPATE_INLINE SimdVec3<V> pushed(float b, const PointPair<V>& p, const SimdVec3<V>& f,
                                                const SimdVec3<V>& u) noexcept {
  const V along = dot(p.e, f);
  if constexpr (!coupled)
    return u + p.inverse * f + (p.inverse * along) * p.e;
  else
    return u + (V(1 + b) * p.inverse) * f + (p.inverse * (V(1 - b) * along - V(b) * dot(p.m, f))) * p.e +
           (p.inverse * V(b) * along) * p.m;
}

}  // namespace palpate::detail
