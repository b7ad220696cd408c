// SPDX-License-Identifier: MIT
#pragma once

/// @file  The one place that states the version; CMakeLists.txt reads it from here.

#define PALPATE_VERSION_MAJOR 0
#define PALPATE_VERSION_MINOR 1
#define PALPATE_VERSION_PATCH 0
