// SPDX-License-Identifier: MIT
#include "field.hpp"

std::vector<std::byte> field_of_second() { return field_here(); }
