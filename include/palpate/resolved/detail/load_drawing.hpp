// SPDX-License-Identifier: MIT
#pragma once

/// @file From a resolved contact's loads to the vertices of a display.

#include <palpate/resolved/detail/load_field.hpp>
#include <palpate/response/tick/shape_writer.hpp>

namespace palpate::detail {

/// Holds the buffers; no heap after construction. The field must outlive it.
class LoadDrawing {
 public:
  template <Real M>
  LoadDrawing(const ResponseField& field, const MeshData<M>& mesh, bool normals, std::size_t capacity)
      : writer_(field, mesh, normals), sum_(field, capacity), drawing_(field) {}

  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    writer_.write_rest(out);
  }
  template <Real S, Real T>
  [[nodiscard]] Moved<S> write(std::span<const SurfaceLoad<S>> loads, const VertexBuffer<T>& out) noexcept {
    sum_.add_up(loads);
    drawing_.read(sum_.total(), sum_.drawn());
    return writer_.template write<S>(
        out, [this](auto& put) { drawing_.each(writer_.display(), sum_.drawn(), put); });
  }

 private:
  ShapeWriter writer_;
  LoadField sum_;
  ResponseDrawing<1, DrawnLoads> drawing_;
};

}  // namespace palpate::detail
