// SPDX-License-Identifier: MIT
#pragma once

/// @file How far friction has carried the surface along with the tool, by position: so far beside them lay
/// what the tool's points now touch.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace palpate::detail {

/// The mean of the displacements across, a, of loaded points near x, by their pressures q:
///
///     s(x) = sum q phi a / max(sum q phi, 0.1 sum q),   phi = (1 + r^2/A)^-2,   |a| <= sqrt(A)
///
/// A: the loaded area. One smooth field, for loaded points and for those that are to come in, so that s does
/// not jump where a point does. It fades some widths beyond the contact.
template <Real S>
class CarriedSurface {
 public:
  using V = VectorList::V;

  explicit CarriedSurface(std::size_t capacity) {
    for (auto* list : {&x_, &a_}) list->resize(padded<V>(capacity));
    weight_.resize(AlignedList<float>::padded(capacity));
  }

  /// Positions are relative to `origin` [m].
  void clear(const Vec3<S>& origin) noexcept {
    origin_ = origin;
    size_ = 0;
    total_ = area_ = most_ = 0;
  }
  /// A loaded point at x [m], which the surface has followed by a [m], its q [m^2] and its cell [m^2]. Points
  /// of the same `group` follow each other and lie side by side; they count as one.
  void add(std::uint32_t group, const Vec3<float>& x, float q, const Vec3<float>& a, float area) noexcept {
    if (size_ == 0 || group != group_) {
      group_ = group;
      x_.set(size_, Vec3<float>::Zero()), a_.set(size_, Vec3<float>::Zero());
      weight_[size_++] = 0;
    }
    const std::size_t g = size_ - 1;
    weight_[g] += q;
    x_.set(g, x_[g] + q * x);
    a_.set(g, a_[g] + q * a);
    total_ += q, area_ += area;
    most_ = (std::max)(most_, a.squaredNorm());
  }
  /// After the last add().
  void build() noexcept {
    most_ = std::sqrt(most_);
    const float longest = std::sqrt(area_), share = most_ > longest ? longest / most_ : 1.f;
    most_ *= share;
    for (std::size_t g = 0; g < size_; ++g) {
      x_.set(g, x_[g] / weight_[g]);
      a_.set(g, share * a_[g]);
    }
    for (std::size_t g = size_; g < padded<V>(size_); ++g) {
      for (auto* list : {&x_, &a_}) list->set(g, Vec3<float>::Zero());
      weight_[g] = 0;
    }
  }

  /// At least |s| anywhere [m].
  [[nodiscard]] float most() const noexcept { return most_; }
  /// A leaf of the tool's points over the surface as it lay before.
  [[nodiscard]] PointBatch<S> before(const PointBatch<S>& now) const noexcept {
    return less(now, Vec3<S>(at({now.x[0], now.y[0], now.z[0]}).template cast<S>()));
  }

 private:
  [[nodiscard]] Vec3<float> at(const Vec3<S>& x) const noexcept {
    if (!(most_ > 0)) return Vec3<float>::Zero();
    const SimdVec3<V> here = each(Vec3<float>((x - origin_).template cast<float>()));
    const V one(1.f), per_area(1 / area_);
    SimdVec3<V> sum{};
    V near{};
    for (std::size_t g = 0; g < size_; g += V::size()) {
      const SimdVec3<V> r = x_.load(g) - here;
      const V far = one + dot(r, r) * per_area, phi = one / (far * far);
      sum += phi * a_.load(g), near += phi * V(&weight_[g]);
    }
    return sum_of(sum) / (std::max)(reduce(near), 0.1f * total_);
  }

  VectorList x_, a_;           // of groups: mean position, sum of q a
  AlignedList<float> weight_;  // sum of q
  Vec3<S> origin_ = Vec3<S>::Zero();
  std::size_t size_ = 0;
  std::uint32_t group_ = 0;
  float total_ = 0, area_ = 0, most_ = 0;
};

/// Without friction: nowhere.
struct StillSurface {
  explicit StillSurface(std::size_t /*capacity*/) {}
  static void clear(const auto& /*origin*/) noexcept {}
  [[nodiscard]] static int most() noexcept { return 0; }
  [[nodiscard]] static const auto& before(const auto& x) noexcept { return x; }
};

}  // namespace palpate::detail
