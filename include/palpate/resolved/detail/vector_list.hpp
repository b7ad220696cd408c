// SPDX-License-Identifier: MIT
#pragma once

/// @file Vectors of space in a list, for registers.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd.hpp>
#include <palpate/core/simd_vec3.hpp>
#include <palpate/core/vector.hpp>

#include <cstddef>

namespace palpate::detail {

/// Sized at set-up; zeros at first. A register's worth of x, the same of y and of z lie together.
class VectorList {
 public:
  using V = native_simd<float>;

  void resize(std::size_t n) { entries_.resize(3 * padded<V>(n)); }
  [[nodiscard]] Vec3<float> operator[](std::size_t i) const noexcept {
    const float* const x = entries_.data() + at(i);
    return {x[0], x[V::size()], x[2 * V::size()]};
  }
  void set(std::size_t i, const Vec3<float>& v) noexcept {
    float* const x = entries_.data() + at(i);
    x[0] = v.x(), x[V::size()] = v.y(), x[2 * V::size()] = v.z();
  }
  /// Vectors i to i + V::size() - 1, i a multiple of V::size().
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
    const float* const x = entries_.data() + 3 * i;
    return {V(x), V(x + V::size()), V(x + 2 * V::size())};
  }
  PALPATE_INLINE void store(std::size_t i, const SimdVec3<V>& v) noexcept {
    float* const x = entries_.data() + 3 * i;
    v.x.copy_to(x), v.y.copy_to(x + V::size()), v.z.copy_to(x + 2 * V::size());
  }

 private:
  [[nodiscard]] static constexpr std::size_t at(std::size_t i) noexcept {
    return 3 * (i / V::size() * V::size()) + i % V::size();
  }
  AlignedList<float> entries_;
};

/// The sum of all vectors.
template <SimdOrReal W>
[[nodiscard]] PALPATE_INLINE Vec3<float> sum_of(const SimdVec3<W>& v) noexcept {
  return {reduce(v.x), reduce(v.y), reduce(v.z)};
}

/// v without its part along m, |m| = 1.
template <SimdOrReal W>
[[nodiscard]] PALPATE_INLINE SimdVec3<W> across(const SimdVec3<W>& m, const SimdVec3<W>& v) noexcept {
  return v - dot(m, v) * m;
}

/// The same vector in every lane.
template <SimdOrReal W = VectorList::V>
[[nodiscard]] PALPATE_INLINE SimdVec3<W> each(const Vec3<float>& v) noexcept {
  return {W(v.x()), W(v.y()), W(v.z())};
}

}  // namespace palpate::detail
