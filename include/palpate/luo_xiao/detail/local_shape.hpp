// SPDX-License-Identifier: MIT
#pragma once

/// @file  The local neighbourhoods of all contacts (V.B) on a block of vertices: formulas in
/// luo_xiao/neighbourhood.hpp.

#include <palpate/core/simd.hpp>
#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/neighbourhood.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate::detail {

/// One contact's neighbourhood. Form `F`.
template <Real S, NeighbourhoodForm F>
struct LocalShape {
  Vec3<S> position = Vec3<S>::Zero(), normal = Vec3<S>::UnitY();
  Vec3<S> target = Vec3<S>::Zero();  ///< D' [m]
  S depth = 0;                       ///< delta [m]; printed: 0, as D' and a
  S flat = 0;                        ///< a [m]
  S radius = 0;                      ///< R [m]; 0: nothing to do
  S reduced = 0;                     ///< printed: 1 - w

  /// Does it move anything in this ball [m]?
  [[nodiscard]] bool touches(const Vec3<S>& centre, S ball) const noexcept {
    const S reach = radius + depth + ball;
    return radius > S(0) && (position - centre).squaredNorm() < reach * reach;
  }

  /// Moves positions `x` of `count` vertices, `rest` without deformation [m]: whole `simd_group`s.
  PALPATE_INLINE void apply(const Lists<const S>& rest, std::size_t count, const Lists<S>& x) const noexcept {
    using V = simd_group<S>;
    const S inner = flat * flat, outer = radius * radius, per_square = S(1) / (outer - inner),
            tiny = (std::numeric_limits<S>::min)();
    const S p[3] = {position.x(), position.y(), position.z()}, n[3] = {normal.x(), normal.y(), normal.z()},
            to[3] = {target.x(), target.y(), target.z()}, full = depth;
    for (std::size_t i = 0; i < count; i += V::size()) {
      const V v[3] = {V(rest[0] + i), V(rest[1] + i), V(rest[2] + i)};
      const V d[3] = {v[0] - p[0], v[1] - p[1], v[2] - p[2]};
      V square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], below{};
      if constexpr (F == NeighbourhoodForm::tool_face) {
        const V above = n[0] * d[0] + n[1] * d[1] + n[2] * d[2], far = (max)(above - full, S(0));
        square = square - above * above + far * far;
        below = (max)(V{} - above, S(0));
        if (!any_of(below < V(full))) continue;
      }
      if (!any_of(square < V(outer))) continue;
      const V at[3] = {V(x[0] + i), V(x[1] + i), V(x[2] + i)};
      if constexpr (F == NeighbourhoodForm::tool_face) {
        const V t = (min)((max)((square - inner) * per_square, S(0)), S(1));
        const V b = S(1) - t * t * t * (S(10) - t * (S(15) - S(6) * t));
        const V left = full + n[0] * (at[0] - v[0]) + n[1] * (at[1] - v[1]) + n[2] * (at[2] - v[2]);
        const V part = b * ((max)(left - below, S(0)) / (max)(left, tiny));
        for (std::size_t k = 0; k < 3; ++k) (at[k] + part * (v[k] + to[k] - at[k])).copy_to(x[k] + i);
      } else {
        const V inside = (max)(S(1) - square * per_square, S(0)), part = reduced * inside * inside;
        for (std::size_t k = 0; k < 3; ++k) (at[k] + part * (v[k] - at[k])).copy_to(x[k] + i);
      }
    }
  }

  [[nodiscard]] bool operator==(const LocalShape&) const noexcept = default;
};

/// All contacts' neighbourhoods, of this tick and of the last one. Nothing where N is absent.
template <class N>
class LocalShapes {
 public:
  using S = typename N::Scalar;

  LocalShapes(std::size_t, const MeshData<S>&, const FacePartition<S>&) noexcept {}
  void reset() noexcept {}
  void swap() noexcept {}
  void leave_out(std::size_t) noexcept {}
  std::span<const Vec3<S>> prepare(std::size_t, const N&, const FacePartition<S>&, ContactDisplacement<S>&,
                                   std::span<const Vec3<S>> corners) noexcept {
    return corners;
  }
  [[nodiscard]] bool touches(std::size_t, std::size_t, std::size_t) const noexcept { return false; }
  [[nodiscard]] bool changed(std::size_t, const Face<S>&) const noexcept { return false; }
  PALPATE_INLINE void apply(std::size_t, const Lists<const S>&, std::size_t, const Lists<S>&) const noexcept {
  }
};

template <Neighbourhood N>
  requires(N::active)
class LocalShapes<N> {
 public:
  using S = typename N::Scalar;
  static constexpr NeighbourhoodForm form = N::form;

  LocalShapes(std::size_t contacts, const MeshData<S>& mesh, const FacePartition<S>& partition)
      : now_(contacts), before_(contacts), margin_(mean_edge(mesh) / S(2)) {
    for (const Face<S>& face : partition.faces()) {
      first_block_.push_back(blocks_.size());
      for (std::size_t from = 0; from < face.count; from += block_size) {
        const Lists<const S> rest = partition.rest_from(face, from);
        const std::size_t count = (std::min)(block_size, face.count - from);
        const auto at = [&rest](std::size_t i) { return Vec3<S>(rest[0][i], rest[1][i], rest[2][i]); };
        Ball ball;
        for (std::size_t i = 0; i < count; ++i) ball.centre += at(i) / static_cast<S>(count);
        for (std::size_t i = 0; i < count; ++i)
          ball.radius = (std::max)(ball.radius, (at(i) - ball.centre).norm());
        blocks_.push_back(ball);
      }
    }
  }

  void reset() noexcept { std::fill(before_.begin(), before_.end(), Shape{}); }
  void swap() noexcept { now_.swap(before_); }
  void leave_out(std::size_t c) noexcept { now_[c] = Shape{}; }

  /// Contact c as the interpolation gets it, and the corners' displacements [m]; bad input stays what it is.
  std::span<const Vec3<S>> prepare(std::size_t c, const N& neighbourhood, const FacePartition<S>& partition,
                                   ContactDisplacement<S>& contact,
                                   std::span<const Vec3<S>> corners) noexcept {
    leave_out(c);
    if (!is_drawable(contact)) return corners;
    const S w = (std::min)(neighbourhood.factor(contact), S(1)), radius = neighbourhood.radius(contact);
    if (!(w > S(0))) return corners;
    Shape shape{};
    shape.position = contact.position;
    shape.normal = contact.normal;
    shape.radius = is_finite(radius) ? radius : S(0);
    if constexpr (form == NeighbourhoodForm::printed) {
      shape.reduced = S(1) - w;
      if (w < S(1)) now_[c] = shape;
      return corners;
    } else {
      const S D_n = -contact.normal.dot(contact.displacement);
      shape.depth = (std::max)(contact.depth, D_n);
      shape.target = contact.displacement - (shape.depth - D_n) * contact.normal;
      shape.flat = region_radius(contact.area) + (contact.area > S(0) ? margin_ : S(0));
      shape.radius = (std::max)(shape.radius, min_rim * shape.flat);
      if (shape.depth > S(0) && (shape.flat > S(0) || w < S(1))) now_[c] = shape;
      contact.displacement *= w;
      return bounded(partition, contact, corners, (std::max)(shape.flat, shape.depth));
    }
  }
  /// Does it move anything in the block of face f that begins at its slot number `from`?
  [[nodiscard]] bool touches(std::size_t c, std::size_t f, std::size_t from) const noexcept {
    const Ball& block = blocks_[first_block_[f] + from / block_size];
    return now_[c].touches(block.centre, block.radius);
  }
  [[nodiscard]] bool changed(std::size_t c, const Face<S>& face) const noexcept {
    return now_[c] != before_[c] &&
           (now_[c].touches(face.centre, face.radius) || before_[c].touches(face.centre, face.radius));
  }
  PALPATE_INLINE void apply(std::size_t c, const Lists<const S>& rest, std::size_t count,
                            const Lists<S>& x) const noexcept {
    now_[c].apply(rest, count, x);
  }

 private:
  using Shape = LocalShape<S, form>;
  struct Ball {  // around the vertices of a block [m]
    Vec3<S> centre = Vec3<S>::Zero();
    S radius = 0;
  };

  /// R is at least this part of a. Chosen: beyond it the wall around the contact would be as steep as a
  /// step to the eye.
  static constexpr S min_rim = S(1.5);

  static S mean_edge(const MeshData<S>& mesh) {
    double sum = 0, count = 0;
    for (const auto& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        if (a >= mesh.vertices.size() || b >= mesh.vertices.size()) continue;  // reported with the normals
        sum += static_cast<double>((mesh.vertices[a] - mesh.vertices[b]).norm());
        ++count;
      }
    }
    return count > 0 ? static_cast<S>(sum / count) : S(0);
  }

  // The corners' displacements, none larger than w |D| a/l at the distance l from the contact. A point is
  // taken as wide as it is deep.
  std::span<const Vec3<S>> bounded(const FacePartition<S>& partition, const ContactDisplacement<S>& contact,
                                   std::span<const Vec3<S>> corners, S width) noexcept {
    const std::size_t count = (std::min)(corners.size(), partition.points().size());
    const S most = contact.displacement.norm();
    for (std::size_t i = 0; i < count; ++i) {
      corners_[i] = corners[i];
      if (!is_drawable(corners[i])) continue;
      const S size = corners[i].norm(), distance = (partition.points()[i].position - contact.position).norm();
      const S limit = most * (distance > width ? width / distance : S(1));
      if (size > limit) corners_[i] *= limit / size;
    }
    return {corners_.data(), count};
  }

  std::vector<Shape> now_, before_;
  std::vector<Ball> blocks_;
  std::vector<std::size_t> first_block_;  // by face
  /// Half a mean edge of the display mesh [m]: a is so much wider, because triangles across the tool's rim
  /// would cut through it.
  S margin_;
  std::array<Vec3<S>, max_extremal_points> corners_;
};

}  // namespace palpate::detail
