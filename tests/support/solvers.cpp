// SPDX-License-Identifier: MIT
#define PALPATE_TEST_SOLVER template class
#include "solvers.hpp"
