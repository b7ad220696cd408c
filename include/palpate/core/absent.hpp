// SPDX-License-Identifier: MIT
#pragma once

/// @file What stands in a class where a part is absent: an empty type. Each role needs its own, because two
/// empty members of one type must have distinct addresses.

namespace palpate {

template <int Role>
struct Absent {};

}  // namespace palpate
