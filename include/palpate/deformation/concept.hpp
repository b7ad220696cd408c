// SPDX-License-Identifier: MIT
#pragma once

/// @file  What a deformation model must offer: contacts in, vertices and normals out. Read this before writing one.
///
/// | shipped                      | shape                                            | use it when                           |
/// |------------------------------|--------------------------------------------------|---------------------------------------|
/// | `BeamSkeletonDeformation`    | the paper's (V, VI): skeleton, then interpolation | the paper's look at the least cost    |
/// | `HalfSpaceDeformation`       | elastic, in closed form: half-spaces in series   | a plausible shape without any set-up  |
/// | `NoDeformation`              | the undeformed one                               | absent: forces only                   |
///
/// `DisplacementField` is the output stage that models share: displacements of corners to vertices in your buffer.
/// Absent on purpose: volumetric meshes; only the surface is seen and touched.

#include <palpate/config.hpp>
#include <palpate/core/float_vector.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/equivalent/contact_state.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
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

namespace detail {

/// Writes to the vertices of a caller's buffer, by number.
template <Real T>
class VertexWriter {
 public:
  VertexWriter(T* to, std::size_t stride) noexcept
      : base_(reinterpret_cast<unsigned char*>(to)), stride_(stride) {}

  /// One by one: gathered on the stack first, the copy would wait for the stores.
  PALPATE_INLINE void put(std::size_t vertex, T x, T y, T z) const noexcept {
    unsigned char* const at = base_ + stride_ * vertex;
    std::memcpy(at, &x, sizeof(T));
    std::memcpy(at + sizeof(T), &y, sizeof(T));
    std::memcpy(at + 2 * sizeof(T), &z, sizeof(T));
  }
  /// To vertices number vertex(0) .. vertex(3).
  template <class Vertex>
  PALPATE_INLINE void put_four(const Vertex& vertex, Float4 x, Float4 y, Float4 z) const noexcept {
    if (in_a_row(vertex)) return store_interleaved(base_ + stride_ * vertex(0), x, y, z);
    put(vertex(0), T(x[0]), T(y[0]), T(z[0]));
    put(vertex(1), T(x[1]), T(y[1]), T(z[1]));
    put(vertex(2), T(x[2]), T(y[2]), T(z[2]));
    put(vertex(3), T(x[3]), T(y[3]), T(z[3]));
  }
  /// x[i], y[i], z[i] to vertex number vertex(i), for all i < count.
  template <Real S, class Vertex>
  PALPATE_INLINE void put_all(std::size_t count, const Vertex& vertex, const S* x, const S* y,
                              const S* z) const noexcept {
    for (std::size_t i = 0; i < count;) {
      if constexpr (sizeof(S) == sizeof(float)) {
        if (i + 4 <= count && in_a_row([&vertex, i](std::size_t k) { return vertex(i + k); })) {
          store_interleaved(base_ + stride_ * vertex(i), load_vector<Float4>(x + i),
                            load_vector<Float4>(y + i), load_vector<Float4>(z + i));
          i += 4;
          continue;
        }
      }
      put(vertex(i), static_cast<T>(x[i]), static_cast<T>(y[i]), static_cast<T>(z[i]));
      ++i;
    }
  }

 private:
  // Do four vertices follow each other in a packed buffer of floats? Then whole registers are written.
  template <class Vertex>
  [[nodiscard]] PALPATE_INLINE bool in_a_row(const Vertex& vertex) const noexcept {
    if constexpr (sizeof(T) != sizeof(float)) return false;
    const std::uint32_t first = vertex(0);
    return stride_ == 3 * sizeof(float) && vertex(1) == first + 1 && vertex(2) == first + 2 &&
           vertex(3) == first + 3;
  }

  unsigned char* base_;
  std::size_t stride_;
};

}  // namespace detail

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
