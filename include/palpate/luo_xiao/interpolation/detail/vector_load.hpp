// SPDX-License-Identifier: MIT
#pragma once

/// @file  What interpolations over the faces of a partition share: a load of one value per corner.

#include <palpate/luo_xiao/interpolation/concept.hpp>

#include <array>
#include <span>
#include <utility>

namespace palpate::detail {

/// Do two active loads, with values per corner and of the contact, give the same field on the face, bit for
/// bit?
template <Real S, class Load>
[[nodiscard]] inline bool same_values(const FacePartition<S>& partition, const Load& a, const Load& b,
                                      std::size_t face) noexcept {
  const Face<S>& f = partition.faces()[face];
  for (std::size_t k = 0; k < f.corners; ++k) {
    if (a.corner[f.corner[k]] != b.corner[f.corner[k]]) return false;
  }
  const bool split = partition.share(a.at, face) > S(0) || partition.share(b.at, face) > S(0);
  return !split || (a.contact == b.contact && a.at.weight == b.at.weight);
}

/// The partition, and loads of displacement vectors: all of a `BlockInterpolation` but `add`.
template <Real S>
class VectorLoads {
 public:
  using Scalar = S;

  struct Load {
    bool active = false;
    PointWeights<S> at;
    std::array<Vec3<S>, max_extremal_points> corner;  ///< u_i [m], read for active loads only
    Vec3<S> contact = Vec3<S>::Zero();                ///< D [m]
    Vec3<S> normal = Vec3<S>::Zero();                 ///< at the contact
  };

  explicit VectorLoads(FacePartition<S> partition) : partition_(std::move(partition)) {}

  [[nodiscard]] const FacePartition<S>& partition() const noexcept { return partition_; }

  void prepare(std::span<const Vec3<S>> corners, const ContactDisplacement<S>& contact,
               Load& load) const noexcept {
    load.active = false;
    if (corners.size() != partition_.points().size() || !is_drawable(contact)) return;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!is_drawable(corners[i])) return;
      load.corner[i] = corners[i];
    }
    load.at = partition_.locate(contact.position);
    load.contact = contact.displacement;
    load.normal = contact.normal;
    load.active = load.at.valid;
  }

  [[nodiscard]] bool moves(const Load& load, std::size_t face) const noexcept {
    if (!load.active) return false;
    const Face<S>& f = partition_.faces()[face];
    for (std::size_t k = 0; k < f.corners; ++k) {
      if (!load.corner[f.corner[k]].isZero(S(0))) return true;
    }
    return !load.contact.isZero(S(0)) && partition_.share(load.at, face) > S(0);
  }

  [[nodiscard]] bool same(const Load& a, const Load& b, std::size_t face) const noexcept {
    if (!a.active || !b.active) return !moves(a, face) && !moves(b, face);
    return same_values(partition_, a, b, face);
  }

 private:
  FacePartition<S> partition_;
};

}  // namespace palpate::detail
