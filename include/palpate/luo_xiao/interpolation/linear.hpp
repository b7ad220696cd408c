// SPDX-License-Identifier: MIT
#pragma once

/// @file  Interpolation of displacement vectors: the plain one.

#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>

#include <utility>

namespace palpate {

/// Linear interpolation of the corners' displacement vectors over each face.
///
///     u(v) = sum_i w_i(v) u_i + mu(v) D
///
/// | symbol   | name                   | unit | range                                            |
/// |----------|------------------------|------|--------------------------------------------------|
/// | u_i, D   | corners, displacement  | m    | below 1e6; otherwise nothing moves               |
/// | w_i, mu  | weights                | -    | of `FacePartition`: >= 0, sum 1                  |
///
/// The field never leaves the convex hull of u_i and D, is linear in the load, and reproduces affine
/// displacements of the polyhedron of extremal points while the contact is outside the partition's fade band.
/// No equation: V.A.2 interpolates magnitude and angle instead, see PhongInterpolation.
template <Real S>
class LinearInterpolation {
 public:
  using Scalar = S;

  struct Load {
    bool active = false;
    PointWeights<S> at;
    std::array<Vec3<S>, max_extremal_points> corner;  ///< u_i [m], read for active loads only
    Vec3<S> contact = Vec3<S>::Zero();                ///< D [m]
  };

  explicit LinearInterpolation(FacePartition<S> partition) : partition_(std::move(partition)) {}

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
    return detail::same_values(partition_, a, b, face);
  }

  PALPATE_FLATTEN void add(const Load& load, std::size_t face, std::size_t from, std::size_t count,
                           const S* scale, const Lists<const S>& start, const Lists<S>& to) const noexcept {
    using V = detail::LaneGroup<S>;
    const Face<S>& f = partition_.faces()[face];
    using Terms = detail::FaceTerms<S, 3>;
    Terms value;
    for (std::size_t k = 0; k < f.corners; ++k) value.corner[k] = Terms::row(load.corner[f.corner[k]].data());
    value.contact = Terms::row(load.contact.data());
    detail::with_weights(partition_, load.at, face, from, [&](const auto& weights) PALPATE_INLINE_LAMBDA {
      for (std::size_t i = 0; i < count; i += V::lanes) {
        const auto w = weights.at(i);
        const V contact = scale == nullptr ? w.contact() : w.contact() * V(scale + i);
        detail::unrolled<3>([&](std::size_t axis) PALPATE_INLINE_LAMBDA {
          (V(start[axis] + i) + w.sum(value, axis, contact)).store(to[axis] + i);
        });
      }
    });
  }

 private:
  FacePartition<S> partition_;
};

static_assert(Interpolation<LinearInterpolation<float>> && Interpolation<LinearInterpolation<double>>);

}  // namespace palpate
