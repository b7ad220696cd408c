// SPDX-License-Identifier: MIT

/// @file Tick and drawing of response fields, samples of tools, compiled once for programs with
/// PALPATE_COMPILED (config.hpp).

#ifndef PALPATE_COMPILED
#error "compile this file with PALPATE_COMPILED defined, as every file of the program"
#endif

#define PALPATE_TICK_INSTANCE template
#include <palpate/resolved/setup/contact_samples_impl.hpp>
#include <palpate/response/setup/response_display_impl.hpp>
#include <palpate/response/tick/contact_coupling.hpp>
#include <palpate/response/tick/instances.hpp>
#include <palpate/response/tick/near_coefficients.hpp>
#include <palpate/response/tick/patch_moments_impl.hpp>
#include <palpate/response/tick/pressed_sphere.hpp>
