// SPDX-License-Identifier: MIT
#pragma once

/// @file  Weights of a face's vertices, split by a contact, in vector registers.

#include <palpate/core/simd.hpp>
#include <palpate/core/unroll.hpp>
#include <palpate/luo_xiao/interpolation/partition.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace palpate::detail {

/// Terms to interpolate: of each corner of a face, and of the contact.
template <Real S, std::size_t Terms>
struct FaceTerms {
  using Row = std::array<simd_factor<S>, Terms>;
  std::array<Row, max_face_corners> corner;
  Row contact;

  static PALPATE_INLINE Row row(const S* from) noexcept {
    Row row;
    for (std::size_t term = 0; term < Terms; ++term) row[term] = simd_factor<S>(from[term]);
    return row;
  }
};

/// Weights of a group of vertices: at N corners (0: known at run time only), and of the contact where it
/// splits the face.
template <Real S, std::size_t N, bool Split>
class GroupWeights {
 public:
  using V = simd_group<S>;

  /// Weights L begin at `weight`, those of the next corner `stride` further. FacePartition has the formulas.
  PALPATE_INLINE GroupWeights(const S* weight, std::size_t stride,
                              const FaceSplit<simd_factor<S>>& split) noexcept
      : corners_(split.corners) {
    each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA { corner_[k] = V(weight + k * stride); });
    if constexpr (Split) {
      contact_ = V(split.share);
      each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA {
        contact_ = (min)(corner_[k] * split.per_P[k] + split.lift[k], contact_);
      });
      V sum = V((std::numeric_limits<S>::min)());  // never divides by zero
      each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA {
        corner_[k] = (max)(corner_[k] - contact_ * split.P[k], V{});
        sum = sum + corner_[k];
      });
      const V scale = (S(1) - contact_) / sum;
      each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA { corner_[k] = corner_[k] * scale; });
    }
  }

  /// work(k, weight) of every corner, and of the contact as the last one where it splits the face.
  template <class Work>
  PALPATE_INLINE void each_term(const Work& work) const noexcept {
    each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA { work(k, corner_[k]); });
    if constexpr (Split) work(N == 0 ? corners_ : N, contact_);
  }
  /// sum_k w_k corner_k + mu contact, of term number `term`.
  template <std::size_t Terms>
  [[nodiscard]] PALPATE_INLINE V sum(const FaceTerms<S, Terms>& of, std::size_t term) const noexcept {
    V sum{};
    each_corner([&](std::size_t k) PALPATE_INLINE_LAMBDA {
      const V part = corner_[k] * of.corner[k][term];
      sum = k == 0 ? part : sum + part;
    });
    if constexpr (Split) sum = sum + contact_ * of.contact[term];
    return sum;
  }

 private:
  template <class Work>
  PALPATE_INLINE void each_corner(const Work& work) const noexcept {
    if constexpr (N == 0)
      for (std::size_t k = 0; k < corners_; ++k) work(k);
    else
      unroll<N>(work);
  }

  std::size_t corners_;
  std::array<V, N == 0 ? max_face_corners : N> corner_;
  V contact_{};
};

/// The weights of all vertices of a face from some slot on.
template <Real S, std::size_t N, bool Split>
class FaceWeights {
 public:
  PALPATE_INLINE FaceWeights(const S* weight, std::size_t stride, const FaceSplit<S>& split) noexcept
      : weight_(weight), stride_(stride), split_(factors(split)) {}
  /// How many terms have a weight: corners, and the contact where it splits the face.
  [[nodiscard]] PALPATE_INLINE std::size_t terms() const noexcept {
    return (N == 0 ? split_.corners : N) + (Split ? 1 : 0);
  }
  /// Of the group that begins i slots on.
  [[nodiscard]] PALPATE_INLINE GroupWeights<S, N, Split> at(std::size_t i) const noexcept {
    return {weight_ + i, stride_, split_};
  }

 private:
  static PALPATE_INLINE FaceSplit<simd_factor<S>> factors(const FaceSplit<S>& split) noexcept {
    FaceSplit<simd_factor<S>> to;
    to.corners = split.corners;
    to.share = simd_factor<S>(split.share);
    for (std::size_t k = 0; k < split.corners; ++k) {
      to.P[k] = simd_factor<S>(split.P[k]);
      to.per_P[k] = simd_factor<S>(split.per_P[k]);
      to.lift[k] = simd_factor<S>(split.lift[k]);
    }
    return to;
  }

  const S* weight_;
  std::size_t stride_;
  FaceSplit<simd_factor<S>> split_;
};

/// work(FaceWeights) with the weights from slot number `from` of the face on: one type for triangles, one for
/// quadrilaterals, one for others, split or not.
template <Real S, class Work>
PALPATE_INLINE void with_weights(const FacePartition<S>& partition, const PointWeights<S>& at,
                                 std::size_t face, std::size_t from, const Work& work) noexcept {
  const Face<S>& f = partition.faces()[face];
  const FaceSplit<S> split = partition.split(at, face);
  const S* const weight = partition.weights(f) + from;
  const auto with_corners = [&]<bool Split>(std::bool_constant<Split>) PALPATE_INLINE_LAMBDA {
    if (f.corners == 3)
      work(FaceWeights<S, 3, Split>(weight, f.length, split));
    else if (f.corners == 4)
      work(FaceWeights<S, 4, Split>(weight, f.length, split));
    else
      work(FaceWeights<S, 0, Split>(weight, f.length, split));
  };
  if (split.share > S(0))
    with_corners(std::true_type{});
  else
    with_corners(std::false_type{});
}

}  // namespace palpate::detail
