// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where the fields of unit loads lie in memory.

#include <cstddef>

namespace palpate {

/// Layout of the influence functions, the fields of unit loads at the nodes of a load mesh: x of every vertex
/// of the boundary element mesh, y and z `stride` further each, mu = 1.
struct InfluenceFunctions {
  /// Loads per node: unit forces along x, y, z; unit radial force dipole; unit bending couples along the
  /// node's two tangents; unit torsional couple about its inward normal; unit forces along x, y, z, sharpened
  /// twice.
  static constexpr std::size_t loads = 10;
  /// The first of the sharpened forces g_k. A load that linear weights share among the nodes around it is
  /// spread too widely; (f_k + g_k)/2, f_k the force at node k, is right in the mean (load_positions.hpp).
  /// The mean of what g_k does at node i and g_i at node k is sharpened at both, to second order.
  static constexpr std::size_t sharpened = 7;
  const float* values = nullptr;
  std::size_t stride = 0;
  [[nodiscard]] const float* operator()(std::size_t node, std::size_t load) const noexcept {
    return values + (loads * node + load) * 3 * stride;
  }
};

}  // namespace palpate
