// SPDX-License-Identifier: MIT

/// @file Set-up of touch.hpp, compiled once for programs with PALPATE_COMPILED (config.hpp).

#ifndef PALPATE_COMPILED
#error "compile this file with PALPATE_COMPILED defined, as every file of the program"
#endif

#include <palpate/touch/setup/elastic_body_impl.hpp>
#include <palpate/touch/setup/tools_impl.hpp>
#include <palpate/touch/setup/touch_parts_impl.hpp>
