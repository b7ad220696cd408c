// SPDX-License-Identifier: MIT
#pragma once

/// @file  Area-weighted vertex normals of a closed mesh whose vertices move.

#include <palpate/core/error.hpp>
#include <palpate/interpolation/concept.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// The ring of neighbours p_0 .. p_{m-1} of every vertex, counter-clockwise from outside. The area vectors of a
/// vertex's triangles sum to that of its ring, a closed polygon, in which the vertex itself cancels. Cut into
/// quadrilaterals from o = p_{m-1} it is (m even; otherwise p_{m-1} counts twice)
///
///     2 A = sum_{j < m/2 - 1} (p_{2j+1} - o) x (p_{2j+2} - p_{2j})
///
/// two cross products for six neighbours instead of six, and every product is of short vectors. No equation of the
/// paper; elementary geometry.
///
/// Up to `lanes` neighbouring vertices whose rings are the same but for a shift by one are a run, and one
/// calculation without gathering. In a mesh laid out in rows, as all meshes of this library are, most vertices are
/// in full runs.
///
/// Set-up reports a mesh whose triangles do not close around every vertex.
template <Real S>
class VertexNormals {
 public:
  static constexpr std::size_t lanes = detail::lanes<S>;
  /// So many entries past the last vertex's coordinates are read, and not used.
  static constexpr std::size_t padding = lanes;

  struct Run {
    std::uint32_t first = 0, count = 0;  ///< vertices, up to `lanes`
    std::uint32_t ring = 0, size = 0;    ///< of the first one: where its neighbours are listed, and how many
  };

  VertexNormals() = default;

  /// No run goes on past a vertex of `starts`, which is in ascending order.
  VertexNormals(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices,
                std::span<const std::size_t> starts = {}) {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> sides(vertices);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        if (a >= vertices) fail_at(name, "vertex does not exist", "triangle", t, static_cast<double>(a));
        sides[a].push_back({b, c});
      }
    }
    std::vector<std::uint32_t> ring;
    for (std::size_t v = 0; v < vertices; ++v) {
      ring_of(sides[v], v, ring);
      if (!std::binary_search(starts.begin(), starts.end(), v) && goes_on(ring)) {
        ++runs_.back().count;
      } else {
        runs_.push_back({static_cast<std::uint32_t>(v), 1, static_cast<std::uint32_t>(rings_.size()),
                         static_cast<std::uint32_t>(ring.size())});
        rings_.insert(rings_.end(), ring.begin(), ring.end());
      }
    }
  }

  /// All runs, in the vertices' order.
  [[nodiscard]] std::span<const Run> runs() const noexcept { return runs_; }
  /// Neighbours of a run's first vertex; those of the next one are one further each.
  [[nodiscard]] std::span<const std::uint32_t> ring(const Run& run) const noexcept {
    return {rings_.data() + run.ring, run.size};
  }

  /// Twice the area vectors of the rings of `lanes` vertices from number `offset` of the run on; their directions are the
  /// normals. Past the run's end they mean nothing. `x`, `y`, `z`: the vertices' coordinates.
  void area(const Run& run, std::size_t offset, const S* x, const S* y, const S* z, S* out_x, S* out_y,
            S* out_z) const noexcept {
    using detail::load_lanes;
    using Lanes = detail::Lanes<S>;
    const std::uint32_t* const r = rings_.data() + run.ring;
    x += offset, y += offset, z += offset;
    const std::uint32_t last = r[run.size - 1];
    const Lanes ox = load_lanes(x + last), oy = load_lanes(y + last), oz = load_lanes(z + last);
    Lanes px = load_lanes(x + r[0]), py = load_lanes(y + r[0]), pz = load_lanes(z + r[0]);
    Lanes sx = Lanes::Zero(), sy = Lanes::Zero(), sz = Lanes::Zero();
    const auto pair = [&](std::size_t j) {
      const std::uint32_t q = r[j + 1], s = r[j + 2];
      const Lanes nx = load_lanes(x + s), ny = load_lanes(y + s), nz = load_lanes(z + s);
      const Lanes ax = load_lanes(x + q) - ox, ay = load_lanes(y + q) - oy, az = load_lanes(z + q) - oz,
                  bx = nx - px, by = ny - py, bz = nz - pz;
      sx += ay * bz - az * by;
      sy += az * bx - ax * bz;
      sz += ax * by - ay * bx;
      px = nx, py = ny, pz = nz;
    };
    pair(0);
    if (run.size == 6) {  // as nearly all are
      pair(2);
    } else {
      for (std::size_t j = 2; j + 2 < run.size; j += 2) pair(j);
    }
    detail::store_lanes(out_x, sx);
    detail::store_lanes(out_y, sy);
    detail::store_lanes(out_z, sz);
  }

  /// Unit normals in the making, a block of vertices at a time. `x`, `y`, `z`: the vertices' coordinates; rest(axis, vertex):
  /// component of the normal of a vertex whose ring has collapsed; emit(vertex, x, y, z) takes the results.
  template <class Rest, class Emit>
  class Units {
   public:
    Units(const VertexNormals& normals, const S* x, const S* y, const S* z, const Rest& rest,
          const Emit& emit) noexcept
        : normals_(normals), x_(x), y_(y), z_(z), rest_(rest), emit_(emit) {}

    /// `count` vertices from number `offset` of the run on.
    PALPATE_INLINE void add(const Run& run, std::uint32_t offset, std::size_t count) noexcept {
      if (filled_ + lanes > block_size) flush();
      normals_.area(run, offset, x_, y_, z_, nx_.value + filled_, ny_.value + filled_, nz_.value + filled_);
      for (std::uint32_t i = 0; i < lanes; ++i) vertex_[filled_ + i] = run.first + offset + i;
      filled_ += count;
    }
    /// Emits what has been added.
    void flush() noexcept {
      constexpr S tiny = (std::numeric_limits<S>::min)();
      Block<S> square;
      for (std::size_t i = 0; i < block_size; ++i)
        square[i] = nx_[i] * nx_[i] + ny_[i] * ny_[i] + nz_[i] * nz_[i];
      for (std::size_t i = 0; i < block_size; ++i) {
        const S scale = detail::inverse_root(square[i]);
        nx_[i] *= scale;
        ny_[i] *= scale;
        nz_[i] *= scale;
      }
      for (std::size_t i = filled_; i < block_size; ++i) square[i] = S(1);
      const bool collapsed = detail::least(square) <= tiny;
      for (std::size_t i = 0; collapsed && i < filled_; ++i) {
        if (square[i] > tiny) continue;
        nx_[i] = rest_(0, vertex_[i]);
        ny_[i] = rest_(1, vertex_[i]);
        nz_[i] = rest_(2, vertex_[i]);
      }
      // In registers: what emit writes might be any of these otherwise.
      const Emit emit = emit_;
      const std::size_t filled = filled_;
      for (std::size_t i = 0; i < filled; ++i) emit(vertex_[i], nx_[i], ny_[i], nz_[i]);
      filled_ = 0;
    }

   private:
    const VertexNormals& normals_;
    const S *x_, *y_, *z_;
    const Rest& rest_;
    const Emit& emit_;
    Block<S> nx_{}, ny_{}, nz_{};
    std::array<std::uint32_t, block_size> vertex_{};
    std::size_t filled_ = 0;
  };

  /// emit(vertex, x, y, z) with every vertex's unit normal; one whose ring has collapsed has `rest`, its three lists of
  /// components.
  template <class Emit>
  PALPATE_FLATTEN void each_unit(const S* x, const S* y, const S* z,
                                 const std::array<std::vector<S>, 3>& rest, const Emit& emit) const noexcept {
    const auto at_rest = [&rest](std::size_t axis, std::size_t v) { return rest[axis][v]; };
    Units<decltype(at_rest), Emit> units(*this, x, y, z, at_rest, emit);
    for (const Run& run : runs_) units.add(run, 0, run.count);
    units.flush();
  }

 private:
  static constexpr const char* name = "VertexNormals";

  // The neighbours of vertex v in order, lowest first, so that shifted rings begin alike; an even number of them.
  static void ring_of(std::span<const std::array<std::uint32_t, 2>> open, std::size_t v,
                      std::vector<std::uint32_t>& ring) {
    const auto fan = [v] { fail_at(name, "triangles must close around it", "mesh vertex", v); };
    ring.clear();
    if (open.size() < 3) fan();
    std::uint32_t at = open[0][0];
    for (std::size_t k = 0; k < open.size(); ++k) {
      ring.push_back(at);
      std::size_t found = open.size();
      for (std::size_t j = 0; j < open.size(); ++j) {
        if (open[j][0] != at) continue;
        if (found != open.size()) fan();
        found = j;
      }
      if (found == open.size()) fan();
      at = open[found][1];
      if (at == open[0][0] && k + 1 < open.size()) fan();
    }
    if (at != open[0][0]) fan();
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    if (ring.size() % 2 != 0) ring.push_back(ring.back());
  }

  [[nodiscard]] bool goes_on(std::span<const std::uint32_t> next) const noexcept {
    if (runs_.empty() || runs_.back().count == lanes || next.size() != runs_.back().size) return false;
    for (std::size_t k = 0; k < next.size(); ++k) {
      if (next[k] != rings_[runs_.back().ring + k] + runs_.back().count) return false;
    }
    return true;
  }

  std::vector<Run> runs_;
  std::vector<std::uint32_t> rings_;
};

}  // namespace palpate
