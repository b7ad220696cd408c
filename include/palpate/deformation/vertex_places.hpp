// SPDX-License-Identifier: MIT
#pragma once

/// @file  Where the vertices of a mesh are now, laid out for what makes its normals.

#include <palpate/core/float_vector.hpp>
#include <palpate/core/scalar.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace palpate {

/// A place [m] or a normal in one register's worth of memory.
struct alignas(16) Packed3 {
  float x = 0, y = 0, z = 0, unused = 0;
};

/// Places as `VertexNormals` reads them: coordinate by coordinate, those of all vertices or of one run of them after the other, and
/// packed, one by one [m].
class VertexPlaces {
 public:
  VertexPlaces() = default;
  /// `run`: the longest; `packed_reads`: for each vertex, 1 if its packed place is read (VertexNormals::packed_reads()).
  VertexPlaces(std::size_t run, std::vector<std::uint8_t> packed_reads) : packs_(std::move(packed_reads)) {
    packs_.resize((packs_.size() + 3) / 4 * 4);
    packed_.resize(packs_.size());
    for (auto& list : axis_) list.resize((run + 3) / 4 * 4);
  }

  [[nodiscard]] const Packed3* packed() const noexcept { return packed_.data(); }
  [[nodiscard]] const float* axis(std::size_t i) const noexcept { return axis_[i].data(); }

  /// `count` vertices from v on; in the present run they begin at `at`.
  template <Real S>
  PALPATE_INLINE void set_row(std::size_t at, std::size_t v, std::size_t count, const S* x, const S* y,
                              const S* z) noexcept {
    set_axis(&axis_[0][at], x, count);
    set_axis(&axis_[1][at], y, count);
    set_axis(&axis_[2][at], z, count);
    const auto four = [at](const std::vector<float>& axis, std::size_t i) {
      return detail::load_vector<detail::Float4>(&axis[at + i]);
    };
    std::size_t i = 0;
    for (; i + 4 <= count; i += 4) {
      std::uint32_t any;
      std::memcpy(&any, &packs_[v + i], sizeof any);
      if (any != 0)
        pack(four(axis_[0], i), four(axis_[1], i), four(axis_[2], i),
             [v, i](std::size_t k) { return v + i + k; });
    }
    for (; i < count; ++i) packed_[v + i] = {axis_[0][at + i], axis_[1][at + i], axis_[2][at + i]};
  }
  /// Four anywhere, packed; `complete` when all are there.
  PALPATE_INLINE void set_four(const std::uint32_t* v, detail::Float4 x, detail::Float4 y,
                               detail::Float4 z) noexcept {
    pack(x, y, z, [v](std::size_t k) { return v[k]; });
  }
  /// emit(v, x, y, z) with each four places in a row, v a multiple of 4, the last perhaps past the last vertex. What has only been
  /// packed gets its coordinates, if `axes`.
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
  template <Real S>
  static PALPATE_INLINE void set_axis(float* PALPATE_RESTRICT to, const S* PALPATE_RESTRICT from,
                                      std::size_t count) noexcept {
    std::size_t i = 0;
    if constexpr (sizeof(S) == sizeof(float)) {
      using V = detail::WideRegister;
      for (; i + detail::entries<V> <= count; i += detail::entries<V>)
        detail::store_vector(to + i, detail::load_vector<V>(from + i));
      if (i > 0) {  // the last register over some of the one before it
        i = count - detail::entries<V>;
        detail::store_vector(to + i, detail::load_vector<V>(from + i));
        return;
      }
    }
    for (; i < count; ++i) to[i] = static_cast<float>(from[i]);
  }
  template <class At>
  PALPATE_INLINE void pack(detail::Float4 a, detail::Float4 b, detail::Float4 c, const At& at) noexcept {
    detail::Float4 d{};
    detail::transpose(a, b, c, d);
    Packed3* const to = packed_.data();
    detail::store_vector(&to[at(0)].x, a);
    detail::store_vector(&to[at(1)].x, b);
    detail::store_vector(&to[at(2)].x, c);
    detail::store_vector(&to[at(3)].x, d);
  }

  std::vector<Packed3> packed_;
  std::array<std::vector<float>, 3> axis_;
  std::vector<std::uint8_t> packs_;  // 1 where the packed place is read
};

}  // namespace palpate
