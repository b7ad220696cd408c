// SPDX-License-Identifier: MIT
#pragma once

/// @file What changes linearly over a contact, fitted by its loads.

#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::detail {

/// The area under a ball with the normal loads' sum `load` and the mean pressure by load `pressed`/`load`,
/// `pressed` = sum q^2/A: 9/8 of their quotient [m^2].
[[nodiscard]] inline float carrying_area(float load, float pressed) noexcept {
  return 9 * load / 8 * (load / pressed);  // the square of a first touch's load would vanish
}

/// sqrt(e) over the mean of q/A by load [m^2], e = d_H/R = (pi/2 p_0/E')^2, p_0 = 4/3 of the mean pressure:
/// p/E' = 2 pi (1 - nu) q/A.
[[nodiscard]] inline float root_of_strain_per_load(double nu) noexcept {
  return static_cast<float>(std::numbers::pi / 2 * (4. / 3) * 2 * std::numbers::pi * (1 - nu));
}

/// Moments of the loads q over the feet x of a contact, across its mean direction m:
///
///     mean = sum q x / sum q,   spread = (sum q r r^T + own sum q A / 12 I) / sum q,   r = x - mean
///
/// Cells' own spread keeps few points from a slope of their own. It counts by
/// own = (4 sum q^2/(sum q)^2)^2, at most 1: in full for four points that carry alike, by a hundredth for
/// forty. In full everywhere it would make a slope over a dozen points a tenth too small; by the root of
/// that, over twenty 2 to 3 %.
class LoadFit {
 public:
  using V = VectorList::V;
  /// `system` and q, zeros beyond its points, outlive it.
  LoadFit(const PointSystem& system, const float* q) noexcept : system_(system), q_(q) {
    V loads{};
    SimdVec3<V> xs{}, ms{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i);
      loads += qi, xs += qi * system.feet().load(i), ms += qi * system.directions().load(i);
    }
    load_ = reduce(loads);
    if (!has_load()) return;
    const Vec3<float> pressing = sum_of(ms) / load_;
    mean_ = sum_of(xs) / load_, m_ = pressing.normalized(), one_sided_ = pressing.norm();
    const V per_load(1 / load_);
    V areas{}, shares2{}, pressed{};
    SimdVec3<V> squares{}, products{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> r = from_mean(i);
      const V qi(q + i), A(system.areas() + i), share = per_load * qi;
      const SimdVec3<V> sr = share * r;
      squares += SimdVec3<V>{sr.x * r.x, sr.y * r.y, sr.z * r.z};
      products += SimdVec3<V>{sr.y * r.z, sr.z * r.x, sr.x * r.y};
      areas += share * A, shares2 += share * share, pressed += qi * (qi / A);
    }
    const Vec3<float> xx = sum_of(squares), xy = sum_of(products);
    Mat3<float> spread;
    spread << xx.x(), xy.z(), xy.y(), xy.z(), xx.y(), xy.x(), xy.y(), xy.x(), xx.z();
    alike_ = 1 / reduce(shares2), area_ = reduce(areas), pressed_ = reduce(pressed), spread_ = spread;
    const float few = (std::min)(4 / alike_, 1.f);
    spread += few * few * area_ / 12 * Mat3<float>::Identity();
    const float size = spread.trace();  // powers of small numbers would be 0
    per_spread_ = (spread / size).inverse() / size;
  }
  [[nodiscard]] bool has_load() const noexcept { return load_ > 0; }
  [[nodiscard]] float load() const noexcept { return load_; }
  [[nodiscard]] float pressed() const noexcept { return pressed_; }  ///< sum q^2/A
  [[nodiscard]] const Vec3<float>& mean() const noexcept { return mean_; }
  [[nodiscard]] const Vec3<float>& direction() const noexcept { return m_; }  ///< m
  /// 1 where all points press the same way, 0 where they do from two sides, and m is nothing.
  [[nodiscard]] float one_sided() const noexcept { return one_sided_; }
  /// As many points as carry alike: (sum q)^2/sum q^2.
  [[nodiscard]] float alike() const noexcept { return alike_; }
  /// As many as under a ball whose contact is as wide as this one where it is narrow: 40 pi/9 l/A, with l the
  /// lesser variance of r by load, a^2/5 under a ball, and A the points' mean area.
  [[nodiscard]] float alike_across() const noexcept {
    const Mat3<float> s = spread_ / area_;
    const float sum = s.trace(),
                product = (sum * sum - s.squaredNorm()) / 2;  // r lies across m: the third variance is 0
    const float least = (sum - std::sqrt((std::max)(sum * sum - 4 * product, 0.f))) / 2;
    return 40 * std::numbers::pi_v<float> / 9 * least;
  }
  /// Variance of r by load, without cells' own.
  [[nodiscard]] const Mat3<float>& spread() const noexcept { return spread_; }
  /// r of points i .. on.
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> from_mean(std::size_t i) const noexcept {
    return across(each(m_), system_.feet().load(i) - each(mean_));
  }
  /// Gradient across m of what is f(i) at points i .. on, by regression.
  template <class F>
  [[nodiscard]] Vec3<float> slope(const F& f) const noexcept {
    V sum{};
    for (std::size_t i = 0; i < system_.stride(); i += V::size()) sum += V(q_ + i) * f(i);
    const V mean(reduce(sum) / load_);
    SimdVec3<V> products{};
    for (std::size_t i = 0; i < system_.stride(); i += V::size())
      products += (V(q_ + i) * (f(i) - mean)) * from_mean(i);
    return per_spread_ * (sum_of(products) / load_);
  }
  struct Linear {
    Vec3<float> mean;
    Mat3<float> by_x;
  };
  /// Of a vector f(i) at points i .. on: its mean by load and its gradient, a column for each direction.
  template <class F>
  [[nodiscard]] Linear linear(const F& f) const noexcept {
    SimdVec3<V> sum{}, by_x{}, by_y{}, by_z{};
    for (std::size_t i = 0; i < system_.stride(); i += V::size()) {
      const SimdVec3<V> qf = V(q_ + i) * f(i), r = from_mean(i);
      sum += qf, by_x += r.x * qf, by_y += r.y * qf, by_z += r.z * qf;
    }
    Mat3<float> products;
    products << sum_of(by_x), sum_of(by_y), sum_of(by_z);
    return {sum_of(sum) / load_, products * per_spread_ / load_};
  }
  /// D, of loads q D.r with the moment sum q r (D.r) = `moment`, a sum of loads by r.
  [[nodiscard]] Vec3<float> tilt(const Vec3<float>& moment) const noexcept {
    return per_spread_ * ((moment - m_.dot(moment) * m_) / load_);
  }

 private:
  const PointSystem& system_;
  const float* q_;
  float load_ = 0, pressed_ = 0, one_sided_ = 0, alike_ = 0, area_ = 0;
  Vec3<float> mean_ = Vec3<float>::Zero(), m_ = Vec3<float>::Zero();
  Mat3<float> spread_ = Mat3<float>::Zero(), per_spread_ = Mat3<float>::Zero();
};

}  // namespace palpate::detail
