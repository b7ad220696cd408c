// SPDX-License-Identifier: MIT
#pragma once

/// @file  Area-weighted vertex normals of a closed mesh whose vertices move.

#include <palpate/core/error.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/display/vertex_positions.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace palpate {

/// The ring of neighbours p_0 .. p_{m-1} of every vertex of a closed mesh, counter-clockwise seen from
/// outside. It begins with the lowest number, and is made even by the last neighbour twice. Set-up only.
/// Reports a mesh whose triangles do not close around every vertex.
class VertexRings {
 public:
  VertexRings(std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t vertices) {
    std::vector<std::vector<std::array<std::uint32_t, 2>>> sides(vertices);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3], c = triangles[t][(k + 2) % 3];
        if (a >= vertices) fail_at(name, "vertex does not exist", "triangle", t, static_cast<double>(a));
        sides[a].push_back({b, c});
      }
    }
    begin_.reserve(vertices + 1);
    for (std::size_t v = 0; v < vertices; ++v) {
      begin_.push_back(rings_.size());
      add(sides[v], v);
    }
    begin_.push_back(rings_.size());
  }

  [[nodiscard]] std::size_t size() const noexcept { return begin_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t v) const noexcept {
    return {rings_.data() + begin_[v], begin_[v + 1] - begin_[v]};
  }

 private:
  static constexpr const char* name = "VertexNormals";

  // `open`: of each triangle around vertex v the other two vertices.
  void add(std::span<const std::array<std::uint32_t, 2>> open, std::size_t v) {
    const auto fan = [v] { fail_at(name, "triangles must close around it", "mesh vertex", v); };
    if (open.size() < 3) fan();
    std::uint32_t at = open[0][0];
    for (std::size_t k = 0; k < open.size(); ++k) {
      rings_.push_back(at);
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
    const auto begin = rings_.end() - static_cast<std::ptrdiff_t>(open.size());
    std::rotate(begin, std::min_element(begin, rings_.end()), rings_.end());
    if (open.size() % 2 != 0) rings_.push_back(rings_.back());
  }

  std::vector<std::uint32_t> rings_;
  std::vector<std::size_t> begin_;
};

/// The area vectors of a vertex's triangles sum to that of its ring, a closed polygon. The vertex itself
/// cancels. The polygon is cut into quadrilaterals from o = p_{m-1}:
///
///     2 A = sum_{j < m/2 - 1} (p_{2j+1} - o) x (p_{2j+2} - p_{2j})
///
/// That is two cross products for six neighbours instead of six, all of short vectors. No equation of the
/// paper; elementary geometry.
///
/// In float, whatever the scalar: a position 0.1 m from the origin is known to 4 nm, and a normal between
/// edges of 1 mm to 1e-5 rad; no display shows more.
///
/// Eight or more consecutive vertices whose rings are equal but for a shift of all numbers by one, within one
/// run of positions, are worked out together, coordinate by coordinate: most of a mesh laid out in rows. The
/// others are gathered by fours with rings of one size, wherever they lie.
class VertexNormals {
 public:
  /// Vertices that are done together.
  struct Group {
    std::uint32_t row_begin = 0, row_end = 0, four_begin = 0, four_end = 0;
  };

  VertexNormals() = default;
  /// One group of all vertices, `all()`.
  explicit VertexNormals(const VertexRings& rings) {
    std::vector<std::uint32_t> vertices(rings.size());
    std::iota(vertices.begin(), vertices.end(), 0u);
    add(rings, vertices, {0, rings.size()});
  }
  /// Makes a group of vertices, in ascending order, ready. Set-up only. `run`: the one that is in
  /// VertexPositions when the group's turn comes. Without a run only packed positions are read.
  Group add(const VertexRings& rings, const std::vector<std::uint32_t>& vertices, const VertexRun& run = {}) {
    const Group before = all();
    std::vector<std::uint32_t> others;
    for (std::size_t i = 0; i < vertices.size();) {
      const std::size_t count = row_from(rings, std::span(vertices).subspan(i), run);
      if (count >= min_in_row) {
        const std::uint32_t v = vertices[i];
        rows_.push_back(
            {v, static_cast<std::uint32_t>(count), list(rings[v], 1, run.first), size_of(rings[v])});
        i += count;
      } else {
        others.push_back(vertices[i++]);
      }
    }
    std::stable_sort(others.begin(), others.end(),
                     [&rings](auto l, auto r) { return rings[l].size() < rings[r].size(); });
    for (std::size_t i = 0; i < others.size(); ++i) {
      Gathered four{{}, static_cast<std::uint32_t>(rings_.size()), size_of(rings[others[i]])};
      for (std::uint32_t& v : four.vertex) {
        v = others[i];  // the last of its size as often as it takes
        list(rings[v], floats, 0);
        if (&v != &four.vertex[3] && i + 1 < others.size() && rings[others[i + 1]].size() == four.size) ++i;
      }
      fours_.push_back(four);
    }
    const Group after = all();
    return {before.row_end, after.row_end, before.four_end, after.four_end};
  }
  /// True if coordinates are read, not only packed positions.
  [[nodiscard]] bool has_rows() const noexcept { return !rows_.empty(); }
  /// All groups.
  [[nodiscard]] Group all() const noexcept {
    return {0, static_cast<std::uint32_t>(rows_.size()), 0, static_cast<std::uint32_t>(fours_.size())};
  }

  /// For each of the mesh's vertices, 1 if a group reads its packed position.
  [[nodiscard]] std::vector<std::uint8_t> packed_reads(std::size_t vertices) const {
    std::vector<std::uint8_t> reads(vertices);
    for (const Gathered& four : fours_) {
      for (std::uint32_t i = four.ring; i < four.ring + 4 * four.size; ++i) reads[rings_[i] / floats] = 1;
    }
    return reads;
  }

  /// Calls emit(vertex, x, y, z) until all vertices of the group have their unit normals. x, y, z are Simd
  /// with those of the vertices number vertex(0), vertex(1) .., ascending where they are more than four. A
  /// vertex may come more than once. One whose ring has collapsed gets the normal rest(vertex).
  template <class Rest, class Emit>
  void each_unit(const Group& group, const VertexPositions& positions, const Rest& rest,
                 const Emit& emit) const noexcept {
    each<true>(group, positions, rest, emit);
    each<false>(group, positions, rest, emit);
  }
  /// The same for those of a group that are read coordinate by coordinate. Only its run needs to be there.
  template <class Rest, class Emit>
  void each_in_row(const Group& group, const VertexPositions& positions, const Rest& rest,
                   const Emit& emit) const noexcept {
    each<true>(group, positions, rest, emit);
  }
  /// The same for the others. All packed positions must be there.
  template <class Rest, class Emit>
  void each_apart(const Group& group, const VertexPositions& positions, const Rest& rest,
                  const Emit& emit) const noexcept {
    each<false>(group, positions, rest, emit);
  }

 private:
  struct Row {  // consecutive vertices
    std::uint32_t vertex, count;
    std::uint32_t ring, size;  // where the first one's neighbours, by number in the run, are listed
  };
  struct Gathered {  // four vertices from anywhere
    std::array<std::uint32_t, 4> vertex;
    std::uint32_t ring, size;  // where the first one's neighbours' positions are listed; the others follow
  };
  static constexpr float collapsed = (std::numeric_limits<float>::min)();  // square of an area
  static constexpr std::uint32_t min_in_row = 8, floats = sizeof(Packed3) / sizeof(float);

  [[nodiscard]] static std::uint32_t size_of(std::span<const std::uint32_t> ring) {
    return static_cast<std::uint32_t>(ring.size());
  }
  std::uint32_t list(std::span<const std::uint32_t> ring, std::uint32_t unit, std::size_t from) {
    const auto begin = static_cast<std::uint32_t>(rings_.size());
    for (const std::uint32_t neighbour : ring)
      rings_.push_back(unit * (neighbour - static_cast<std::uint32_t>(from)));
    return begin;
  }
  // How many vertices from the first one on have its ring but for a shift of one each, all of it in the run.
  [[nodiscard]] static std::size_t row_from(const VertexRings& rings, std::span<const std::uint32_t> vertices,
                                            const VertexRun& run) {
    const auto first = rings[vertices[0]];
    const auto [lowest, highest] = std::minmax_element(first.begin(), first.end());
    if (*lowest < run.first) return 0;
    std::uint32_t k = 0;
    for (; k < vertices.size() && *highest + k < run.first + run.count; ++k) {
      const auto next = rings[vertices[k]];
      if (vertices[k] != vertices[0] + k ||
          !std::equal(first.begin(), first.end(), next.begin(), next.end(),
                      [k](std::uint32_t a, std::uint32_t b) { return a + k == b; }))
        break;
    }
    return k;
  }

  // 2 A in the order z, x, y.
  [[nodiscard]] static PALPATE_INLINE detail::Simd4 area(const float* p, const std::uint32_t* ring,
                                                         std::uint32_t size) noexcept {
    using detail::Simd4, detail::load, detail::rotated;
    const Simd4 o = load<Simd4>(p + ring[size - 1]);
    Simd4 here = load<Simd4>(p + ring[0]), sum{};
    for (std::uint32_t j = 0; j + 2 < size; j += 2) {
      const Simd4 next = load<Simd4>(p + ring[j + 2]), a = load<Simd4>(p + ring[j + 1]) - o, b = next - here;
      const Simd4 first = a * rotated(b), second = rotated(a) * b;  // the order that fma instructions keep
      sum += first - second;
      here = next;
    }
    return sum;
  }
  // 2 A of consecutive vertices, one per entry of V.
  template <class V>
  static PALPATE_INLINE void area(const float* px, const float* py, const float* pz,
                                  const std::uint32_t* ring, std::uint32_t size, V& x, V& y, V& z) noexcept {
    const auto read = [](const float* from) { return detail::load<V>(from); };
    const std::uint32_t last = ring[size - 1], first = ring[0];
    const V ox = read(px + last), oy = read(py + last), oz = read(pz + last);
    V hx = read(px + first), hy = read(py + first), hz = read(pz + first);
    V sx{}, sy{}, sz{};
    for (std::uint32_t j = 0; j + 2 < size; j += 2) {
      const std::uint32_t q = ring[j + 1], s = ring[j + 2];
      const V nx = read(px + s), ny = read(py + s), nz = read(pz + s);
      const V ax = read(px + q) - ox, ay = read(py + q) - oy, az = read(pz + q) - oz;
      const V bx = nx - hx, by = ny - hy, bz = nz - hz;
      const V yz = ay * bz, zy = az * by, zx = az * bx, xz = ax * bz, xy = ax * by, yx = ay * bx;
      sx += yz - zy;
      sy += zx - xz;
      sz += xy - yx;
      hx = nx, hy = ny, hz = nz;
    }
    x = sx, y = sy, z = sz;
  }

  // Divides by the lengths, and returns their squares.
  template <class V>
  static PALPATE_INLINE V normalise(V& x, V& y, V& z) noexcept {
    const V xx = x * x, yy = y * y, zz = z * z, square = xx + yy + zz, scale = detail::inverse_sqrt(square);
    x *= scale, y *= scale, z *= scale;
    return square;
  }
  template <bool InRow, class Rest, class Emit>
  PALPATE_FLATTEN void each(const Group& group, const VertexPositions& positions, const Rest& rest,
                            const Emit& emit) const noexcept {
    constexpr float much = (std::numeric_limits<float>::max)();
    detail::Simd4 min_square = much;  // of an area
    const Emit put = emit;            // a copy: its members stay in registers while it writes
    each_area<InRow>(group, positions, [&](const auto& vertex, auto& x, auto& y, auto& z) {
      const auto square = normalise(x, y, z);
      detail::for_each_chunk<4>(square, [&](auto, const detail::Simd4& part) PALPATE_INLINE_LAMBDA {
        min_square = (detail::min)(part, min_square);
      });
      put(vertex, x, y, z);
    });
    if (detail::reduce_min(min_square) > collapsed) return;
    each_area<InRow>(group, positions, [&](const auto& vertex, auto& x, auto& y, auto& z) {
      const auto square = normalise(x, y, z);
      bool any = false;
      for (std::uint32_t k = 0; k < x.size(); ++k) {
        if (square[k] > collapsed) continue;
        const Packed3 normal = rest(vertex(k));
        x.set(k, normal.x), y.set(k, normal.y), z.set(k, normal.z);
        any = true;
      }
      if (any) emit(vertex, x, y, z);
    });
  }

  template <class Sum>
  static PALPATE_INLINE void with_size(std::uint32_t size, const Sum& sum) noexcept {
    if (size == 6)  // as nearly all are
      sum(std::integral_constant<std::uint32_t, 6>{});
    else
      sum(size);
  }
  // work(vertex, x, y, z) with 2 A of the vertices vertex(0), vertex(1) ..
  template <bool InRow, class Work>
  PALPATE_INLINE void each_area(const Group& group, const VertexPositions& positions,
                                const Work& work) const noexcept {
    if constexpr (InRow)
      areas_in_row(group, positions, work);
    else
      areas_apart(group, positions, work);
  }
  template <class Work>
  PALPATE_INLINE void areas_in_row(const Group& group, const VertexPositions& positions,
                                   const Work& work) const noexcept {
    using Wide = detail::native_simd<float>;
    using Narrow = detail::simd_at_most<float, 8>;
    for (const Row *at = rows_.data() + group.row_begin, *const end = rows_.data() + group.row_end; at < end;
         ++at) {
      const Row row = *at;
      if (row.count >= Wide::size())
        areas_of<Wide>(row, positions, work);
      else
        areas_of<Narrow>(row, positions, work);
    }
  }
  template <class V, class Work>
  PALPATE_INLINE void areas_of(const Row& row, const VertexPositions& positions,
                               const Work& work) const noexcept {
    const std::uint32_t* const ring = rings_.data() + row.ring;
    const float *const px = positions.axis(0), *const py = positions.axis(1), *const pz = positions.axis(2);
    with_size(row.size, [&](auto size) {
      const std::uint32_t last = row.count - static_cast<std::uint32_t>(V::size());
      for (std::uint32_t from = 0;; from = (std::min)(from + static_cast<std::uint32_t>(V::size()), last)) {
        V x, y, z;
        area(px + from, py + from, pz + from, ring, size, x, y, z);
        work([first = row.vertex + from](std::uint32_t k) { return first + k; }, x, y, z);
        if (from == last) break;  // the last V overlaps the one before it
      }
    });
  }
  template <class Work>
  PALPATE_INLINE void areas_apart(const Group& group, const VertexPositions& positions,
                                  const Work& work) const noexcept {
    const std::uint32_t* const rings = rings_.data();
    const float* const p = &positions.packed()->x;
    for (const Gathered *at = fours_.data() + group.four_begin, *const end = fours_.data() + group.four_end;
         at < end; ++at) {
      const Gathered four = *at;
      const std::uint32_t* const ring = rings + four.ring;
      detail::Simd4 z, x, y, last;
      with_size(four.size, [&](auto size) {
        z = area(p, ring, size), x = area(p, ring + size, size), y = area(p, ring + 2 * size, size);
        last = area(p, ring + 3 * size, size);
      });
      detail::transpose(z, x, y, last);
      work([&four](std::uint32_t k) { return four.vertex[k]; }, x, y, z);
    }
  }

  std::vector<Row> rows_;
  std::vector<Gathered> fours_;
  // Neighbours: of rows by number in the run, of fours by where their packed positions begin, in floats.
  std::vector<std::uint32_t> rings_;
};

}  // namespace palpate
