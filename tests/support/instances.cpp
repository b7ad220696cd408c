// SPDX-License-Identifier: MIT
#include "instances.hpp"

namespace palpate {
PALPATE_TEST_INSTANCES(template)
}
