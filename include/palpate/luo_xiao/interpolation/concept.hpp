// SPDX-License-Identifier: MIT
#pragma once

/// @file What an interpolation must offer: displacements of a face's corners to those of the display vertices
/// over it (V.A.2). Read this before writing one.
///
/// | shipped               | field between the corners         | use it when                       |
/// |-----------------------|-----------------------------------|-----------------------------------|
/// | `PhongInterpolation`  | magnitude and angle vary linearly | the paper's; keeps bulges round   |
/// | `LinearInterpolation` | vectors vary linearly             | fastest; affine fields stay exact |
/// | `SmoothInterpolation` | min third-order bending energy    | no creases at the faces' edges    |
///
/// Your own is a `VertexInterpolation`: one function, of one vertex, in plain numbers. `InterpolationBlocks`
/// works out the weights in vector registers and calls it vertex by vertex. The shipped ones are
/// `BlockInterpolation`s: they work on a block of vertices at once, two to three times as fast.
///
/// Corners are the extremal points and one contact point. The fields of several contacts are summed by the
/// caller, so an interpolation sees one contact at a time. No corner is another contact's point: a contact
/// that appears at zero force would press a dimple of zero displacement into the others' fields. Absent on
/// purpose: spherical averages of directions; they iterate, and have no answer for opposite directions.

#include <palpate/core/vector.hpp>
#include <palpate/luo_xiao/interpolation/partition.hpp>

#include <concepts>
#include <cstdint>
#include <span>

namespace palpate {

/// An equivalent contact as the shape sees it. Object coordinates.
template <Real S>
struct ContactDisplacement {
  Vec3<S> position = Vec3<S>::Zero();      ///< p_0 on the undeformed surface [m]
  Vec3<S> normal = Vec3<S>::UnitY();       ///< of the undeformed surface there: outward, unit
  Vec3<S> displacement = Vec3<S>::Zero();  ///< D [m]
  S area = 0;                              ///< of the region [m^2]; 0 for a single point
  S points = 1;                            ///< tool points in the region
  S depth = 0;                             ///< of the tool in the undeformed body [m]; below D_n: D_n

  [[nodiscard]] bool operator==(const ContactDisplacement&) const noexcept = default;
};

/// A displacement that can be drawn: finite and at most 1e6 m, so that nothing overflows even in a float
/// buffer.
template <Real S>
[[nodiscard]] inline bool is_drawable(const Vec3<S>& u) noexcept {
  return is_finite(u) && u.cwiseAbs().maxCoeff() <= S(1e6);
}
template <Real S>
[[nodiscard]] inline bool is_drawable(const ContactDisplacement<S>& c) noexcept {
  return is_drawable(c.position) && is_finite(c.normal) && is_drawable(c.displacement) && is_finite(c.area) &&
         is_finite(c.points) && is_finite(c.depth) && c.depth <= S(1e6);
}

/// A corner of a face as a `VertexInterpolation` sees it: an extremal point, or the contact.
template <Real S>
struct FaceCorner {
  Vec3<S> displacement;  ///< u_i; of the contact w D (V.B) [m]
  Vec3<S> normal;        ///< of the undeformed surface there: outward, unit
};

/// u(v) = displacement(weights, corners, normal) [m] of one vertex v. `weights` and `corners` belong
/// together; the contact is the last one where it splits the face, and absent where it does not. `normal` is
/// the undeformed surface's at v.
template <class I>
concept HasDisplacement = requires(const I& policy, std::span<const typename I::Scalar> weights,
                                   std::span<const FaceCorner<typename I::Scalar>> corners,
                                   const Vec3<typename I::Scalar>& normal) {
  { policy.displacement(weights, corners, normal) } noexcept -> std::same_as<Vec3<typename I::Scalar>>;
};

/// What a user writes. Weights are those of `FacePartition`: >= 0, sum 1. What no concept can check: a corner
/// of weight 0 does not count, one of weight 1 gives its own displacement, corners that all have zero
/// displacement give exactly zero, and the result is continuous in all of its arguments.
template <class I>
concept VertexInterpolation = Real<typename I::Scalar> && HasDisplacement<I> && std::copyable<I>;

template <class I>  // one contact and its corners' displacements, prepared once per tick without the heap
concept HasLoad = std::default_initializable<typename I::Load> && std::copyable<typename I::Load>;

template <class I>  // the faces and slots that `add` speaks of
concept HasPartition = requires(const I& field) {
  { field.partition() } noexcept -> std::same_as<const FacePartition<typename I::Scalar>&>;
};

/// Takes corner displacements u_i [m], one per extremal point, and the contact. Bad input: nothing moves.
template <class I>
concept HasPrepare =
    requires(const I& field, std::span<const Vec3<typename I::Scalar>> corners,
             const ContactDisplacement<typename I::Scalar>& contact, typename I::Load& load) {
      { field.prepare(corners, contact, load) } noexcept;
    };

template <class I>  // does the load move the face at all; false for a default load
concept HasMoves = requires(const I& field, const typename I::Load& load, std::size_t face) {
  { field.moves(load, face) } noexcept -> std::same_as<bool>;
};

template <class I>  // do two loads give the same field on the face, bit for bit; may say false when in doubt
concept HasSame = requires(const I& field, const typename I::Load& load, std::size_t face) {
  { field.same(load, load, face) } noexcept -> std::same_as<bool>;
};

/// to = start + the field of a load that moves the face, at `count` of its slots from number `from` on, at
/// most `block_size` [m]. `start` and `to` may be the same. All lists are read and written in whole
/// `simd_group`s.
template <class I>
concept HasAdd = requires(const I& field, const typename I::Load& load, std::size_t face, std::size_t from,
                          std::size_t count, const Lists<const typename I::Scalar>& start,
                          const Lists<typename I::Scalar>& to) {
  { field.add(load, face, from, count, start, to) } noexcept;
};

/// An interpolation that works on blocks of vertices. Its field is continuous over the surface and in its
/// inputs; it is D at the contact's position and u_i at the corners; zero corners and zero D give exactly
/// zero; turning all vectors turns the field.
template <class I>
concept BlockInterpolation = Real<typename I::Scalar> && HasLoad<I> && HasPartition<I> && HasPrepare<I> &&
                             HasMoves<I> && HasSame<I> && HasAdd<I> && std::copyable<I>;

/// Either.
template <class I>
concept Interpolation = VertexInterpolation<I> || BlockInterpolation<I>;

}  // namespace palpate
