// SPDX-License-Identifier: MIT

/// @file Set-up of response fields, compiled once for programs with PALPATE_COMPILED (config.hpp).

#ifndef PALPATE_COMPILED
#error "compile this file with PALPATE_COMPILED defined, as every file of the program"
#endif

#include <palpate/response/setup/load_mesh_impl.hpp>
#include <palpate/response/setup/mid_edge_table_impl.hpp>
#include <palpate/response/setup/patch_table_impl.hpp>
#include <palpate/response/setup/response_field_impl.hpp>
#include <palpate/response/setup/rotation_table_impl.hpp>
#include <palpate/response/setup/save_impl.hpp>
