// SPDX-License-Identifier: MIT
#pragma once

/// @file  Present positions of the vertices of a mesh, laid out for `VertexNormals`.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_shuffle.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

/// A position [m] or a normal, padded to one register of four floats.
struct alignas(16) Packed3 {
  float x = 0, y = 0, z = 0, unused = 0;
};

/// Consecutive vertices whose coordinates are in VertexPositions at the same time.
struct VertexRun {
  std::size_t first = 0, count = 0;
};

/// Positions [m] as `VertexNormals` reads them. Coordinate by coordinate: those of all vertices, or of one
/// run after the other. Packed: each position on its own.
class VertexPositions {
 public:
  VertexPositions() = default;
  /// `packed_reads`: for each vertex, 1 if its packed position is read (VertexNormals::packed_reads()).
  VertexPositions(std::span<const VertexRun> runs, std::span<const std::uint8_t> packed_reads) {
    packed_.resize((packed_reads.size() + 3) / 4 * 4);
    std::size_t max_count = 0;
    for (const VertexRun& run : runs) {
      max_count = (std::max)(max_count, run.count);
      Packing packing{run.first, fours_.size(), 0, ones_.size(), 0};
      for (std::size_t i = 0; i < run.count; ++i) {
        if (packed_reads[run.first + i] == 0) continue;
        if (i + 4 <= run.count) {
          fours_.push_back(static_cast<std::uint32_t>(i));
          i += 3;
        } else {
          ones_.push_back(static_cast<std::uint32_t>(i));
        }
      }
      packing.fours_end = fours_.size(), packing.ones_end = ones_.size();
      packings_.push_back(packing);
    }
    for (auto& list : axis_) list.resize(max_count);
  }

  [[nodiscard]] const Packed3* packed() const noexcept { return packed_.data(); }
  [[nodiscard]] const float* axis(std::size_t i) const noexcept { return axis_[i].data(); }
  /// The present run's coordinates, to be written; they begin on a cache line.
  [[nodiscard]] float* axis(std::size_t i) noexcept { return axis_[i].data(); }

  /// Sets `count` positions of the present run, from its number `from` on. Call `pack` when all are there.
  template <Real S>
  PALPATE_INLINE void set_row(std::size_t from, std::size_t count, const S* x, const S* y,
                              const S* z) noexcept {
    const std::array<const S*, 3> at{x, y, z};
    for (std::size_t k = 0; k < 3; ++k) {
      if constexpr (std::same_as<S, float>)
        std::copy_n(at[k], count, axis(k) + from);
      else
        std::transform(at[k], at[k] + count, axis(k) + from, [](S a) { return static_cast<float>(a); });
    }
  }
  /// Packs those of run number `run` that are read packed. The coordinates must be that run's.
  void pack(std::size_t run) noexcept {
    const Packing& packing = packings_[run];
    for (std::size_t k = packing.fours_begin; k < packing.fours_end; ++k) {
      const auto four = [i = fours_[k]](const AlignedList<float>& axis) {
        return detail::load<detail::Simd4>(axis.data() + i);
      };
      detail::store_by_fours(&packed_[packing.first + fours_[k]].x, four(axis_[0]), four(axis_[1]),
                             four(axis_[2]));
    }
    for (std::size_t k = packing.ones_begin; k < packing.ones_end; ++k) {
      const std::size_t i = ones_[k];
      packed_[packing.first + i] = {axis_[0][i], axis_[1][i], axis_[2][i]};
    }
  }
  /// Sets the packed positions of vertices v[0] .. v[3]. Call `complete` when all are there.
  PALPATE_INLINE void set_four(const std::uint32_t* v, detail::Simd4 x, detail::Simd4 y,
                               detail::Simd4 z) noexcept {
    detail::Simd4 none{};
    detail::transpose(x, y, z, none);
    detail::store(&packed_[v[0]].x, x);
    detail::store(&packed_[v[1]].x, y);
    detail::store(&packed_[v[2]].x, z);
    detail::store(&packed_[v[3]].x, none);
  }
  PALPATE_INLINE void set_four(const std::uint32_t* v, detail::Simd4::register_type x,
                               detail::Simd4::register_type y, detail::Simd4::register_type z) noexcept {
    set_four(v, detail::Simd4(reinterpret_cast<const float*>(&x)),
             detail::Simd4(reinterpret_cast<const float*>(&y)),
             detail::Simd4(reinterpret_cast<const float*>(&z)));
  }
  /// Calls emit(v, x, y, z) with the positions of vertices v .. v + 3, v a multiple of 4; the last may not be
  /// vertices any more. Copies the packed positions to the coordinates, if `axes`.
  template <class Emit>
  PALPATE_INLINE void complete(bool axes, const Emit& emit) noexcept {
    for (std::size_t v = 0; v < packed_.size(); v += 4) {
      detail::Simd4 a = detail::load<detail::Simd4>(&packed_[v].x),
                    b = detail::load<detail::Simd4>(&packed_[v + 1].x),
                    c = detail::load<detail::Simd4>(&packed_[v + 2].x),
                    d = detail::load<detail::Simd4>(&packed_[v + 3].x);
      detail::transpose(a, b, c, d);
      if (axes) {
        detail::store(&axis_[0][v], a);
        detail::store(&axis_[1][v], b);
        detail::store(&axis_[2][v], c);
      }
      emit(v, a, b, c);
    }
  }

 private:
  struct Packing {  // of a run: its first vertex, and its parts of fours_ and ones_
    std::size_t first, fours_begin, fours_end, ones_begin, ones_end;
  };
  std::vector<Packed3> packed_;
  std::array<AlignedList<float>, 3> axis_;
  std::vector<Packing> packings_;  // by run
  std::vector<std::uint32_t> fours_,
      ones_;  // numbers in the run: four positions are packed from here, or one
};

}  // namespace palpate
