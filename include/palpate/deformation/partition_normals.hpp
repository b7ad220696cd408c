// SPDX-License-Identifier: MIT
#pragma once

/// @file  Normals of a partition's vertices, face by face, of those that move.

#include <palpate/core/error.hpp>
#include <palpate/core/vertex_writer.hpp>
#include <palpate/deformation/concept.hpp>
#include <palpate/deformation/vertex_normals.hpp>
#include <palpate/interpolation/partition.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace palpate {

/// Unit normals of a FacePartition's vertices, by slot; one whose triangles have collapsed has the partition's own normal.
/// A face that moves changes the normals of its vertices and of their neighbours in other faces.
///
/// `place` a face's vertices, then `write_in_row` those that need no other face's, while its places are in the first cache;
/// `write_apart` the others when all faces that move are there.
template <Real S>
class PartitionNormals {
 public:
  /// No vertices.
  PartitionNormals() = default;
  /// `triangles`: of the mesh that the partition was made from. All vertices are at rest. Reports a mesh that is not closed.
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
    std::size_t longest = 0;
    for (const Face<S>& face : faces) {
      std::vector<std::uint32_t> inside(face.count);
      std::iota(inside.begin(), inside.end(), static_cast<std::uint32_t>(face.first));
      around.clear();
      for (const std::uint32_t slot : inside)
        for (const std::uint32_t other : rings[slot])
          if (face_of[other] != face_of[slot]) around.push_back({face_of[other], other});
      inside_.push_back(normals_.add(rings, inside, {face.first, face.count}));
      std::sort(around.begin(), around.end());
      around.erase(std::unique(around.begin(), around.end()), around.end());
      rim_start_.push_back(rim_.size());
      for (std::size_t k = 0; k < around.size();) {
        const std::uint32_t f = around[k][0];
        std::vector<std::uint32_t> slots;
        for (; k < around.size() && around[k][0] == f; ++k) slots.push_back(around[k][1]);
        rim_.push_back({f, normals_.add(rings, slots)});
      }
      longest = (std::max)(longest, face.count);
    }
    rim_start_.push_back(rim_.size());
    places_ = VertexPlaces(longest, normals_.packed_reads(order.size()));
    for (const Face<S>& face : faces) place_at_rest(partition, face);
  }

  /// Where `count` of a face's vertices are now, from slot `first` on [m].
  PALPATE_INLINE void place(const Face<S>& face, std::size_t first, std::size_t count, const S* x, const S* y,
                            const S* z) noexcept {
    places_.set_row(first - face.first, first, count, x, y, z);
  }
  PALPATE_INLINE void place_at_rest(const FacePartition<S>& partition, const Face<S>& face) noexcept {
    place(face, face.first, face.count, partition.rest(0) + face.first, partition.rest(1) + face.first,
          partition.rest(2) + face.first);
  }

  /// Of face f's vertices those that need no other face's, right after its vertices have been placed.
  template <Real T>
  PALPATE_FLATTEN void write_in_row(const FacePartition<S>& partition, std::size_t f,
                                    const VertexBuffer<T>& out) const noexcept {
    normals_.each_in_row(inside_[f], places_, at_rest(partition), writer(partition, out));
  }
  /// Of the faces that moved, moved[f] != 0, the others, and their neighbours in faces that did not.
  template <Real T>
  PALPATE_FLATTEN void write_apart(const FacePartition<S>& partition, std::span<const std::uint8_t> moved,
                                   const VertexBuffer<T>& out) const noexcept {
    for (std::size_t f = 0; f < moved.size(); ++f) {
      if (!moved[f]) continue;
      normals_.each_apart(inside_[f], places_, at_rest(partition), writer(partition, out));
      for (std::size_t k = rim_start_[f]; k < rim_start_[f + 1]; ++k)
        if (!moved[rim_[k].face])
          normals_.each_apart(rim_[k].vertices, places_, at_rest(partition), writer(partition, out));
    }
  }

 private:
  struct Rim {  // vertices of another face next to this one
    std::uint32_t face;
    VertexNormals::Group vertices;
  };

  [[nodiscard]] static auto at_rest(const FacePartition<S>& partition) noexcept {
    return [&partition](std::size_t slot) {
      const auto normal = [&](int axis) { return static_cast<float>(partition.normal(axis)[slot]); };
      return Packed3{normal(0), normal(1), normal(2)};
    };
  }
  template <Real T>
  [[nodiscard]] static auto writer(const FacePartition<S>& partition, const VertexBuffer<T>& out) noexcept {
    return [to = detail::VertexWriter<T>(out.normals, out.normal_stride), order = partition.order().data()](
               const auto& slot, const auto& x, const auto& y, const auto& z) {
      to.put_register([&](std::uint32_t k) { return order[slot(k)]; }, x, y, z);
    };
  }

  VertexNormals normals_;
  std::vector<VertexNormals::Group> inside_;  // by face
  std::vector<Rim> rim_;
  std::vector<std::size_t> rim_start_;
  VertexPlaces places_;  // of one face's slots after the other's, and packed
};

}  // namespace palpate
