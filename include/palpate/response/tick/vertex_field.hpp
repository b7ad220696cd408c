// SPDX-License-Identifier: MIT
#pragma once

/// @file A field at the vertices of the boundary element mesh: by coordinate, `stride()` numbers each [m].
/// Per tick.

#include <palpate/core/simd_vec3.hpp>
#include <palpate/response/response_field.hpp>

namespace palpate::detail {

/// A contact's near field there: near(at) of several vertices at a time.
void near_at_vertices(const ResponseField& field, const auto& near, float* out) noexcept {
  using Wide = simd_at_most<float, 8>;
  const std::size_t n = field.stride();
  for (std::size_t v = 0; v < n; v += Wide::size()) {
    const auto at = [&field, v](int axis) { return load<Wide>(field.coordinate(axis) + v); };
    const SimdVec3<Wide> u = near(SimdVec3<Wide>{at(0), at(1), at(2)});
    store(out + v, u.x);
    store(out + n + v, u.y);
    store(out + 2 * n + v, u.z);
  }
}
/// 0 where the body is fixed.
inline void hold_fixed(const ResponseField& field, float* u) noexcept {
  const auto n = static_cast<Eigen::Index>(field.stride());
  const Eigen::Map<const Eigen::ArrayXf> free(field.is_free(), n);
  for (Eigen::Index axis = 0; axis < 3; ++axis) Eigen::Map<Eigen::ArrayXf>(u + axis * n, n) *= free;
}
/// Largest u^2 [m^2].
[[nodiscard]] inline double max2(const ResponseField& field, const float* u) noexcept {
  const auto n = static_cast<Eigen::Index>(field.stride());
  const Eigen::Map<const Eigen::ArrayXf> all(u, 3 * n);
  return double((all.head(n).square() + all.segment(n, n).square() + all.tail(n).square()).maxCoeff());
}

}  // namespace palpate::detail
