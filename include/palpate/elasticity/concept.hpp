// SPDX-License-Identifier: MIT
#pragma once

/// @file What a deformation model must offer: contacts in, vertices and normals out. Read this before writing
/// one.
///
/// | shipped | shape | use it when |
/// |---|---|---|
/// | `BeamSkeletonDeformation` | the paper's (V, VI) | the paper's look at the least cost |
/// | `HalfSpaceDeformation` | elastic: half-spaces in series | a plausible shape without any set-up |
/// | `ResponseFieldDeformation` | elastic, by boundary elements at set-up | shape and force must be right |
/// | `ResponseBallDeformation` | the same under a ball | the tool is a ball |
/// | `ResponseLoadDeformation` | the same under loads | contact is resolved (docs/resolved.md) |
/// | `NoDeformation` | the undeformed one | absent: forces only |
///
/// `DisplacementField` is the output stage that models share: displacements of corners to vertices in your
/// buffer. Absent on purpose: volumetric meshes; only the surface is seen and touched.

#include <palpate/contact/contact_state.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/display/vertex_buffer.hpp>

#include <concepts>
#include <span>

namespace palpate {

template <class D>  // undeformed shape into a fresh buffer; the next write() starts from it
concept HasWriteRest = requires(D& model, const VertexBuffer<float>& f, const VertexBuffer<double>& d) {
  { model.write_rest(f) } noexcept;
  { model.write_rest(d) } noexcept;
};

namespace detail {
template <class D>
struct DrawnByOf {
  using type = ContactState<typename D::Scalar>;
};
template <class D>
  requires requires { typename D::Drawn; }
struct DrawnByOf<D> {
  using type = typename D::Drawn;
};
}  // namespace detail

/// What a model draws: `D::Drawn` (SurfaceLoad), or else regions' contacts.
template <class D>
using DrawnBy = typename detail::DrawnByOf<D>::type;

template <class D>  // what moved since the last write, into the same buffer
concept HasWrite = requires(D& model, std::span<const DrawnBy<D>> contacts, const VertexBuffer<float>& f,
                            const VertexBuffer<double>& d) {
  { model.write(contacts, f) } noexcept -> std::same_as<Moved<typename D::Scalar>>;
  { model.write(contacts, d) } noexcept -> std::same_as<Moved<typename D::Scalar>>;
};

/// A deformation model is absent when `active` is false; then nothing else is asked of it.
template <class D>
concept DeformationModel = Real<typename D::Scalar> && requires {
  { D::active } -> std::convertible_to<bool>;
} && (!D::active || (HasWriteRest<D> && HasWrite<D>));

}  // namespace palpate
