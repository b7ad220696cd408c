// SPDX-License-Identifier: MIT
#pragma once

/// @file  The value in which the force half and the shape half meet: one per region and tick.

#include <palpate/core/vector.hpp>

#include <cstdint>

namespace palpate {

enum class ContactMode : std::uint8_t { frictionless, sticking, sliding };

/// The equivalent contact of a region (IV.C): the point contact with the same force. A plain value of fixed
/// size in object coordinates, without pointers: it can be handed to another thread (TripleBuffer), recorded
/// and replayed.
template <Real S>
struct ContactState {
  std::uint32_t id;      ///< the same as long as the region lives, through growing, merging and splitting
  std::uint32_t points;  ///< tool points in it; 0: a dent that a law with memory has kept, without force
  ContactMode mode;
  Vec3<S> centre;        ///< where the force acts on the tool: the pressure centre [m]
  Vec3<S> normal;        ///< outward, unit
  Vec3<S> displacement;  ///< D = D_t - D_n normal [m], from the origin p0 to the point of largest deformation
  Vec3<S> force;         ///< F_c on the tool, normal part and friction [N]
  Vec3<S> friction;      ///< F_ct on the tool [N]
  S normal_force;        ///< F_cn [N]
  S area;                ///< that carries the force (RegionSum::area) [m^2]; 0 for a single point
  S depth;        ///< of the deepest point: in the body, or below p0's tangent plane where that is more [m]
  S dent = S(0);  ///< part of D_n that is the other regions' dents beneath it (VI) [m]

  /// p0 up to the surface's curvature [m]; the surface point closest to it is p0.
  [[nodiscard]] Vec3<S> origin() const noexcept { return centre - displacement; }
  /// D less the others' dents [m]: for models that add up what single contacts displace.
  [[nodiscard]] Vec3<S> own_displacement() const noexcept { return displacement + dent * normal; }
};

}  // namespace palpate
