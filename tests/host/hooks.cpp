// SPDX-License-Identifier: MIT
// The hooks of a host in whose program nothing is wrong.
#include <cstdlib>

[[noreturn]] void host_setup_error(const char* message) noexcept;
void host_assert(bool holds, const char* condition) noexcept;

void host_setup_error(const char*) noexcept { std::abort(); }
void host_assert(bool holds, const char*) noexcept {
  if (!holds) std::abort();
}
