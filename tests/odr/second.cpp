// SPDX-License-Identifier: MIT
#include "all.hpp"

Seen seen_by_second() { return seen_here(); }
std::vector<std::byte> field_of_second() { return field_here(); }
