// SPDX-License-Identifier: MIT
#pragma once

/// @file The leaves of a tool's points that touch, and how deep.

#include <palpate/core/pose.hpp>
#include <palpate/detection/candidates.hpp>
#include <palpate/geometry/concept.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace palpate::detail {

/// Two leaves as one, and each of them again.
template <Real S>
[[nodiscard]] inline PointBatch<S, 2 * batch_size> joined(const PointBatch<S>& a,
                                                          const PointBatch<S>& b) noexcept {
  PointBatch<S, 2 * batch_size> both;
  const auto join = [](const std::array<S, batch_size>& first, const std::array<S, batch_size>& second,
                       auto& to) {
    std::memcpy(to.data(), first.data(), sizeof first);
    std::memcpy(to.data() + batch_size, second.data(), sizeof second);
  };
  join(a.x, b.x, both.x), join(a.y, b.y, both.y), join(a.z, b.z, both.z);
  return both;
}
template <Real S>
[[nodiscard]] inline PenetrationBatch<S> part(const PenetrationBatch<S, 2 * batch_size>& both,
                                              std::size_t k) noexcept {
  PenetrationBatch<S> one;
  const auto take = [k](const auto& from, std::array<S, batch_size>& to) {
    std::memcpy(to.data(), from.data() + k * batch_size, sizeof to);
  };
  take(both.depth, one.depth);
  take(both.gradient_x, one.gradient_x);
  take(both.gradient_y, one.gradient_y);
  take(both.gradient_z, one.gradient_z);
  return one;
}

/// Calls visit(begin, x, in) for every leaf of the tool with a point inside the surface: `batch_size` points
/// from `begin` on, depth <= 0 for those that do not touch. Leaves are measured at once where the surface
/// can, two of them where it can that. `moved(x)` puts a leaf's points where the surface is asked and gives
/// them to visit(), no farther than `margin` [m] away.
template <ContactSurface Object, Real S, class Visit, class Moved>
inline void for_each_touching_leaf(const ToolPoints<S>& tool, const Pose<S>& X, const Object& object,
                                   const Visit& visit, const Moved& moved, S margin) noexcept {
  const auto offer = [&](std::uint32_t begin, std::uint32_t count, const PointBatch<S>& x,
                         PenetrationBatch<S>& in) noexcept {
    for (std::uint32_t i = count; i < x.x.size(); ++i)  // the last leaf is filled up with a point of its own
      in.depth[i] = in.gradient_x[i] = in.gradient_y[i] = in.gradient_z[i] = S(0);
    if (max_of(in.depth) > S(0)) visit(begin, x, in);
  };
  if constexpr (HasPenetrationBatch<Object, 2 * batch_size>) {
    struct Leaf {
      std::uint32_t begin, count;
      PointBatch<S> x;
    };
    std::array<Leaf, 2> leaf;
    std::size_t leaves = 0;
    for_each_candidate_leaf(
        tool, X, object,
        [&](std::uint32_t begin, std::uint32_t count, const PointBatch<S>& x) noexcept {
          leaf[leaves] = {begin, count, moved(x)};
          if (++leaves < leaf.size()) return;
          leaves = 0;
          PenetrationBatch<S, 2 * batch_size> both;
          object.penetration(joined(leaf[0].x, leaf[1].x), both);
          for (std::size_t k = 0; k < leaf.size(); ++k) {
            PenetrationBatch<S> in = part(both, k);
            offer(leaf[k].begin, leaf[k].count, leaf[k].x, in);
          }
        },
        margin);
    if (leaves == 0) return;
    PenetrationBatch<S> in;
    object.penetration(leaf[0].x, in);
    offer(leaf[0].begin, leaf[0].count, leaf[0].x, in);
  } else {
    for_each_candidate_leaf(
        tool, X, object,
        [&](std::uint32_t begin, std::uint32_t count, const PointBatch<S>& at) noexcept {
          const PointBatch<S> x = moved(at);
          PenetrationBatch<S> in;
          if constexpr (HasPenetrationBatch<Object>)
            object.penetration(x, in);
          else
            penetrate_one_by_one(object, x, in, 0, count);
          offer(begin, count, x, in);
        },
        margin);
  }
}
template <ContactSurface Object, Real S, class Visit>
inline void for_each_touching_leaf(const ToolPoints<S>& tool, const Pose<S>& X, const Object& object,
                                   const Visit& visit) noexcept {
  for_each_touching_leaf(
      tool, X, object, visit, [](const PointBatch<S>& x) noexcept -> const PointBatch<S>& { return x; },
      S(0));
}

}  // namespace palpate::detail
