// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where the vertices of a mesh are now, laid out for what makes its normals.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/float_vector.hpp>
#include <palpate/core/scalar.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

/// A position [m] or a normal in one register's worth of memory.
struct alignas(16) Packed3 {
  float x = 0, y = 0, z = 0, unused = 0;
};

/// Vertices that follow each other, whose coordinates are in VertexPositions together.
struct VertexRun {
  std::size_t first = 0, count = 0;
};

/// Positions as `VertexNormals` reads them: coordinate by coordinate, those of all vertices or of one run of
/// them after the other, and packed, one by one [m].
class VertexPositions {
 public:
  VertexPositions() = default;
  /// `packed_reads`: for each vertex, 1 if its packed position is read (VertexNormals::packed_reads()).
  VertexPositions(std::span<const VertexRun> runs, std::span<const std::uint8_t> packed_reads) {
    packed_.resize((packed_reads.size() + 3) / 4 * 4);
    std::size_t longest = 0;
    for (const VertexRun& run : runs) {
      longest = (std::max)(longest, run.count);
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
    for (auto& list : axis_) list.resize(longest);
  }

  [[nodiscard]] const Packed3* packed() const noexcept { return packed_.data(); }
  [[nodiscard]] const float* axis(std::size_t i) const noexcept { return axis_[i].data(); }
  /// Where the present run's coordinates are put, on a cache line.
  [[nodiscard]] float* axis(std::size_t i) noexcept { return axis_[i].data(); }

  /// `count` coordinates of the present run, from its number `from` on; `pack` when all are there.
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
  /// The coordinates are those of run number `run`: packs what is read packed.
  void pack(std::size_t run) noexcept {
    const Packing& packing = packings_[run];
    for (std::size_t k = packing.fours_begin; k < packing.fours_end; ++k) {
      const auto four = [i = fours_[k]](const AlignedList<float>& axis) {
        return detail::load_vector<detail::Float4>(axis.data() + i);
      };
      detail::store_by_fours(&packed_[packing.first + fours_[k]].x, four(axis_[0]), four(axis_[1]),
                             four(axis_[2]));
    }
    for (std::size_t k = packing.ones_begin; k < packing.ones_end; ++k) {
      const std::size_t i = ones_[k];
      packed_[packing.first + i] = {axis_[0][i], axis_[1][i], axis_[2][i]};
    }
  }
  /// Four anywhere, packed; `complete` when all are there.
  PALPATE_INLINE void set_four(const std::uint32_t* v, detail::Float4 x, detail::Float4 y,
                               detail::Float4 z) noexcept {
    detail::Float4 none{};
    detail::transpose(x, y, z, none);
    detail::store_vector(&packed_[v[0]].x, x);
    detail::store_vector(&packed_[v[1]].x, y);
    detail::store_vector(&packed_[v[2]].x, z);
    detail::store_vector(&packed_[v[3]].x, none);
  }
  /// emit(v, x, y, z) with each four positions in a row, v a multiple of 4, the last perhaps past the last
  /// vertex. What has only been packed gets its coordinates, if `axes`.
  template <class Emit>
  PALPATE_INLINE void complete(bool axes, const Emit& emit) noexcept {
    for (std::size_t v = 0; v < packed_.size(); v += 4) {
      detail::Float4 a = detail::load_vector<detail::Float4>(&packed_[v].x),
                     b = detail::load_vector<detail::Float4>(&packed_[v + 1].x),
                     c = detail::load_vector<detail::Float4>(&packed_[v + 2].x),
                     d = detail::load_vector<detail::Float4>(&packed_[v + 3].x);
      detail::transpose(a, b, c, d);
      if (axes) {
        detail::store_vector(&axis_[0][v], a);
        detail::store_vector(&axis_[1][v], b);
        detail::store_vector(&axis_[2][v], c);
      }
      emit(v, a, b, c);
    }
  }

 private:
  struct Packing {  // of a run: where its coordinates are packed to, and which
    std::size_t first, fours_begin, fours_end, ones_begin, ones_end;
  };
  std::vector<Packed3> packed_;
  std::array<AlignedList<float>, 3> axis_;
  std::vector<Packing> packings_;            // by run
  std::vector<std::uint32_t> fours_, ones_;  // what is packed, by number in the run: from there four, or one
};

}  // namespace palpate
