// SPDX-License-Identifier: MIT
#pragma once

/// @file  One run on the device: open, follow the script, stop, and what is written about it.

#include <functional>
#include <string>

#include "felt.hpp"
#include "openhaptics.hpp"
#include "options.hpp"
#include "scripts.hpp"
#include "tools.hpp"

#if __has_include("standin/standin.hpp") && defined(PALPATE_STANDIN)
#include "standin/standin.hpp"
#endif

namespace touch {

inline constexpr double update_rate = 20;  ///< of what runs beside the servo loop [Hz]

#ifdef PALPATE_STANDIN
using Device = palpate::example::HapticDevice<Feel, standin::Clock>;
#else
using Device = palpate::example::HapticDevice<Feel>;
#endif

/// Runs the script on the device. In this thread `update(record)` gets the newest tick `update_rate` times a
/// second while the servo loop goes on, and `finish(device)` comes after the stop. `top`: the device's origin
/// in the scene.
int perform(const Options& options, Feel& feel, const Tool& tool, const Script& script, const V& top,
            const std::string& title, const std::function<void(const Device::Record&)>& update,
            const std::function<void(const Device&)>& finish);

}  // namespace touch
