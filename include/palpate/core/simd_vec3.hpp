// SPDX-License-Identifier: MIT
#pragma once

/// @file Many vectors of space in registers, coordinate by coordinate.

#include <palpate/core/simd.hpp>

namespace palpate::detail {

/// Vectors of space, coordinate by coordinate: positions [m], displacements [m], forces ...
template <SimdOrReal V>
struct SimdVec3 {
  V x, y, z;

  PALPATE_INLINE SimdVec3& operator+=(const SimdVec3& b) noexcept { return *this = *this + b; }
  PALPATE_INLINE SimdVec3& operator-=(const SimdVec3& b) noexcept { return *this = *this - b; }
  [[nodiscard]] friend PALPATE_INLINE SimdVec3 operator+(const SimdVec3& a, const SimdVec3& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[nodiscard]] friend PALPATE_INLINE SimdVec3 operator-(const SimdVec3& a, const SimdVec3& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  [[nodiscard]] friend PALPATE_INLINE SimdVec3 operator*(const V& k, const SimdVec3& a) noexcept {
    return {k * a.x, k * a.y, k * a.z};
  }
  [[nodiscard]] friend PALPATE_INLINE V dot(const SimdVec3& a, const SimdVec3& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  [[nodiscard]] friend PALPATE_INLINE SimdVec3 cross(const SimdVec3& a, const SimdVec3& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
};

}  // namespace palpate::detail
