// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where simd_shuffle.hpp was.

#include <palpate/core/simd_shuffle.hpp>
