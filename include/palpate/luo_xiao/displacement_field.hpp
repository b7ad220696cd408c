// SPDX-License-Identifier: MIT
#pragma once

/// @file Displacements of corners and contacts to vertices and normals in the caller's buffer (V.A.2, V.B,
/// VI).

#include <palpate/core/error.hpp>
#include <palpate/core/simd.hpp>
#include <palpate/display/vertex_writer.hpp>
#include <palpate/elasticity/concept.hpp>
#include <palpate/luo_xiao/detail/local_shape.hpp>
#include <palpate/luo_xiao/detail/partition_normals.hpp>
#include <palpate/luo_xiao/interpolation/blocks.hpp>
#include <palpate/luo_xiao/neighbourhood.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace palpate {

/// Sums the fields of all contacts over the display vertices (V.A.2, V.B, VI) and writes what changed.
///
/// | symbol | name               | unit | range                                                             |
/// |--------|--------------------|------|-------------------------------------------------------------------|
/// |        | `Params::contacts` | -    | >= 1: contacts drawn at once; more are left out and reported      |
/// |        | `Params::normals`  | -    | false: none are ever written, and the mesh need not be closed     |
///
/// Several contacts (VI): their fields are added, so a contact that appears with D = 0 and u_i = 0 changes
/// nothing. Motion is found face by face: a face is written again when one of its corners, or a contact that
/// splits it, differs in a bit from the last tick. Normals are written for its vertices and for their
/// neighbours in other faces. With the same input as in the last tick nothing is read or written at all.
///
/// Set-up sizes everything; write() uses no heap and has no state but the last tick's input. One buffer per
/// object: after a switch to another buffer call write_rest() on it first.
template <Interpolation I, Neighbourhood N = AreaNeighbourhood<typename I::Scalar>>
  requires std::same_as<typename I::Scalar, typename N::Scalar>
class DisplacementField {
 public:
  using Scalar = typename I::Scalar;
  using S = Scalar;
  using Blocks = BlocksOf<I>;

  struct Params {
    std::size_t contacts{4};
    bool normals{true};
  };

  /// `mesh` is the one that the interpolation's partition was made from.
  DisplacementField(Blocks interpolation, N neighbourhood, const MeshData<S>& mesh, const Params& params = {})
      : p_(params),
        interpolation_(std::move(interpolation)),
        neighbourhood_(std::move(neighbourhood)),
        local_(p_.contacts, mesh, interpolation_.partition()) {
    const FacePartition<S>& partition = interpolation_.partition();
    if (p_.contacts < 1) fail(name, "contacts must be >= 1", static_cast<double>(p_.contacts));
    if (mesh.vertices.size() != partition.size())
      fail(name, "mesh must be the partition's", static_cast<double>(mesh.vertices.size()));
    loads_.resize(p_.contacts);
    previous_.resize(p_.contacts);
    contacts_.reserve(p_.contacts);
    corners_.reserve(p_.contacts * partition.points().size());
    dirty_.assign(partition.faces().size(), 1);
    if (p_.normals) normals_ = PartitionNormals<S>(partition, mesh.triangles);
  }

  /// Fills the whole buffer with the undeformed shape. The next write() starts from it.
  template <Real T>
  void write_rest(const VertexBuffer<T>& out) noexcept {
    std::fill(previous_.begin(), previous_.end(), Load{});
    local_.reset();
    previous_count_ = 0;
    contacts_.clear();
    corners_.clear();
    std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{1});
    const FacePartition<S>& part = partition();
    const bool with_normals = p_.normals && out.normals != nullptr;
    for (std::size_t f = 0; f < dirty_.size(); ++f) {
      const Face<S>& face = part.faces()[f];
      put(face, 0, face.count, part.rest_from(face, 0), out);
      if (p_.normals) {
        normals_.set_positions(0, face.count, part.rest_from(face, 0));
        normals_.finish_face(f);
      }
      if (with_normals) normals_.write_in_row(part, f, out);
    }
    if (with_normals) normals_.write_apart(part, dirty_, out);
  }

  /// Writes the shape under `contacts`. `corners` holds the displacements u_i [m] that each contact causes at
  /// the partition's extremal points, contact by contact. A list of the wrong length: nothing is written.
  template <Real T>
  Moved<S> write(std::span<const ContactDisplacement<S>> contacts, std::span<const Vec3<S>> corners,
                 const VertexBuffer<T>& out) noexcept {
    Moved<S> moved;
    const std::size_t points = partition().points().size();
    if (corners.size() != contacts.size() * points || out.positions == nullptr) return moved;
    const std::size_t count = (std::min)(contacts.size(), p_.contacts);
    if (count < contacts.size()) moved.status |= Status::region_overflow;
    if (!take(contacts.first(count), corners.first(count * points))) return moved;

    const bool with_normals = p_.normals && out.normals != nullptr;
    Extent extent;
    for (std::size_t f = 0; f < dirty_.size(); ++f) {
      dirty_[f] = changed(f) ? 1 : 0;
      if (!dirty_[f]) continue;
      const Face<S>& face = partition().faces()[f];
      for (std::size_t from = 0; from < face.count; from += block_size)
        write_block(f, from, (std::min)(block_size, face.count - from), extent, out);
      if (p_.normals) normals_.finish_face(f);
      if (with_normals) normals_.write_in_row(partition(), f, out);
      moved.vertices += face.count;
    }
    if (moved.vertices > 0) {
      extent.write(moved);
      if (with_normals) normals_.write_apart(partition(), dirty_, out);
    }
    loads_.swap(previous_);
    local_.swap();
    previous_count_ = count;
    return moved;
  }

  [[nodiscard]] const FacePartition<S>& partition() const noexcept { return interpolation_.partition(); }
  [[nodiscard]] const Blocks& interpolation() const noexcept { return interpolation_; }
  [[nodiscard]] const Params& params() const noexcept { return p_; }

 private:
  using Load = typename Blocks::Load;

  using V = detail::simd_group<S>;

  struct Extent {  // of the written positions, entry by entry of V; 32 is the size of V with any vector flags
    using Entries = std::array<S, 32>;
    static_assert(V::size() <= std::tuple_size_v<Entries>);
    std::array<Entries, 3> lower, upper;
    Extent() noexcept {
      for (Entries& of : lower) of.fill((std::numeric_limits<S>::max)());
      for (Entries& of : upper) of.fill(std::numeric_limits<S>::lowest());
    }
    PALPATE_INLINE void take(const Lists<const S>& x, std::size_t count) noexcept {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        V low(lower[axis].data()), high(upper[axis].data());
        for (std::size_t i = 0; i < count; i += V::size()) {
          const V at(x[axis] + i);
          low = (detail::min)(low, at);
          high = (detail::max)(high, at);
        }
        low.copy_to(lower[axis].data());
        high.copy_to(upper[axis].data());
      }
    }
    void write(Moved<S>& moved) const noexcept {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        moved.lower[static_cast<int>(axis)] = *std::min_element(lower[axis].begin(), lower[axis].end());
        moved.upper[static_cast<int>(axis)] = *std::max_element(upper[axis].begin(), upper[axis].end());
      }
    }
  };

  // Takes the input; false when it is the same as in the last tick.
  bool take(std::span<const ContactDisplacement<S>> contacts, std::span<const Vec3<S>> corners) noexcept {
    if (std::equal(contacts.begin(), contacts.end(), contacts_.begin(), contacts_.end()) &&
        std::equal(corners.begin(), corners.end(), corners_.begin(), corners_.end()))
      return false;
    contacts_.assign(contacts.begin(), contacts.end());  // within the capacity reserved at set-up
    corners_.assign(corners.begin(), corners.end());
    const std::size_t points = partition().points().size();
    for (std::size_t c = 0; c < p_.contacts; ++c) {
      loads_[c].active = false;
      local_.leave_out(c);
      if (c >= contacts.size()) continue;
      ContactDisplacement<S> contact = contacts[c];
      const auto bounded =
          local_.prepare(c, neighbourhood_, partition(), contact, corners.subspan(c * points, points));
      interpolation_.prepare(bounded, contact, loads_[c]);
    }
    active_ = contacts.size();
    return true;
  }

  [[nodiscard]] bool changed(std::size_t f) const noexcept {
    const Face<S>& face = partition().faces()[f];
    for (std::size_t c = 0; c < (std::max)(active_, previous_count_); ++c) {
      if (!interpolation_.same(previous_[c], loads_[c], f) || local_.changed(c, face)) return true;
    }
    return false;
  }

  // Writes the positions `x` of `count` vertices of a face, from its slot number `from` on.
  template <Real T>
  PALPATE_INLINE void put(const Face<S>& face, std::size_t from, std::size_t count, const Lists<const S>& x,
                          const VertexBuffer<T>& out) const noexcept {
    const std::size_t slot = face.first + from;
    detail::VertexWriter<T>(out.positions, out.position_stride)
        .put_runs(count, partition().order().data() + slot, partition().runs().data() + slot, x[0], x[1],
                  x[2]);
  }

  template <Real T>
  PALPATE_FLATTEN void write_block(std::size_t f, std::size_t from, std::size_t count, Extent& extent,
                                   const VertexBuffer<T>& out) noexcept {
    const Face<S>& face = partition().faces()[f];
    const Lists<const S> rest = partition().rest_from(face, from);
    Block<S> moved[3];
    Lists<S> to{moved[0].value, moved[1].value, moved[2].value};
    if constexpr (std::same_as<S, float>) {
      if (p_.normals) to = normals_.positions_from(from);
    }
    const Lists<const S> there{to[0], to[1], to[2]};
    bool is_moved = false;
    for (std::size_t c = 0; c < active_; ++c) {
      if (!interpolation_.moves(loads_[c], f)) continue;
      interpolation_.add(loads_[c], f, from, count, is_moved ? there : rest, to);
      is_moved = true;
    }
    if constexpr (N::active) {
      for (std::size_t c = 0; c < active_; ++c) {
        if (!local_.touches(c, f, from)) continue;
        if (!is_moved) copy(rest, count, to);
        local_.apply(c, rest, count, to);
        is_moved = true;
      }
    }
    const Lists<const S>& at = is_moved ? there : rest;
    extent.take(at, count);
    put(face, from, count, at, out);
    if (p_.normals) normals_.set_positions(from, count, at);
  }

  static void copy(const Lists<const S>& from, std::size_t count, const Lists<S>& to) noexcept {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t i = 0; i < count; i += V::size()) V(from[axis] + i).copy_to(to[axis] + i);
    }
  }

  static constexpr const char* name = "DisplacementField";

  Params p_;
  Blocks interpolation_;
  PALPATE_NO_UNIQUE_ADDRESS N neighbourhood_;
  PALPATE_NO_UNIQUE_ADDRESS detail::LocalShapes<N> local_;
  PartitionNormals<S> normals_;
  std::vector<Load> loads_, previous_;
  std::vector<ContactDisplacement<S>> contacts_;
  std::vector<Vec3<S>> corners_;
  std::vector<std::uint8_t> dirty_;
  std::size_t active_ = 0, previous_count_ = 0;
};

template <BlockInterpolation I, Neighbourhood N>
DisplacementField(I, N, const MeshData<typename I::Scalar>&) -> DisplacementField<I, N>;
template <BlockInterpolation I, Neighbourhood N>
DisplacementField(I, N, const MeshData<typename I::Scalar>&, const typename DisplacementField<I, N>::Params&)
    -> DisplacementField<I, N>;

}  // namespace palpate
