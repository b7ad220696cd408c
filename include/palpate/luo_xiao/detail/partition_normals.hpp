// SPDX-License-Identifier: MIT
#pragma once

/// @file  Normals of a partition's vertices, of the faces that move.

#include <palpate/core/error.hpp>
#include <palpate/display/vertex_buffer.hpp>
#include <palpate/display/vertex_normals.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/luo_xiao/interpolation/partition.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace palpate {

/// Unit normals of a FacePartition's vertices, by slot. A vertex whose triangles have collapsed gets its
/// normal at rest. A face that moves changes the normals of its vertices and of their neighbours in other
/// faces.
///
/// For each face that moves: write its positions to `positions_from`, or give them to `set_positions`; call
/// `finish_face`; then `write_in_row` writes the normals that depend on this face alone, while its positions
/// are in the first-level cache. After all of them `write_apart` writes the other normals.
template <Real S>
class PartitionNormals {
 public:
  /// No vertices.
  PartitionNormals() = default;
  /// `triangles`: of the mesh that the partition was made from. All vertices are at rest. Reports a mesh that
  /// is not closed.
  PartitionNormals(const FacePartition<S>& partition,
                   std::span<const std::array<std::uint32_t, 3>> triangles) {
    const auto order = partition.order();
    const auto& faces = partition.faces();
    std::vector<std::uint32_t> slot_of(order.size()), face_of(order.size());
    for (std::uint32_t slot = 0; slot < order.size(); ++slot) slot_of[order[slot]] = slot;
    std::vector<std::array<std::uint32_t, 3>> by_slot(triangles.begin(), triangles.end());
    for (std::size_t t = 0; t < by_slot.size(); ++t) {
      for (std::uint32_t& v : by_slot[t]) {
        if (v >= order.size())
          fail_at("PartitionNormals", "vertex does not exist", "triangle", t, static_cast<double>(v));
        v = slot_of[v];
      }
    }
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      for (std::size_t slot = faces[f].first; slot < faces[f].first + faces[f].count; ++slot)
        face_of[slot] = f;
    const VertexRings rings(by_slot, order.size());
    std::vector<std::array<std::uint32_t, 2>> around;  // face, slot: of other faces, next to this one
    std::vector<VertexRun> runs;
    for (const Face<S>& face : faces) {
      std::vector<std::uint32_t> inside(face.count);
      std::iota(inside.begin(), inside.end(), static_cast<std::uint32_t>(face.first));
      around.clear();
      for (const std::uint32_t slot : inside)
        for (const std::uint32_t other : rings[slot])
          if (face_of[other] != face_of[slot]) around.push_back({face_of[other], other});
      runs.push_back({face.first, face.count});
      inside_.push_back(normals_.add(rings, inside, runs.back()));
      std::sort(around.begin(), around.end());
      around.erase(std::unique(around.begin(), around.end()), around.end());
      neighbours_start_.push_back(neighbours_.size());
      for (std::size_t k = 0; k < around.size();) {
        const std::uint32_t f = around[k][0];
        std::vector<std::uint32_t> slots;
        for (; k < around.size() && around[k][0] == f; ++k) slots.push_back(around[k][1]);
        neighbours_.push_back({f, normals_.add(rings, slots)});
      }
    }
    neighbours_start_.push_back(neighbours_.size());
    positions_ = VertexPositions(runs, normals_.packed_reads(order.size()));
    for (std::size_t f = 0; f < faces.size(); ++f) {
      set_positions(0, faces[f].count, partition.rest_from(faces[f], 0));
      finish_face(f);
    }
  }

  /// The present face's positions [m] from its slot number `from` on, to be written in whole `simd_group`s.
  [[nodiscard]] PALPATE_INLINE Lists<float> positions_from(std::size_t from) noexcept {
    return {positions_.axis(0) + from, positions_.axis(1) + from, positions_.axis(2) + from};
  }
  /// Sets `count` of its positions [m], from its slot number `from` on, unless they were written there.
  PALPATE_INLINE void set_positions(std::size_t from, std::size_t count, const Lists<const S>& at) noexcept {
    if constexpr (std::same_as<S, float>) {
      if (at[0] == positions_.axis(0) + from) return;
    }
    positions_.set_row(from, count, at[0], at[1], at[2]);
  }
  /// All positions are set, and were those of face f.
  void finish_face(std::size_t f) noexcept { positions_.pack(f); }

  /// Writes the normals of face f that depend on no other face. Call it right after finish_face(f).
  template <Real T>
  PALPATE_FLATTEN void write_in_row(const FacePartition<S>& partition, std::size_t f,
                                    const VertexBuffer<T>& out) const noexcept {
    normals_.each_in_row(inside_[f], positions_, at_rest(partition, f), writer(partition, out));
  }
  /// Writes the other normals of the faces that moved, moved[f] != 0, and those of their neighbours in faces
  /// that did not.
  template <Real T>
  PALPATE_FLATTEN void write_apart(const FacePartition<S>& partition, std::span<const std::uint8_t> moved,
                                   const VertexBuffer<T>& out) const noexcept {
    for (std::size_t f = 0; f < moved.size(); ++f) {
      if (!moved[f]) continue;
      normals_.each_apart(inside_[f], positions_, at_rest(partition, f), writer(partition, out));
      for (std::size_t k = neighbours_start_[f]; k < neighbours_start_[f + 1]; ++k)
        if (!moved[neighbours_[k].face])
          normals_.each_apart(neighbours_[k].vertices, positions_, at_rest(partition, neighbours_[k].face),
                              writer(partition, out));
    }
  }

 private:
  struct Neighbours {  // vertices of another face next to this one
    std::uint32_t face;
    VertexNormals::Group vertices;
  };

  [[nodiscard]] static auto at_rest(const FacePartition<S>& partition, std::size_t f) noexcept {
    return [&partition, &face = partition.faces()[f]](std::size_t slot) {
      const auto normal = [&](int axis) {
        return static_cast<float>(partition.normal(face, axis)[slot - face.first]);
      };
      return Packed3{normal(0), normal(1), normal(2)};
    };
  }
  template <Real T>
  [[nodiscard]] static auto writer(const FacePartition<S>& partition, const VertexBuffer<T>& out) noexcept {
    return [to = detail::VertexWriter<T>(out.normals, out.normal_stride), order = partition.order().data()](
               const auto& slot, const auto& x, const auto& y, const auto& z) PALPATE_INLINE_LAMBDA {
      to.put_register([&](std::uint32_t k) { return order[slot(k)]; }, x, y, z);
    };
  }

  VertexNormals normals_;
  std::vector<VertexNormals::Group> inside_;  // by face
  std::vector<Neighbours> neighbours_;
  std::vector<std::size_t> neighbours_start_;
  VertexPositions positions_;  // of one face's slots after the other's, and packed
};

}  // namespace palpate
