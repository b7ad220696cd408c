// SPDX-License-Identifier: MIT
#include "all.hpp"

int main() { return seen_here() == seen_by_second() && field_here() == field_of_second() ? 0 : 1; }
