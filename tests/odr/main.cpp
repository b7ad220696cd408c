// SPDX-License-Identifier: MIT
#include "objects.hpp"

int main() {
  const std::vector<OfObject>& all = objects();
  const bool two = all.size() == 2 && all[0] != all[1];  // each has its own function
  return two && all[0]() == all[1]() ? 0 : 1;
}
