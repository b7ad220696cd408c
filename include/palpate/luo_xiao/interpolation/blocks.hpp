// SPDX-License-Identifier: MIT
#pragma once

/// @file  A user's interpolation of one vertex, applied to blocks of vertices.

#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>
#include <palpate/luo_xiao/interpolation/detail/vector_load.hpp>

#include <array>
#include <span>
#include <type_traits>
#include <utility>

namespace palpate {

/// Makes a `BlockInterpolation` of a partition and a policy that works out one vertex:
///
///     u(v) = policy.displacement(weights of v, corners of its face, normal at v)
///
/// Weights are worked out a group of registers at a time; the policy is called vertex by vertex and becomes
/// part of that loop. No equation: V.A.2 leaves other interpolations open. Bad input moves nothing.
template <VertexInterpolation P>
class InterpolationBlocks : public detail::VectorLoads<typename P::Scalar> {
 public:
  using S = typename P::Scalar;
  using Load = typename detail::VectorLoads<S>::Load;

  InterpolationBlocks(FacePartition<S> partition, P policy)
      : detail::VectorLoads<S>(std::move(partition)), policy_(std::move(policy)) {}

  [[nodiscard]] const P& policy() const noexcept { return policy_; }

  [[nodiscard]] bool same(const Load& a, const Load& b, std::size_t face) const noexcept {
    return detail::VectorLoads<S>::same(a, b, face) && (!a.active || !b.active || a.normal == b.normal);
  }

  PALPATE_FLATTEN void add(const Load& load, std::size_t face, std::size_t from, std::size_t count,
                           const Lists<const S>& start, const Lists<S>& to) const noexcept {
    using V = detail::simd_group<S>;
    const FacePartition<S>& part = this->partition();
    const Face<S>& f = part.faces()[face];
    const Lists<const S> n{part.normal(f, 0) + from, part.normal(f, 1) + from, part.normal(f, 2) + from};
    std::array<FaceCorner<S>, max_face_corners + 1> corners;
    for (std::size_t k = 0; k < f.corners; ++k)
      corners[k] = {load.corner[f.corner[k]], part.points()[f.corner[k]].normal};
    corners[f.corners] = {load.contact, load.normal};
    detail::with_weights(part, load.at, face, from, [&](const auto& weights) PALPATE_INLINE_LAMBDA {
      std::array<std::array<S, V::size()>, max_face_corners + 1> weight;  // by corner, of a group of vertices
      const std::size_t terms = weights.terms();
      for (std::size_t i = 0; i < count; i += V::size()) {
        const auto w = weights.at(i);
        w.each_term([&](std::size_t k, const V& x) PALPATE_INLINE_LAMBDA { x.copy_to(weight[k].data()); });
        for (std::size_t j = 0; j < V::size(); ++j) {  // what follows the last vertex is that one again
          std::array<S, max_face_corners + 1> own;
          for (std::size_t k = 0; k < terms; ++k) own[k] = weight[k][j];
          const Vec3<S> u = policy_.displacement(std::span<const S>(own.data(), terms),
                                                 std::span<const FaceCorner<S>>(corners.data(), terms),
                                                 Vec3<S>(n[0][i + j], n[1][i + j], n[2][i + j]));
          for (std::size_t axis = 0; axis < 3; ++axis)
            to[axis][i + j] = start[axis][i + j] + u[static_cast<int>(axis)];
        }
      }
    });
  }

 private:
  PALPATE_NO_UNIQUE_ADDRESS P policy_;
};

template <class P>
InterpolationBlocks(FacePartition<typename P::Scalar>, P) -> InterpolationBlocks<P>;

namespace detail {
template <class I>
struct BlocksOfType {
  using Type = I;
};
template <class I>
  requires(VertexInterpolation<I> && !BlockInterpolation<I>)
struct BlocksOfType<I> {
  using Type = InterpolationBlocks<I>;
};
}  // namespace detail

/// The interpolation itself where it works on blocks, else `InterpolationBlocks` of it.
template <Interpolation I>
using BlocksOf = typename detail::BlocksOfType<I>::Type;

}  // namespace palpate
