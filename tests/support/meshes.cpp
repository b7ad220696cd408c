// SPDX-License-Identifier: MIT
#define PALPATE_TEST_MESHES template
#include "meshes.hpp"
