// SPDX-License-Identifier: MIT
#pragma once

/// @file The regions' sums of one tick.

#include <palpate/law/map/concept.hpp>

#include <array>
#include <cstddef>
#include <new>
#include <type_traits>

namespace palpate::detail {

/// A tick's sums, made when something touches: in free air they cost nothing. (std::optional's are zeroed by
/// gcc 12.)
template <class Sum, std::size_t N>
class TickSums {
  static_assert(std::is_trivially_destructible_v<std::array<Sum, N>>);

 public:
  TickSums() noexcept {}
  std::array<Sum, N>& begin() noexcept { return *::new (static_cast<void*>(&list_)) std::array<Sum, N>; }
  /// After begin().
  [[nodiscard]] std::array<Sum, N>& list() noexcept { return list_; }

 private:
  union {
    std::array<Sum, N> list_;
  };
};
/// A law with memory has them in free air, too: the solver makes them.
template <ForceModel Force, class Sum, std::size_t N>
[[nodiscard]] inline std::array<Sum, N>& begin(TickSums<Sum, N>& sums) noexcept {
  if constexpr (!StatefulForceLaw<Force>) sums.begin();
  return sums.list();
}

}  // namespace palpate::detail
