// SPDX-License-Identifier: MIT
#include "all.hpp"

Seen seen_by_second() { return seen_here(); }
