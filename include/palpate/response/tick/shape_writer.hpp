// SPDX-License-Identifier: MIT
#pragma once

/// @file Displacements of a response field to the caller's vertices and normals. Per tick.

#include <palpate/display/mesh_normals.hpp>
#include <palpate/display/vertex_buffer.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/response/response_display.hpp>

#include <array>
#include <limits>
#include <vector>

namespace palpate::detail {

/// A display mesh, bound to a field once, with its normals where they are wanted. Set-up reports a mesh that
/// is not finite or, with normals, not closed.
class ShapeWriter {
 public:
  template <Real M>
  ShapeWriter(const ResponseField& field, const MeshData<M>& mesh, bool normals)
      : display_(field, mesh.vertices), has_normals_(normals) {
    if (!normals) return;
    normals_ = MeshNormals(mesh.triangles, mesh.vertices.size());
    std::array<std::vector<float>, 3> rest;
    for (auto& axis : rest) axis.resize(mesh.vertices.size());
    each_at_rest([&rest](std::size_t v, float x, float y, float z) {
      rest[0][v] = x, rest[1][v] = y, rest[2][v] = z;
    });
    normals_.positions().set_row(0, rest[0].size(), rest[0].data(), rest[1].data(), rest[2].data());
    normals_.positions().pack(0);
    normals_.keep_rest();
  }

  [[nodiscard]] const ResponseDisplay& display() const noexcept { return display_; }

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) const noexcept {
    each_at_rest([to = VertexWriter<T>(out.positions, out.position_stride)](
                     std::size_t v, float x, float y, float z) { to.put(v, T(x), T(y), T(z)); });
    if (has_normals_ && out.normals != nullptr) normals_.write_rest(out);
  }

  /// draw(emit) calls emit(slot, u) for every slot of the display, as ResponseTick::each does. Precondition:
  /// out.positions is not null.
  template <Real S, Real T, class Draw>
  [[nodiscard]] Moved<S> write(const VertexBuffer<T>& out, const Draw& draw) noexcept {
    Moved<S> moved;
    const bool with_normals = has_normals_ && out.normals != nullptr;
    Put<T> put(display_, out, with_normals ? &normals_.positions() : nullptr);
    draw(put);
    moved.vertices = display_.size();
    if (moved.vertices > 0) {
      const SimdVec3<Simd4>&low = put.low, &high = put.high;
      moved.lower = Vec3<float>(reduce_min(low.x), reduce_min(low.y), reduce_min(low.z)).template cast<S>();
      moved.upper =
          Vec3<float>(reduce_max(high.x), reduce_max(high.y), reduce_max(high.z)).template cast<S>();
    }
    if (with_normals) {
      normals_.write_positions(out);
      normals_.write(out);
    }
    return moved;
  }

 private:
  // Writes vertices to their slots, and finds the box around them. With normals they go to the buffer that
  // the normals are made from, and from there row by row to the caller.
  template <Real T>
  struct Put {
    using Simd = Simd4;
    const float *at_x, *at_y, *at_z;  // at rest, by slot
    const std::uint32_t* vertex;
    VertexWriter<T> to;
    VertexPositions* positions;  // null: no normals
    SimdVec3<Simd4> low, high;

    Put(const ResponseDisplay& display, const VertexBuffer<T>& out, VertexPositions* buffer) noexcept
        : at_x(display.x()),
          at_y(display.y()),
          at_z(display.z()),
          vertex(display.vertex()),
          to(out.positions, out.position_stride),
          positions(buffer) {
      const Simd far = (std::numeric_limits<float>::max)();
      low = {far, far, far};
      high = {-far, -far, -far};
    }
    PALPATE_INLINE void operator()(std::size_t slot, const SimdVec3<Simd4>& u) noexcept {
      const SimdVec3<Simd4> at{Simd(at_x + slot) + u.x, Simd(at_y + slot) + u.y, Simd(at_z + slot) + u.z};
      low = {(min)(low.x, at.x), (min)(low.y, at.y), (min)(low.z, at.z)};
      high = {(max)(high.x, at.x), (max)(high.y, at.y), (max)(high.z, at.z)};
      if (positions != nullptr)
        positions->set_four(vertex + slot, at.x, at.y, at.z);
      else
        to.put_apart([this, slot](std::size_t k) { return vertex[slot + k]; }, at.x, at.y, at.z);
    }
  };

  template <class Emit>
  void each_at_rest(const Emit& emit) const noexcept {
    for (std::size_t slot = 0; slot < display_.slots(); ++slot)
      emit(display_.vertex()[slot], display_.x()[slot], display_.y()[slot], display_.z()[slot]);
  }

  ResponseDisplay display_;
  MeshNormals normals_;
  bool has_normals_;
};

}  // namespace palpate::detail
