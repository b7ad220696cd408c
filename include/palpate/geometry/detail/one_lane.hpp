// SPDX-License-Identifier: MIT
#pragma once

/// @file One number with the operations of an array of lanes, so that a formula for many points serves a
/// single one, and compiles there as plain arithmetic: an Eigen::Array of one costs a compiler as much as one
/// of sixteen.

#include <palpate/geometry/concept.hpp>

#include <cmath>
#include <type_traits>

namespace palpate::detail {

template <Real S>
struct OneLane {
  S value;

  [[nodiscard]] static PALPATE_INLINE OneLane Constant(S a) noexcept { return {a}; }
  [[nodiscard]] PALPATE_INLINE OneLane inverse() const noexcept { return {S(1) / value}; }
  [[nodiscard]] PALPATE_INLINE OneLane sqrt() const noexcept { return {std::sqrt(value)}; }
  [[nodiscard]] PALPATE_INLINE OneLane abs() const noexcept { return {std::abs(value)}; }
  [[nodiscard]] PALPATE_INLINE OneLane max(S a) const noexcept { return {value < a ? a : value}; }
  [[nodiscard]] PALPATE_INLINE OneLane min(S a) const noexcept { return {a < value ? a : value}; }
  [[nodiscard]] PALPATE_INLINE S sum() const noexcept { return value; }
  [[nodiscard]] PALPATE_INLINE S minCoeff() const noexcept { return value; }
  [[nodiscard]] PALPATE_INLINE S maxCoeff() const noexcept { return value; }

  PALPATE_INLINE OneLane& operator+=(OneLane a) noexcept { return *this = *this + a; }
  PALPATE_INLINE OneLane& operator*=(S a) noexcept { return *this = *this * a; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator-(OneLane a) noexcept { return {-a.value}; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator+(OneLane a, OneLane b) noexcept {
    return {a.value + b.value};
  }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator+(S a, OneLane b) noexcept { return {a + b.value}; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator-(OneLane a, OneLane b) noexcept {
    return {a.value - b.value};
  }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator-(OneLane a, S b) noexcept { return {a.value - b}; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator-(S a, OneLane b) noexcept { return {a - b.value}; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator*(OneLane a, OneLane b) noexcept {
    return {a.value * b.value};
  }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator*(OneLane a, S b) noexcept { return {a.value * b}; }
  [[nodiscard]] friend PALPATE_INLINE OneLane operator*(S a, OneLane b) noexcept { return {a * b.value}; }
};

/// N numbers from memory, and back: V is OneLane for N = 1, else an Eigen::Array.
template <class S, int N>
using Some = std::conditional_t<N == 1, OneLane<S>, Eigen::Array<S, N, 1>>;
template <class S, int N>
[[nodiscard]] PALPATE_INLINE auto load(const S* p) noexcept {
  if constexpr (N == 1)
    return OneLane<S>{*p};
  else
    return Eigen::Map<const Eigen::Array<S, N, 1>>(p);
}
template <class S, class V>
PALPATE_INLINE void store(const V& v, S* p) noexcept {
  if constexpr (std::is_same_v<V, OneLane<S>>)
    *p = v.value;
  else
    Eigen::Map<Eigen::Array<S, V::SizeAtCompileTime, 1>>{p} = v;
}

}  // namespace palpate::detail
