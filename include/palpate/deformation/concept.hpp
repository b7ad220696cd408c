// SPDX-License-Identifier: MIT
#pragma once

/// @file  What a deformation model must offer: contacts in, vertices and normals out. Read this before writing one.
///
/// | shipped                      | shape                                            | use it when                           |
/// |------------------------------|--------------------------------------------------|---------------------------------------|
/// | `BeamSkeletonDeformation`    | the paper's (V, VI): skeleton, then interpolation | the paper's look at the least cost    |
/// | `HalfSpaceDeformation`       | elastic, in closed form: half-spaces in series   | a plausible shape without any set-up  |
/// | `ResponseFieldDeformation`   | elastic, by boundary elements at set-up          | shape and force must be right         |
/// | `NoDeformation`              | the undeformed one                               | absent: forces only                   |
///
/// `DisplacementField` is the output stage that models share: displacements of corners to vertices in your buffer.
/// Absent on purpose: volumetric meshes; only the surface is seen and touched.

#include <palpate/core/status.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/equivalent/contact_state.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace palpate {

/// Where vertices are written: your own buffer in your own layout, one vertex per mesh vertex, in the mesh's order.
/// Strides are in bytes, so positions and normals may sit inside larger vertices; no alignment is asked for.
template <Real T>
struct VertexBuffer {
  T* positions = nullptr;                       ///< first vertex's x; y and z follow it
  std::size_t position_stride = 3 * sizeof(T);  ///< from one vertex to the next [bytes], >= 3 sizeof(T)
  T* normals = nullptr;                         ///< null: no normals; unit ones, worked out in float
  std::size_t normal_stride = 3 * sizeof(T);    ///< ditto
};

/// What one tick changed in the buffer.
template <Real S>
struct Moved {
  std::size_t vertices = 0;  ///< positions written; 0: the buffer was not touched
  Vec3<S> lower =
      Vec3<S>::Zero();  ///< corners of the box around those positions [m]; zero when there are none
  Vec3<S> upper = Vec3<S>::Zero();
  Status status = Status::ok;  ///< region_overflow: more contacts than set up, the surplus is not drawn
};

template <class D>  // undeformed shape into a fresh buffer; the next write() starts from it
concept HasWriteRest = requires(D& model, const VertexBuffer<float>& f, const VertexBuffer<double>& d) {
  { model.write_rest(f) }
  noexcept;
  { model.write_rest(d) }
  noexcept;
};

template <class D>  // what moved since the last write, into the same buffer
concept HasWrite = requires(D& model, std::span<const ContactState<typename D::Scalar>> contacts,
                            const VertexBuffer<float>& f, const VertexBuffer<double>& d) {
  { model.write(contacts, f) }
  noexcept->std::same_as<Moved<typename D::Scalar>>;
  { model.write(contacts, d) }
  noexcept->std::same_as<Moved<typename D::Scalar>>;
};

/// A deformation model is absent when `active` is false; then nothing else is asked of it.
template <class D>
concept DeformationModel = Real<typename D::Scalar> && requires {
  { D::active } -> std::convertible_to<bool>;
} &&(!D::active || (HasWriteRest<D> && HasWrite<D>));

}  // namespace palpate
