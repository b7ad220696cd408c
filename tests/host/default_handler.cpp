// SPDX-License-Identifier: MIT
// No exceptions and no handler of the host: the default one writes to stderr and aborts.
#include <palpate/core/error.hpp>

#include <csignal>
#include <cstdlib>

int main() {
  std::signal(SIGABRT, [](int) { std::_Exit(0); });
  palpate::require_positive(-3.0, "Spring", "stiffness [N/m] must be > 0");
}
