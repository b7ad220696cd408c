// SPDX-License-Identifier: MIT
#pragma once

/// @file  Depth of a point below several faces at once, smooth where the nearest face changes.

#include <palpate/config.hpp>
#include <palpate/geometry/concept.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate {

/// Blended depth and its derivatives d(depth)/d(d_j).
template <Real S, std::size_t N>
struct EdgeBlend {
  S depth;                  ///< phi [m]
  std::array<S, N> weight;  ///< d(phi)/d(d_j) [-], >= 0; sum weight_j d_j = phi
};

/// Blend phi of the depths d_j > 0 below N faces. No equation: own choice, because the direction of the
/// nearest face jumps over an edge, and with it would the force.
///
///     sum_j psi(phi / d_j) = 1,   psi(t) = ((t - t0) / (1 - t0))_+^2,   t0 = 1/2
///
/// | symbol | name     | unit | range                          |
/// |--------|----------|------|--------------------------------|
/// | d_j    | `depths` | m    | > 0, finite                    |
/// | phi    | `depth`  | m    | [0.70, 1] min d_j for N = 6    |
///
/// phi is the nearest face's depth exactly while every other face is at least twice as far; it is homogeneous
/// of degree one (no length of its own), once differentiable, and its gradient's Lipschitz constant is of the
/// order of 1 / phi. Differentiating the sum with t_j = phi / d_j gives
///
///     d(phi)/d(d_j) = psi'(t_j) t_j^2 / sum_k psi'(t_k) t_k.
///
/// Solution: with u = phi / d_min and m_j = d_min / d_j in (0, 1] the sum over the k faces with 2 u m_j > 1
/// is the quadratic 4 u^2 M2 - 4 u M1 + k - 1 = 0, M1 = sum m_j, M2 = sum m_j^2. Faces are taken in order of
/// depth; adding one with 2 u m > 1 lowers u but never below 1 / (2 m), so it stays in, and the first face
/// with 2 u m <= 1 ends the list. At most N steps, no iteration; the root's discriminant is at least 1/4, so
/// nothing cancels.
template <Real S, std::size_t N>
[[nodiscard]] inline EdgeBlend<S, N> edge_blend(const std::array<S, N>& depths) noexcept {
  std::size_t nearest = 0;
  for (std::size_t j = 1; j < N; ++j)
    if (depths[j] < depths[nearest]) nearest = j;
  const S d = depths[nearest];

  // Faces closer than twice the nearest, deepest ratio first.
  std::array<std::size_t, N> order{};
  std::array<S, N> m{};
  std::size_t count = 0;
  for (std::size_t j = 0; j < N; ++j) {
    const S ratio = j == nearest ? S(1) : d / depths[j];
    if (!(S(2) * ratio > S(1))) continue;
    std::size_t at = count++;
    for (; at > 0 && m[at - 1] < ratio; --at) {
      m[at] = m[at - 1];
      order[at] = order[at - 1];
    }
    m[at] = ratio;
    order[at] = j;
  }

  EdgeBlend<S, N> blend{d, {}};
  if (count <= 1) {
    blend.weight[nearest] = S(1);
    return blend;
  }
  S u = S(1), sum = S(1), squares = S(1);
  std::size_t active = 1;
  for (; active < count && S(2) * u * m[active] > S(1); ++active) {
    sum += m[active];
    squares += m[active] * m[active];
    u = (sum + std::sqrt(sum * sum - static_cast<S>(active) * squares)) / (S(2) * squares);
  }
  blend.depth = u * d;
  S total = S(0);
  for (std::size_t j = 0; j < active; ++j) {
    const S t = u * m[j], slope_t = (S(2) * t - S(1)) * t;  // psi'(t) t / 4
    blend.weight[order[j]] = slope_t * t;
    total += slope_t;
  }
  for (std::size_t j = 0; j < active; ++j) blend.weight[order[j]] /= total;
  return blend;
}

namespace detail {
/// The blend of several points at once; the mask is true for those below all faces, and the others have some
/// blend. Depths are differences of numbers >= `size`. Faces that do not count take part where they change
/// nothing, at 2 u m = 1; weights are 0 there by themselves.
template <class V, std::size_t N>
PALPATE_INLINE MaskOf<V> edge_blend(std::array<V, N> depths, ValueOf<V> size, V& depth,
                                    std::array<V, N>& weight) noexcept {
  using S = ValueOf<V>;
  V least = (min)(depths[0], depths[1]), second = (max)(depths[0], depths[1]);
  for (std::size_t j = 2; j < N; ++j) {
    second = (min)(second, (max)(least, depths[j]));
    least = (min)(least, depths[j]);
  }
  const auto below = least > V{};
  if (!any_of(below && second < S(2) * least)) {  // the nearest face alone
    for (std::size_t j = 0; j < N; ++j) weight[j] = select(depths[j] < second, V(S(1)), V{});
    depth = least;
    return below;
  }
  const S tiny = std::numeric_limits<S>::epsilon() / S(4) * size;  // > 0 and below any depth that counts
  for (V& face : depths) face = (max)(face, tiny);
  depth = (max)(least, tiny);
  std::array<V, N> m, sorted;
  for (std::size_t j = 0; j < N; ++j) {  // into `sorted`, greatest first
    m[j] = depth / depths[j];
    V next = m[j];
    for (std::size_t k = 0; k < j; ++k) {
      const V greater = (max)(sorted[k], next);
      next = (min)(sorted[k], next);
      sorted[k] = greater;
    }
    sorted[j] = next;
  }
  V u = S(1), sum = u, squares = u;
  for (std::size_t k = 1; k < N && reduce_max(sorted[k]) > S(0.5); ++k) {
    const V next = (max)(sorted[k], S(0.5) / u);
    sum += next;
    squares += next * next;
    u = (sum + sqrt(sum * sum - static_cast<S>(k) * squares)) / (S(2) * squares);
  }
  V total{};
  for (std::size_t j = 0; j < N; ++j) {
    const V t = u * m[j], slope_t = (max)(S(2) * t - S(1), S(0)) * t;
    weight[j] = slope_t * t;
    total += slope_t;
  }
  total = S(1) / total;
  for (std::size_t j = 0; j < N; ++j) weight[j] *= total;
  depth *= u;
  return below;
}
}  // namespace detail

}  // namespace palpate
