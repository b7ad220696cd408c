// SPDX-License-Identifier: MIT
#pragma once

/// @file  A host's own hooks, as an engine that is built without exceptions would write them.

[[noreturn]] void host_setup_error(const char* message) noexcept;
#define PALPATE_ON_SETUP_ERROR(message) host_setup_error(message)

void host_assert(bool holds, const char* condition) noexcept;
#define PALPATE_ASSERT(condition) host_assert((condition), #condition)
