// SPDX-License-Identifier: MIT
#pragma once

/// @file  Normals of a mesh all of whose vertices move, into the caller's buffer.

#include <palpate/display/vertex_buffer.hpp>
#include <palpate/display/vertex_normals.hpp>
#include <palpate/display/vertex_writer.hpp>

namespace palpate {

/// Positions in, unit normals out, all vertices at once. A vertex whose triangles have collapsed gets its
/// normal at rest. Set-up reports a mesh that is not closed.
class MeshNormals {
 public:
  MeshNormals() = default;
  MeshNormals(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices)
      : normals_(VertexRings(triangles, vertices)),
        positions_(std::array{VertexRun{0, vertices}}, normals_.packed_reads(vertices)),
        rest_(vertices) {}

  /// The caller fills them: all vertices are one run.
  [[nodiscard]] VertexPositions& positions() noexcept { return positions_; }
  /// Takes the present positions as those at rest. Set-up only.
  void keep_rest() noexcept {
    each([this](const auto& vertex, const auto& x, const auto& y, const auto& z) {
      for (std::uint32_t k = 0; k < x.size(); ++k) rest_[vertex(k)] = {x[k], y[k], z[k]};
    });
  }

  /// Writes all normals. Precondition: out.normals is not null.
  template <Real T>
  void write(const VertexBuffer<T>& out) const noexcept {
    each([to = writer(out)](const auto& vertex, const auto& x, const auto& y, const auto& z) {
      to.put_register(vertex, x, y, z);
    });
  }
  template <Real T>
  void write_rest(const VertexBuffer<T>& out) const noexcept {
    const auto to = writer(out);
    for (std::size_t v = 0; v < rest_.size(); ++v) to.put(v, T(rest_[v].x), T(rest_[v].y), T(rest_[v].z));
  }
  /// Writes the positions to the caller's buffer: after all `VertexPositions::set_four`, before `write`.
  template <Real T>
  void write_positions(const VertexBuffer<T>& out) noexcept {
    const detail::VertexWriter<T> to(out.positions, out.position_stride);
    positions_.complete(normals_.has_rows(), [&to, size = rest_.size()](std::size_t v, const auto& x,
                                                                        const auto& y, const auto& z) {
      if (v + 4 <= size) return to.put_row(v, x, y, z);
      for (std::size_t k = 0; v + k < size; ++k) to.put(v + k, T(x[k]), T(y[k]), T(z[k]));
    });
  }

 private:
  template <Real T>
  [[nodiscard]] static detail::VertexWriter<T> writer(const VertexBuffer<T>& out) noexcept {
    return {out.normals, out.normal_stride};
  }
  template <class Emit>
  void each(const Emit& emit) const noexcept {
    normals_.each_unit(
        normals_.all(), positions_, [this](std::size_t v) { return rest_[v]; }, emit);
  }

  VertexNormals normals_;
  VertexPositions positions_;
  std::vector<Packed3> rest_;
};

}  // namespace palpate
