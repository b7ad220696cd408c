// SPDX-License-Identifier: MIT
#pragma once

/// @file  Vertices of any mesh bound to a response field: the shape that is drawn.

#include <palpate/response/response_field.hpp>

namespace palpate {

/// Display vertices sorted by the boundary element mesh's triangles, each with its weights. It belongs to no
/// tick and serves any number of them. Reports points that are not finite.
///
/// Memory: 24 bytes per vertex and 28 per triangle of the boundary element mesh. Set-up: about a microsecond
/// per vertex.
class ResponseDisplay {
 public:
  struct Span {
    std::uint32_t triangle, begin, end;
  };
  /// Around each span's vertices: by span, whole SIMD registers.
  struct Spheres {
    std::vector<float> x, y, z, radius;
  };

  template <Real S>
  ResponseDisplay(const ResponseField& field, const std::vector<Vec3<S>>& points) {
    std::vector<Vec3<double>> at(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) at[i] = points[i].template cast<double>();
    bind(field.mesh(), at);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] const std::vector<Span>& spans() const noexcept { return spans_; }
  [[nodiscard]] const Spheres& around() const noexcept { return around_; }
  /// Slots: the sorted order, each span filled up to whole SIMD registers by repeating its last vertex.
  [[nodiscard]] std::size_t slots() const noexcept { return vertex_.size(); }
  /// By slot: rest position [m], weights of corners 1 and 2.
  [[nodiscard]] const float* x() const noexcept { return x_.data(); }
  [[nodiscard]] const float* y() const noexcept { return y_.data(); }
  [[nodiscard]] const float* z() const noexcept { return z_.data(); }
  [[nodiscard]] const float* b1() const noexcept { return b1_.data(); }
  [[nodiscard]] const float* b2() const noexcept { return b2_.data(); }
  /// The caller's number of each slot's vertex.
  [[nodiscard]] const std::uint32_t* vertex() const noexcept { return vertex_.data(); }

 private:
  void bind(const ElementMesh& mesh, const std::vector<Vec3<double>>& points);

  std::size_t size_ = 0;
  std::vector<Span> spans_;
  Spheres around_;
  std::vector<float> x_, y_, z_, b1_, b2_;
  std::vector<std::uint32_t> vertex_;
};

}  // namespace palpate

#ifndef PALPATE_COMPILED
#include <palpate/response/setup/response_display_impl.hpp>
#endif
