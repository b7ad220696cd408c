// SPDX-License-Identifier: MIT
#pragma once

/// @file  Positions and normals into a caller's buffer: one vertex, or four at once.

#include <palpate/core/float_vector.hpp>
#include <palpate/core/scalar.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace palpate::detail {

/// Writes to the vertices of a caller's buffer, by number.
template <Real T>
class VertexWriter {
 public:
  VertexWriter(T* to, std::size_t stride) noexcept
      : base_(reinterpret_cast<unsigned char*>(to)), stride_(stride) {}

  /// One by one: gathered on the stack first, the copy would wait for the stores.
  PALPATE_INLINE void put(std::size_t vertex, T x, T y, T z) const noexcept {
    unsigned char* const at = base_ + stride_ * vertex;
    std::memcpy(at, &x, sizeof(T));
    std::memcpy(at + sizeof(T), &y, sizeof(T));
    std::memcpy(at + 2 * sizeof(T), &z, sizeof(T));
  }
  /// To vertices number first, first + 1 ..; more than four: into a packed buffer.
  template <class V>
  PALPATE_INLINE void put_row(std::size_t first, const V& x, const V& y, const V& z) const noexcept {
    if constexpr (entries<V> == entries<Float4>) {
      if (!is_packed()) return put_apart([first](std::size_t k) { return first + k; }, x, y, z);
    }
    store_interleaved(base_ + stride_ * first, x, y, z);
  }
  /// To vertices number vertex(0) .. vertex(3).
  template <class Vertex>
  PALPATE_INLINE void put_four(const Vertex& vertex, Float4 x, Float4 y, Float4 z) const noexcept {
    if (in_a_row(vertex)) return store_interleaved(base_ + stride_ * vertex(0), x, y, z);
    put_apart(vertex, x, y, z);
  }
  /// The same for vertices that hardly ever follow each other.
  template <class Vertex>
  PALPATE_INLINE void put_apart(const Vertex& vertex, Float4 x, Float4 y, Float4 z) const noexcept {
    if constexpr (sizeof(T) == sizeof(float))
      return store_apart(base_ + stride_ * vertex(0), base_ + stride_ * vertex(1),
                         base_ + stride_ * vertex(2), base_ + stride_ * vertex(3), x, y, z);
    put(vertex(0), T(x[0]), T(y[0]), T(z[0]));
    put(vertex(1), T(x[1]), T(y[1]), T(z[1]));
    put(vertex(2), T(x[2]), T(y[2]), T(z[2]));
    put(vertex(3), T(x[3]), T(y[3]), T(z[3]));
  }
  /// To vertices number vertex(0), vertex(1) .., as many as a register holds; more than four ascend.
  template <class Vertex, class V>
  PALPATE_INLINE void put_register(const Vertex& vertex, const V& x, const V& y, const V& z) const noexcept {
    if constexpr (entries<V> == entries<Float4>) {
      put_four(vertex, x, y, z);
    } else {
      const std::uint32_t first = vertex(0);
      if (is_packed() &&
          vertex(entries<V> - 1) - first == entries<V> - 1)  // as they ascend: none is left out
        return store_interleaved(base_ + stride_ * first, x, y, z);
      each_four<V>([&](auto from) PALPATE_INLINE_LAMBDA {
        put_four([&vertex, from](std::uint32_t k) { return vertex(from + k); }, four_of<from>(x),
                 four_of<from>(y), four_of<from>(z));
      });
    }
  }
  /// x[i], y[i], z[i] to vertex number first + i, for all i < count.
  template <Real S>
  PALPATE_INLINE void put_run(std::size_t first, std::size_t count, const S* x, const S* y,
                              const S* z) const noexcept {
    if constexpr (sizeof(S) == sizeof(float)) {
      const auto put = [&]<class V>(std::type_identity<V>, std::size_t i) PALPATE_INLINE_LAMBDA {
        put_row(first + i, load_vector<V>(x + i), load_vector<V>(y + i), load_vector<V>(z + i));
      };
      // The last register over some of the one before it.
      const auto put_all = [&]<class V>(std::type_identity<V> type) PALPATE_INLINE_LAMBDA {
        std::size_t i = 0;
        for (; i + entries<V> < count; i += entries<V>) put(type, i);
        put(type, count - entries<V>);
      };
      if (is_packed() && count >= entries<WideRegister>) return put_all(std::type_identity<WideRegister>{});
      if (count >= entries<Float4>) return put_all(std::type_identity<Float4>{});
    }
    for (std::size_t i = 0; i < count; ++i)
      put(first + i, static_cast<T>(x[i]), static_cast<T>(y[i]), static_cast<T>(z[i]));
  }
  /// x[i], y[i], z[i] to vertex number vertex[i], for all i < count. run[i] says how many from i on follow
  /// each other in the buffer, itself among them; it may say less.
  template <Real S>
  PALPATE_INLINE void put_runs(std::size_t count, const std::uint32_t* vertex, const std::uint8_t* run,
                               const S* x, const S* y, const S* z) const noexcept {
    for (std::size_t i = 0; i < count;) {
      const std::size_t length = run[i] < count - i ? run[i] : count - i;
      if constexpr (sizeof(S) == sizeof(float)) {
        if (length < entries<Float4> && i + entries<Float4> <= count) {
          put_apart([at = vertex + i](std::size_t k) { return at[k]; }, load_vector<Float4>(x + i),
                    load_vector<Float4>(y + i), load_vector<Float4>(z + i));
          i += entries<Float4>;
          continue;
        }
      }
      put_run(vertex[i], length, x + i, y + i, z + i);
      i += length;
    }
  }

 private:
  // Floats without a gap: whole registers may be written.
  [[nodiscard]] PALPATE_INLINE bool is_packed() const noexcept {
    return sizeof(T) == sizeof(float) && stride_ == 3 * sizeof(float);
  }
  // Do four vertices follow each other in a packed buffer?
  template <class Vertex>
  [[nodiscard]] PALPATE_INLINE bool in_a_row(const Vertex& vertex) const noexcept {
    const std::uint32_t first = vertex(0);
    return is_packed() && vertex(1) == first + 1 && vertex(2) == first + 2 && vertex(3) == first + 3;
  }

  unsigned char* base_;
  std::size_t stride_;
};

}  // namespace palpate::detail
