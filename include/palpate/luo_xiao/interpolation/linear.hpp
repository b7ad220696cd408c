// SPDX-License-Identifier: MIT
#pragma once

/// @file  Linear interpolation of displacement vectors.

#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>
#include <palpate/luo_xiao/interpolation/detail/vector_load.hpp>

namespace palpate {

/// Linear interpolation of the corners' displacement vectors over each face.
///
///     u(v) = sum_i w_i(v) u_i + mu(v) D
///
/// | symbol   | name                   | unit | range                                            |
/// |----------|------------------------|------|--------------------------------------------------|
/// | u_i, D   | corners, displacement  | m    | at most 1e6; otherwise nothing moves             |
/// | w_i, mu  | weights                | -    | of `FacePartition`: >= 0, sum 1                  |
///
/// The field never leaves the convex hull of u_i and D, is linear in the load, and reproduces affine
/// displacements of the polyhedron of extremal points while the contact is outside the partition's fade band.
/// No equation: V.A.2 interpolates magnitude and angle instead, see PhongInterpolation.
template <Real S>
class LinearInterpolation : public detail::VectorLoads<S> {
 public:
  using Load = typename detail::VectorLoads<S>::Load;
  using detail::VectorLoads<S>::VectorLoads;

  PALPATE_FLATTEN void add(const Load& load, std::size_t face, std::size_t from, std::size_t count,
                           const Lists<const S>& start, const Lists<S>& to) const noexcept {
    using V = detail::simd_group<S>;
    const Face<S>& f = this->partition().faces()[face];
    using Terms = detail::FaceTerms<S, 3>;
    Terms value;
    for (std::size_t k = 0; k < f.corners; ++k) value.corner[k] = Terms::row(load.corner[f.corner[k]].data());
    value.contact = Terms::row(load.contact.data());
    detail::with_weights(this->partition(), load.at, face, from,
                         [&](const auto& weights) PALPATE_INLINE_LAMBDA {
                           for (std::size_t i = 0; i < count; i += V::size()) {
                             const auto w = weights.at(i);
                             detail::unroll<3>([&](std::size_t axis) PALPATE_INLINE_LAMBDA {
                               (V(start[axis] + i) + w.sum(value, axis)).copy_to(to[axis] + i);
                             });
                           }
                         });
  }
};

static_assert(BlockInterpolation<LinearInterpolation<float>> &&
              BlockInterpolation<LinearInterpolation<double>>);

}  // namespace palpate
