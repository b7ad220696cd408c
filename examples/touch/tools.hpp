// SPDX-License-Identifier: MIT
#pragma once

/// @file  The rigid tools of the example. Each has its origin where it touches first, and y up.

#include <vector>

#include "options.hpp"

namespace touch {

/// A round bar.
struct Rod {
  V from, to;     ///< [m]
  double radius;  ///< [m]
};

struct Tool {
  palpate::MeshData<S> mesh;
  S contact_area;           ///< A_0 [m^2]
  S spacing;                ///< of the points that feel [m]
  V centre_of_mass;         ///< [m]
  std::vector<Rod> rods{};  ///< the part that never touches: only drawn
};

inline constexpr S compass_width = 36e-3;  ///< from pin to pin [m]

/// The tool that options.tool names.
[[nodiscard]] Tool make_tool(const Options& options);

}  // namespace touch
