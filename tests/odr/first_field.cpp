// SPDX-License-Identifier: MIT
#include "field.hpp"

int main() { return field_here() == field_of_second() ? 0 : 1; }
