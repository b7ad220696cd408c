// SPDX-License-Identifier: MIT
#include "field.hpp"
#include "objects.hpp"

[[maybe_unused]] static const bool added = (objects().push_back(&field_here), true);
