// SPDX-License-Identifier: MIT
#pragma once

/// @file A few registers that go through every operation of a formula together.
///
/// The operations of a long formula wait for each other. A processor hides that by working on the loop's next
/// passes meanwhile, as far as its window of instructions goes, which is half as long where two threads share
/// a core: one or two passes of a formula of a hundred instructions. Where every operation is done for
/// several registers, others are always at hand.

#include <palpate/core/inverse_root.hpp>
#include <palpate/core/lane_register.hpp>

#include <array>
#include <concepts>
#include <cstddef>

namespace palpate::detail {

/// Four registers, or two of AVX-512's, whose stores are dear: more do not stay in registers. Arithmetic
/// entry by entry. The register is part of the name, so that objects compiled with other vector flags do not
/// take this one's functions for theirs.
template <Real S, class Register = LaneRegister<S>>
class LaneGroup {
 public:
  using V = Register;
  static constexpr std::size_t registers = sizeof(V) == 64 ? 2 : 4, lanes = registers * register_lanes<S>;

  LaneGroup() = default;  ///< LaneGroup{}: zeros
  /// The same in every entry.
  PALPATE_INLINE LaneGroup(S x) noexcept : LaneGroup(all_of<V>(x)) {}
  PALPATE_INLINE explicit LaneGroup(const V& x) noexcept { r_.fill(x); }
  /// `lanes` numbers from memory.
  PALPATE_INLINE explicit LaneGroup(const S* from) noexcept {
    each([&](std::size_t k) PALPATE_INLINE_LAMBDA { r_[k] = load_register(from + k * register_lanes<S>); });
  }
  PALPATE_INLINE void store(S* to) const noexcept {
    each([&](std::size_t k) PALPATE_INLINE_LAMBDA { store_vector(to + k * register_lanes<S>, r_[k]); });
  }
  [[nodiscard]] PALPATE_INLINE const V& operator[](std::size_t k) const noexcept { return r_[k]; }

#define PALPATE_OPERATOR(op)                                                                         \
  friend PALPATE_INLINE LaneGroup operator op(const LaneGroup& a, const LaneGroup& b) noexcept {     \
    return LaneGroup([&](std::size_t k) PALPATE_INLINE_LAMBDA { return V(a.r_[k] op b.r_[k]); });    \
  }                                                                                                  \
  friend PALPATE_INLINE LaneGroup operator op(const LaneGroup& a, const LaneFactor<S>& b) noexcept { \
    return LaneGroup([&](std::size_t k) PALPATE_INLINE_LAMBDA { return V(a.r_[k] op b); });          \
  }                                                                                                  \
  friend PALPATE_INLINE LaneGroup operator op(const LaneFactor<S>& a, const LaneGroup& b) noexcept { \
    return LaneGroup([&](std::size_t k) PALPATE_INLINE_LAMBDA { return V(a op b.r_[k]); });          \
  }
  PALPATE_OPERATOR(+)
  PALPATE_OPERATOR(-)
  PALPATE_OPERATOR(*)
  PALPATE_OPERATOR(/)
#undef PALPATE_OPERATOR

  [[nodiscard]] PALPATE_INLINE LaneGroup operator-() const noexcept {
    return LaneGroup([&](std::size_t k) PALPATE_INLINE_LAMBDA { return V(-r_[k]); });
  }

  /// f(k) in register k.
  template <std::invocable<std::size_t> F>
  PALPATE_INLINE explicit LaneGroup(const F& f) noexcept {
    each([&](std::size_t k) PALPATE_INLINE_LAMBDA { r_[k] = f(k); });
  }

 private:
  template <class Work>
  static PALPATE_INLINE void each(const Work& work) noexcept {
    unrolled<registers>(work);
  }
  std::array<V, registers> r_;
};

template <Real S>
[[nodiscard]] PALPATE_INLINE LaneGroup<S> larger(const LaneGroup<S>& a, const LaneGroup<S>& b) noexcept {
  return LaneGroup<S>([&](std::size_t k) PALPATE_INLINE_LAMBDA { return larger(a[k], b[k]); });
}
template <Real S>
[[nodiscard]] PALPATE_INLINE LaneGroup<S> smaller(const LaneGroup<S>& a, const LaneGroup<S>& b) noexcept {
  return LaneGroup<S>([&](std::size_t k) PALPATE_INLINE_LAMBDA { return smaller(a[k], b[k]); });
}

/// Adds a to what is there.
template <Real S>
PALPATE_INLINE void add_group(S* to, const LaneGroup<S>& a) noexcept {
  (LaneGroup<S>(to) + a).store(to);
}
/// Is an entry above 0?
template <Real S>
[[nodiscard]] PALPATE_INLINE bool any_positive(const LaneGroup<S>& a) noexcept {
  using V = LaneRegister<S>;
  V most = a[0];
  unrolled<LaneGroup<S>::registers - 1>([&](std::size_t k)
                                            PALPATE_INLINE_LAMBDA { most = larger(most, a[k + 1]); });
  return any<S>(most > V{});
}
template <Real S>
[[nodiscard]] PALPATE_INLINE LaneGroup<S> inverse_root_guess(const LaneGroup<S>& a) noexcept {
  return LaneGroup<S>([&](std::size_t k) PALPATE_INLINE_LAMBDA { return inverse_root_guess(a[k]); });
}

}  // namespace palpate::detail
