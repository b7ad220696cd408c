// SPDX-License-Identifier: MIT
#pragma once

/// @file One scene played: felt on the device, its shape drawn beside the servo loop, and all of it written
/// down.

#include "options.hpp"

namespace touch {

/// Plays what the options say; results go into options.out.
int play(Options options);

}  // namespace touch
