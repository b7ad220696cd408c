// SPDX-License-Identifier: MIT
#pragma once

/// @file  Objects of the command line.

#include "options.hpp"

namespace touch {

/// One of the library's exact surfaces, options.object.
int run_surface(const Options& options);

/// The mesh file options.object. The middle of its box becomes the origin.
int run_file(const Options& options);

}  // namespace touch
