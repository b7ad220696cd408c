// SPDX-License-Identifier: MIT
#pragma once

/// @file  How bad input at set-up is reported: one mechanism, used by every constructor and builder.
///
/// With exceptions: `SetupError` is thrown. Without: `PALPATE_ON_SETUP_ERROR(message)` is called and must not
/// return. Nothing here runs in a tick; run-time trouble is reported by `Status` bits (core/status.hpp).

#include <palpate/config.hpp>
#include <palpate/core/scalar.hpp>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace palpate {

/// Bad input at set-up. `what()` names the thing, the rule and the offending value, for example
/// "DuffingForce: c1 [N/m] must be > 0, got -3".
class SetupError : public std::exception {
 public:
  explicit SetupError(const char* message) noexcept { std::snprintf(text_, sizeof text_, "%s", message); }
  [[nodiscard]] const char* what() const noexcept override { return text_; }

 private:
  char text_[256];  // no heap: an error can be reported when memory is short
};

namespace detail {
[[noreturn]] inline void setup_error(const char* message) {
#if PALPATE_HAS_EXCEPTIONS
  throw SetupError(message);
#elif defined(PALPATE_ON_SETUP_ERROR)
  PALPATE_ON_SETUP_ERROR(message);
  std::abort();
#else
  std::fprintf(stderr, "palpate: %s\n", message);
  std::abort();
#endif
}
}  // namespace detail

/// Reports "`where`: `rule`".
[[noreturn]] inline void fail(const char* where, const char* rule) {
  char text[256];
  std::snprintf(text, sizeof text, "%s: %s", where, rule);
  detail::setup_error(text);
}

/// Reports "`where`: `rule`, got `value`".
[[noreturn]] inline void fail(const char* where, const char* rule, double value) {
  char text[256];
  std::snprintf(text, sizeof text, "%s: %s, got %.9g", where, rule, value);
  detail::setup_error(text);
}

/// Reports "`where`: `rule`, at `thing` `index`" with the value where there is one, for items of a list.
[[noreturn]] inline void fail_at(const char* where, const char* rule, const char* thing, std::size_t index) {
  char text[256];
  std::snprintf(text, sizeof text, "%s: %s, at %s %zu", where, rule, thing, index);
  detail::setup_error(text);
}
[[noreturn]] inline void fail_at(const char* where, const char* rule, const char* thing, std::size_t index,
                                 double value) {
  char text[256];
  std::snprintf(text, sizeof text, "%s: %s, at %s %zu, got %.9g", where, rule, thing, index, value);
  detail::setup_error(text);
}

/// Set-up checks: each reports where, the rule and the value unless it holds. `require_positive` and
/// `require_non_negative` also refuse NaN and infinity.
template <Real S>
constexpr void require_finite(S value, const char* where, const char* rule) {
  if (!is_finite(value)) fail(where, rule, static_cast<double>(value));
}
template <Real S>
constexpr void require_positive(S value, const char* where, const char* rule) {
  if (!is_finite(value) || !(value > S(0))) fail(where, rule, static_cast<double>(value));
}
template <Real S>
constexpr void require_non_negative(S value, const char* where, const char* rule) {
  if (!is_finite(value) || !(value >= S(0))) fail(where, rule, static_cast<double>(value));
}

}  // namespace palpate
