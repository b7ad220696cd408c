// SPDX-License-Identifier: MIT
#pragma once

/// @file  Positions and normals into a caller's buffer: one vertex, or several at once.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_shuffle.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace palpate::detail {

[[nodiscard]] PALPATE_INLINE Simd4 simd_of(Simd4::register_type x) noexcept {
  Simd4 result;
  result.native[0] = x;
  return result;
}

/// Writes to the vertices of a caller's buffer, by number.
template <Real T>
class VertexWriter {
 public:
  VertexWriter(T* to, std::size_t stride) noexcept
      : base_(reinterpret_cast<unsigned char*>(to)), stride_(stride) {}

  /// Three copies: one of all three numbers from the stack would wait for the stores to it.
  PALPATE_INLINE void put(std::size_t vertex, T x, T y, T z) const noexcept {
    unsigned char* const at = base_ + stride_ * vertex;
    std::memcpy(at, &x, sizeof(T));
    std::memcpy(at + sizeof(T), &y, sizeof(T));
    std::memcpy(at + 2 * sizeof(T), &z, sizeof(T));
  }
  /// To vertices number first, first + 1 .. Precondition: where x has more than four entries the buffer is
  /// packed.
  template <class V>
  PALPATE_INLINE void put_row(std::size_t first, const V& x, const V& y, const V& z) const noexcept {
    if constexpr (V::size() == Simd4::size()) {
      if (!is_packed()) return put_apart([first](std::size_t k) { return first + k; }, x, y, z);
    }
    store_interleaved(base_ + stride_ * first, x, y, z);
  }
  /// To vertices number vertex(0) .. vertex(3).
  template <class Vertex>
  PALPATE_INLINE void put_four(const Vertex& vertex, const Simd4& x, const Simd4& y,
                               const Simd4& z) const noexcept {
    if (in_a_row(vertex)) return store_interleaved(base_ + stride_ * vertex(0), x, y, z);
    put_apart(vertex, x, y, z);
  }
  /// The same for vertices that hardly ever follow each other.
  template <class Vertex>
  PALPATE_INLINE void put_apart(const Vertex& vertex, const Simd4& x, const Simd4& y,
                                const Simd4& z) const noexcept {
    if constexpr (sizeof(T) == sizeof(float))
      return store_apart(base_ + stride_ * vertex(0), base_ + stride_ * vertex(1),
                         base_ + stride_ * vertex(2), base_ + stride_ * vertex(3), x, y, z);
    put(vertex(0), T(x[0]), T(y[0]), T(z[0]));
    put(vertex(1), T(x[1]), T(y[1]), T(z[1]));
    put(vertex(2), T(x[2]), T(y[2]), T(z[2]));
    put(vertex(3), T(x[3]), T(y[3]), T(z[3]));
  }
  template <class Vertex>
  PALPATE_INLINE void put_apart(const Vertex& vertex, Simd4::register_type x, Simd4::register_type y,
                                Simd4::register_type z) const noexcept {
    put_apart(vertex, simd_of(x), simd_of(y), simd_of(z));
  }
  /// To vertices number vertex(0), vertex(1) .., one per entry of x; more than four ascend.
  template <class Vertex, class V>
  PALPATE_INLINE void put_register(const Vertex& vertex, const V& x, const V& y, const V& z) const noexcept {
    if constexpr (V::size() == Simd4::size()) {
      put_four(vertex, x, y, z);
    } else {
      const std::uint32_t first = vertex(0);
      if (is_packed() && vertex(V::size() - 1) - first == V::size() - 1)  // as they ascend: none is left out
        return store_interleaved(base_ + stride_ * first, x, y, z);
      for_each_chunk<4>(x, [&](auto from, const Simd4& part) PALPATE_INLINE_LAMBDA {
        put_four([&vertex, from](std::uint32_t k) { return vertex(from + k); }, part, chunk<4, from>(y),
                 chunk<4, from>(z));
      });
    }
  }
  /// x[i], y[i], z[i] to vertex number first + i, for all i < count.
  template <Real S>
  PALPATE_INLINE void put_run(std::size_t first, std::size_t count, const S* x, const S* y,
                              const S* z) const noexcept {
    if constexpr (sizeof(S) == sizeof(float)) {
      const auto put = [&]<class V>(std::type_identity<V>, std::size_t i) PALPATE_INLINE_LAMBDA {
        put_row(first + i, load<V>(x + i), load<V>(y + i), load<V>(z + i));
      };
      // The last register overlaps the one before it.
      const auto put_all = [&]<class V>(std::type_identity<V> type) PALPATE_INLINE_LAMBDA {
        std::size_t i = 0;
        for (; i + V::size() < count; i += V::size()) put(type, i);
        put(type, count - V::size());
      };
      if (is_packed() && count >= native_simd<float>::size())
        return put_all(std::type_identity<native_simd<float>>{});
      if (count >= Simd4::size()) return put_all(std::type_identity<Simd4>{});
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
        if (length < Simd4::size() && i + Simd4::size() <= count) {
          put_apart([at = vertex + i](std::size_t k) { return at[k]; }, load<Simd4>(x + i),
                    load<Simd4>(y + i), load<Simd4>(z + i));
          i += Simd4::size();
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
