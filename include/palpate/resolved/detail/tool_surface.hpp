// SPDX-License-Identifier: MIT
#pragma once

/// @file A leaf of the tool's points that touches: which of them can press, and which way.

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/detection/tool_points.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/touching_point.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate::detail {

/// Points of a leaf, 0 in `depth` for those that do not press.
struct TouchingLeaf {
  using Each = std::array<float, batch_size>;

  alignas(64) Each depth;       ///< along m [m]
  std::array<Each, 3> m;        ///< the surface's inward normal
  std::array<Each, 3> outward;  ///< the tool's normal; m where it is not known
  std::array<Each, 3> x;        ///< object coordinates, from the origin given [m]
  alignas(64) Each aside;       ///< how far those are beneath that do not press for they face away; else 0

  bool has_aside;                  ///< any
  float deepest;                   ///< [m]
  float volume;                    ///< sum of depth by area [m^3]
  Vec3<float> volume_x, volume_m;  ///< sums of x and of m by these

  /// Its k-th point, `i` of the tool, of which TouchingPoint::group and shifted are given.
  [[nodiscard]] TouchingPoint point(std::size_t k, std::uint32_t i, std::uint32_t group,
                                    float shifted) const noexcept {
    const auto at = [k](const auto& v) { return Vec3<float>(v[0][k], v[1][k], v[2][k]); };
    return {i, depth[k], at(x), at(m), at(outward), group, shifted};
  }
};

/// Normals and areas of the tool's points, for registers.
template <Real S>
class ToolSurface {
 public:
  using V = VectorList::V;

  explicit ToolSurface(const ToolPoints<S>& tool) : has_normals_(!tool.vector_areas().empty()) {
    const std::size_t padded = (tool.size() + batch_size - 1) / batch_size * batch_size;
    area_.resize(padded);
    for (std::size_t i = 0; i < tool.size(); ++i) area_[i] = static_cast<float>(tool.area(i));
    if (!has_normals_) return;
    normal_.resize(padded);
    for (std::size_t i = 0; i < tool.size(); ++i) {
      const Vec3<S>& a = tool.vector_areas()[i];
      const S length = a.norm();
      if (length > S(0)) normal_.set(i, (a / length).template cast<float>());
    }
  }

  /// Points from `begin` on at `x`, as deep in the body as `in` says; `rotation`: of the tool.
  [[nodiscard]] TouchingLeaf find(std::size_t begin, const Mat3<float>& rotation, const PointBatch<S>& x,
                                  const PenetrationBatch<S>& in, const Vec3<S>& origin) const noexcept {
    TouchingLeaf leaf;
    using Limits = std::numeric_limits<float>;
    const V zero(0.f), tiny((Limits::min)()), most((Limits::max)());
    V deepest = zero, volume = zero, most_aside = zero;
    SimdVec3<V> volume_x{}, volume_m{};
    for (std::size_t k = 0; k < batch_size; k += V::size()) {
      using Wide = Simd<S, static_cast<int>(V::size())>;
      const auto numbers = [k](const auto& from, S less)
                               PALPATE_INLINE_LAMBDA { return V(simd_cast<float>(Wide(&from[k]) - less)); };
      const auto store = [k](const SimdVec3<V>& v, auto& to) PALPATE_INLINE_LAMBDA {
        v.x.copy_to(&to[0][k]), v.y.copy_to(&to[1][k]), v.z.copy_to(&to[2][k]);
      };
      const SimdVec3<V> gradient{numbers(in.gradient_x, S(0)), numbers(in.gradient_y, S(0)),
                                 numbers(in.gradient_z, S(0))},
          position{numbers(x.x, origin.x()), numbers(x.y, origin.y()), numbers(x.z, origin.z())};
      const V length2 = dot(gradient, gradient);
      const auto has_normal = length2 > tiny && length2 < most;
      const V per_length = -inverse_sqrt((max)(length2, tiny));
      const SimdVec3<V> m{select(has_normal, per_length * gradient.x, zero),
                          select(has_normal, per_length * gradient.y, zero),
                          select(has_normal, per_length * gradient.z, zero)};
      V depth = select(has_normal, (max)(numbers(in.depth, S(0)), zero), zero);
      SimdVec3<V> outward = m;
      V aside = zero;
      if (has_normals_) {
        const SimdVec3<V> n = normal_.load(begin + k);
        const auto row = [&](Eigen::Index r) PALPATE_INLINE_LAMBDA {
          return V(rotation(r, 0)) * n.x + V(rotation(r, 1)) * n.y + V(rotation(r, 2)) * n.z;
        };
        outward = {row(0), row(1), row(2)};
        const V facing = facing_share(dot(outward, m));
        aside = select(facing > zero, zero, depth);
        depth *= facing;
      }
      deepest = (max)(deepest, depth), most_aside = (max)(most_aside, aside);
      const V weight = depth * V(&area_[begin + k]);
      volume += weight, volume_x += weight * position, volume_m += weight * m;
      depth.copy_to(&leaf.depth[k]), aside.copy_to(&leaf.aside[k]);
      store(position, leaf.x), store(m, leaf.m), store(outward, leaf.outward);
    }
    leaf.has_aside = reduce_max(most_aside) > 0;
    leaf.deepest = reduce_max(deepest), leaf.volume = reduce(volume);
    leaf.volume_x = sum_of(volume_x), leaf.volume_m = sum_of(volume_m);
    return leaf;
  }

 private:
  bool has_normals_;
  VectorList normal_;
  AlignedList<float> area_;
};

}  // namespace palpate::detail
