// SPDX-License-Identifier: MIT
#pragma once

/// @file  As many floats or doubles as the widest register holds: for long formulas over many points, which Eigen's arrays keep in
/// memory.

#include <palpate/core/float_vector.hpp>
#include <palpate/core/scalar.hpp>

#include <Eigen/Core>

#include <type_traits>

namespace palpate::detail {

#if defined(__AVX512F__)
using DoubleRegister [[gnu::vector_size(64)]] = double;
#elif defined(__AVX__)
using DoubleRegister [[gnu::vector_size(32)]] = double;
#else
using DoubleRegister [[gnu::vector_size(16)]] = double;
#endif

/// long double: one, for reference computations.
template <Real S>
using LaneRegister = std::conditional_t<std::same_as<S, float>, WideRegister,
                                        std::conditional_t<std::same_as<S, double>, DoubleRegister, S>>;
template <Real S>
inline constexpr std::size_t register_lanes = sizeof(LaneRegister<S>) / sizeof(S);

template <Real S>
[[nodiscard]] PALPATE_INLINE LaneRegister<S> load_register(const S* from) noexcept {
  LaneRegister<S> x;
  std::memcpy(&x, from, sizeof x);
  return x;
}
template <Real S>
PALPATE_INLINE void store_register(S* to, const LaneRegister<S>& x) noexcept {
  std::memcpy(to, &x, sizeof x);
}
template <Real S>
[[nodiscard]] PALPATE_INLINE LaneRegister<S> register_of(S x) noexcept {
  return x - LaneRegister<S>{};
}
/// Square roots of a register of S.
template <Real S>
[[nodiscard]] PALPATE_INLINE LaneRegister<S> register_root(LaneRegister<S> x) noexcept {
  using Array = Eigen::Array<S, static_cast<int>(register_lanes<S>), 1>;
  std::array<S, register_lanes<S>> entry;
  store_register<S>(entry.data(), x);
  Eigen::Map<Array> all(entry.data());
  all = all.sqrt();
  return load_register<S>(entry.data());
}

}  // namespace palpate::detail
