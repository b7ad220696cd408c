// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where a deformed shape is written, and what one write changed there.

#include <palpate/core/status.hpp>
#include <palpate/core/vector.hpp>

#include <cstddef>

namespace palpate {

/// Where vertices are written: your own buffer in your own layout, one vertex per mesh vertex, in the mesh's
/// order. Strides are in bytes, so positions and normals may sit inside larger vertices; no alignment is
/// asked for.
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

}  // namespace palpate
