// SPDX-License-Identifier: MIT
#pragma once

/// @file How far friction has carried the surface along with the tool, by position: so far beside them lay
/// what the tool's points now touch.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/contact_turn.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::detail {

/// Half the turn of the whole contact, T x - x from where it is now (contact_turn.hpp), and the mean of what
/// else the displacements across, a, of loaded points near x have, b, by their pressures q:
///
///     s(x) = x - T x + sum q phi b / max(sum q phi, 0.1 sum q),   phi = (1 + r^2/A)^-2,   |b| <= sqrt(A)
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
    if (size_ == 0) return;
    size_ = 0;
    total_ = area_ = most_ = 0;
    turn_ = {};
  }
  /// A loaded point at x [m], which the surface has followed by a [m], its direction of pressing m, q [m^2]
  /// and cell [m^2]. Points of the same `group` follow each other and lie side by side; they count as one.
  void add(std::uint32_t group, const Vec3<float>& x, float q, const Vec3<float>& a, const Vec3<float>& m,
           float area) noexcept {
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
    turn_.add(x, q, a, m);
  }
  /// After the last add().
  void build() noexcept {
    turn_.build();
    V most2{};
    for (std::size_t g = size_; g < padded<V>(size_); ++g) {
      for (auto* list : {&x_, &a_}) list->set(g, Vec3<float>::Zero());
      weight_[g] = 0;
    }
    for (std::size_t g = 0; g < size_; g += V::size()) {
      const V q(&weight_[g]), per_q = V(1.f) / (max)(q, V((std::numeric_limits<float>::min)()));
      const SimdVec3<V> x = per_q * x_.load(g), a = per_q * a_.load(g), b = turn_.beside(x, a);
      most2 = (max)(most2, select(q > V(0.f), dot(b, b), V(0.f)));
      x_.store(g, x), a_.store(g, q * b);
    }
    most_ = std::sqrt(reduce_max(most2));
    const float longest = std::sqrt(area_), share = most_ > longest ? longest / most_ : 1.f;
    for (std::size_t g = 0; g < size_; g += V::size()) a_.store(g, V(share) * a_.load(g));
    most_ = share * most_ + turn_.most();
  }

  /// At least |s| anywhere [m].
  [[nodiscard]] float most() const noexcept { return most_; }
  /// A leaf of the tool's points over the surface as it lay before.
  [[nodiscard]] PointBatch<S> before(const PointBatch<S>& now) const noexcept {
    if (!(most_ > 0)) return now;
    const Vec3<S> first(now.x[0], now.y[0], now.z[0]);
    PointBatch<S> x = less(now, Vec3<S>(at((first - origin_).template cast<float>()).template cast<S>()));
    if (turn_.is_zero()) return x;
    using W = batch_simd<S>;
    for (std::size_t i = 0; i < batch_size; i += W::size()) {
      const SimdVec3<W> turned = turn_.from_now(load_from<W>(now, i, origin_));
      store(&x.x[i], load<W>(&x.x[i]) + turned.x);
      store(&x.y[i], load<W>(&x.y[i]) + turned.y);
      store(&x.z[i], load<W>(&x.z[i]) + turned.z);
    }
    return x;
  }
  /// Where what the last add()s placed at x was before friction turned it.
  [[nodiscard]] Vec3<float> at_rest(const Vec3<float>& x) const noexcept {
    const SimdVec3<float> back = turn_.from_half_way(each<float>(x));
    return x + Vec3<float>(back.x, back.y, back.z);
  }

 private:
  // The mean, without the turn.
  [[nodiscard]] Vec3<float> at(const Vec3<float>& x) const noexcept {
    const SimdVec3<V> here = each(x);
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
  ContactTurn turn_;
};

/// Without friction: nowhere.
struct StillSurface {
  explicit StillSurface(std::size_t /*capacity*/) {}
  static void clear(const auto& /*origin*/) noexcept {}
  [[nodiscard]] static int most() noexcept { return 0; }
  [[nodiscard]] static const auto& before(const auto& x) noexcept { return x; }
  [[nodiscard]] static const auto& at_rest(const auto& x) noexcept { return x; }
};

}  // namespace palpate::detail
