// SPDX-License-Identifier: MIT
#pragma once

/// @file  The presets of --scene.

#include "body.hpp"
#include "povray.hpp"

namespace touch {

inline constexpr const char* all_scenes[] = {"ellipsoid", "cube-head", "cube-tail", "heart"};

/// Object, tool and script of options.scene.
void preset(Options& options);
[[nodiscard]] std::string title_of(const Options& options, const Body& body);
[[nodiscard]] View scene_view(const Options& options, const Body& body);

}  // namespace touch
