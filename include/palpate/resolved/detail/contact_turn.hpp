// SPDX-License-Identifier: MIT
#pragma once

/// @file By how much friction has turned the surface with the tool, about the direction of pressing.

#include <palpate/core/simd_math.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>

namespace palpate::detail {

/// Displacements a across of points that a tool has turned by theta about the axis m through c, and placed at
/// x half way back:
///
///     a = 2 sin(theta/2) m x (x - c) + b,   2 sin(theta/2) = m.sum q (x - c) x a / sum q (x - c)^2
///
/// by regression over the loads q. Seen from half way a turn has no strain across m, as in truth; from where
/// points are now or were before a linear body would be stretched or pressed together by theta^2/2. The sine
/// is at most 1/2. m: mean direction of pressing; c: middle of the loads. From R on, R^2 = 3 mean (x - c)^2,
/// which is a line's end and somewhat beyond a disc's rim, the sine falls as R^2/r^2.
class ContactTurn {
 public:
  void add(const Vec3<float>& x, float q, const Vec3<float>& a, const Vec3<float>& m) noexcept {
    const Vec3<float> moment = q * x;
    total_ += q, half_way_ += moment, moved_ += q * a, axis_ += q * m;
    curl_ += moment.cross(a), squares_ += moment.dot(x);
  }
  /// After the last add().
  void build() noexcept {
    const float length = axis_.norm();
    if (!(total_ > 0) || !(length > 0)) return;
    half_way_ /= total_, moved_ /= total_, axis_ /= length;
    const float mean2 = squares_ / total_ - half_way_.squaredNorm();
    if (!(mean2 > 0)) return;
    radius2_ = 3 * mean2;
    sine_ = std::clamp(axis_.dot(curl_ / total_ - half_way_.cross(moved_)) / (2 * mean2), -0.5f, 0.5f);
  }
  [[nodiscard]] bool is_zero() const noexcept { return sine_ == 0; }
  /// At least the length of half a turn anywhere, 1.04 times that at most [m].
  [[nodiscard]] float most() const noexcept { return 1.1f * std::abs(sine_) * std::sqrt(radius2_); }

  /// b of a at x.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> beside(const SimdVec3<W>& x, const SimdVec3<W>& a) const noexcept {
    const SimdVec3<W> round = about(x, half_way_);
    return a - (W(2) * sine(round)) * round;
  }
  /// From where a point is now half way back.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> from_now(const SimdVec3<W>& x) const noexcept {
    return back(about(x, half_way_ + moved_));
  }
  /// From half way to where it was before.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> from_half_way(const SimdVec3<W>& x) const noexcept {
    return back(about(x, half_way_));
  }

 private:
  // m x (x - c)
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> about(const SimdVec3<W>& x, const Vec3<float>& c) const noexcept {
    return cross(each<W>(axis_), x - each<W>(c));
  }
  // sin(theta/2) at that distance.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE W sine(const SimdVec3<W>& round) const noexcept {
    const W R2 = W(radius2_);
    return W(sine_) * (R2 / (max)(R2, dot(round, round)));
  }
  // What a turn by -theta/2 adds.
  template <SimdOrReal W>
  [[nodiscard]] PALPATE_INLINE SimdVec3<W> back(const SimdVec3<W>& round) const noexcept {
    const W s = sine(round), one_less_cosine = W(1) - sqrt(W(1) - s * s);
    return one_less_cosine * cross(each<W>(axis_), round) - s * round;
  }

  Vec3<float> half_way_ = Vec3<float>::Zero(), moved_ = half_way_, axis_ = half_way_, curl_ = half_way_;
  float total_ = 0, squares_ = 0;
  float radius2_ = 0, sine_ = 0;  // R^2; sin(theta/2)
};

}  // namespace palpate::detail
