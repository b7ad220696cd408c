// SPDX-License-Identifier: MIT
#pragma once

/// @file Vectors of several points at once, by coordinate.

#include <palpate/elasticity/disc.hpp>

namespace palpate::detail {

/// Positions or displacements of several points: one SIMD vector per axis.
template <class V>
struct Axes {
  V x, y, z;
  PALPATE_INLINE Axes& operator+=(const Axes& u) noexcept {
    x += u.x;
    y += u.y;
    z += u.z;
    return *this;
  }
  [[nodiscard]] friend PALPATE_INLINE Axes operator+(const Axes& u, const Axes& v) noexcept {
    return {u.x + v.x, u.y + v.y, u.z + v.z};
  }
  [[nodiscard]] friend PALPATE_INLINE Axes operator-(const Axes& u, const Axes& v) noexcept {
    return {u.x - v.x, u.y - v.y, u.z - v.z};
  }
  template <class K>
  [[nodiscard]] friend PALPATE_INLINE Axes operator*(const K& k, const Axes& u) noexcept {
    return {k * u.x, k * u.y, k * u.z};
  }
  [[nodiscard]] friend PALPATE_INLINE V dot(const Axes& u, const Axes& v) noexcept {
    return u.x * v.x + u.y * v.y + u.z * v.z;
  }
  [[nodiscard]] friend PALPATE_INLINE Axes cross(const Axes& u, const Axes& v) noexcept {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  }
};
using Lane3 = Axes<Lane>;

}  // namespace palpate::detail
