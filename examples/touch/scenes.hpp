// SPDX-License-Identifier: MIT
#pragma once

/// @file Scenes: presets of object, tool, script, parameters and shape model, one for each of the paper's
/// figures.

#include "options.hpp"

namespace touch {

/// Runs options.scene and writes its results into options.out/<scene>.
int run_scene(Options options);

}  // namespace touch
