// SPDX-License-Identifier: MIT
#pragma once

/// @file Loads that other tools put on the same body: how they move the surface beneath this one.

#include <palpate/contact/surface_load.hpp>
#include <palpate/core/aligned_list.hpp>
#include <palpate/core/scalar.hpp>
#include <palpate/resolved/detail/half_space_kernel.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate::detail {

/// Up to `capacity` loads, in the coordinates and units of a tick.
template <Real S>
class LoadsBeside {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  LoadsBeside(std::size_t capacity, std::size_t points, float compressibility)
      : b_(compressibility), triangle_(capacity, ~0u) {
    const std::size_t padded = AlignedList<float>::padded(capacity);
    for (auto* list : {&x_, &m_, &P_}) list->resize(padded);
    area_.resize(padded);
    given_.resize(AlignedList<float>::padded(points));
  }

  /// Loads of the caller's, which stay where they are until they are others'.
  void set(std::span<const SurfaceLoad<S>> loads) noexcept { loads_ = loads; }
  [[nodiscard]] bool has_all() const noexcept { return loads_.size() <= triangle_.size(); }

  /// Takes them into a tick's system: positions relative to `origin`, P = f / per_load.
  template <class Body, class RegularPart>
  void place(const Body& body, const Vec3<S>& origin, S per_load, RegularPart& regular) noexcept {
    size_ = 0;
    for (const SurfaceLoad<S>& load : loads_) {
      if (size_ == triangle_.size()) break;
      if (!is_finite(load.position) || !is_finite(load.direction) || !is_finite(load.force) ||
          !is_finite(load.area))
        continue;
      x_.set(size_, (load.position - origin).template cast<float>());
      m_.set(size_, load.direction.template cast<float>());
      P_.set(size_, (load.force / per_load).template cast<float>());
      area_[size_++] = static_cast<float>(load.area);
    }
    for (std::size_t i = size_; i < padded<V>(size_); ++i) {  // what fills up the last register
      x_.set(i, PointSystem::apart());
      for (auto* list : {&m_, &P_}) list->set(i, Vec3<float>::Zero());
      area_[i] = 1;
    }
    if constexpr (RegularPart::active) {
      for (std::size_t i = 0; i < size_; ++i)
        regular.add_beside(body, (origin + x_[i].template cast<S>()).template cast<double>(), triangle_[i],
                           P_[i]);
    }
  }
  /// They move the points, which then need not be pressed as deep, or must be pressed deeper where the
  /// surface bulges. Of a bulge that is higher than the tool is deep a part counts: touching points are found
  /// beneath the undeformed surface alone, and a tool that lifts off would lose its force as the root of its
  /// depth.
  template <class RegularPart>
  void move_points(PointSystem& system, RegularPart& regular) noexcept {
    if (size_ == 0) return;
    if constexpr (RegularPart::active) regular.gather_beside();
    float bulge = 0;
    for (std::size_t i = 0; i < system.size(); ++i) {
      Vec3<float> u = displacement_at(system.foot(i), system.direction(i));
      if constexpr (RegularPart::active) u += regular.beside(i);
      given_.set(i, u);
      bulge = (std::max)(bulge, -system.direction(i).dot(u));
    }
    const float share = bulge > system.deepest() ? system.deepest() / bulge : 1.f;
    for (std::size_t i = 0; i < system.size(); ++i) {
      const float sunk = system.direction(i).dot(given_[i]);
      system.depth[i] -= sunk < 0 ? share * sunk : sunk;
    }
  }
  /// Displacements of points i .. on of the tick by them [m].
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
    return size_ > 0 ? given_.load(i) : SimdVec3<V>{};
  }

  /// The half-space's displacement at x by all of them; m: the direction of pressing there [m].
  [[nodiscard]] Vec3<float> displacement_at(const Vec3<float>& x, const Vec3<float>& m) const noexcept {
    SimdVec3<V> sum{};
    for (std::size_t i = 0; i < size_; i += V::size())
      sum = pushed(b_, point_pair(each<V>(x) - x_.load(i), each<V>(m), m_.load(i), V(&area_[i])), P_.load(i),
                   sum);
    return sum_of(sum);
  }

 private:
  float b_;  // 1 - 2 nu
  std::span<const SurfaceLoad<S>> loads_;
  VectorList x_, m_, P_;
  AlignedList<float> area_;
  std::vector<std::uint32_t> triangle_;  // of the load mesh, where a load was last
  VectorList given_;
  std::size_t size_ = 0;
};

/// A tool that is alone on its body.
struct NoLoadsBeside {
  static constexpr bool active = false;
  NoLoadsBeside(std::size_t, std::size_t, float) {}
  [[nodiscard]] PALPATE_INLINE static SimdVec3<VectorList::V> load(std::size_t) noexcept { return {}; }
};

}  // namespace palpate::detail
