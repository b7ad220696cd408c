// SPDX-License-Identifier: MIT
#pragma once

/// @file The mean regular displacement of a body beneath a tool: what the tool touches lay so far beside.

#include <palpate/core/scalar.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/geometry/concept.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::detail {

/// A body bends away from the tool, by more than a thin part is thick, and turns. So points are looked for at
/// X - v, and a point's depth is m.v - 1/2 g.v more, of the last tick's regular displacements w_i and normal
/// loads q_i:
///
///     v = share (mean - 1/2 (m.mean) g),   share = max(1 - 2 s/|mean|, 0)
///
/// mean, s: of w_i by q_i, and its deviation; of a tool that touches at several places v is no more than the
/// displacement of any. g: slope of m.w along the surface (regular_gradient.hpp), by which the body turns.
/// What turns by g moves on an arc: to the second order by -1/2 (m.mean) g along the surface, and by
/// 1/2 g.mean away from the tool, of which the linear field knows nothing. With friction g counts as 0: no
/// reference tells how far a body sinks that friction turns away from beneath a tool. Where the tool does not
/// touch yet the shift fades,
///
///     phi(x) v,   phi = 1/(1 + (r^2/L^2)^2),   L = 4 sqrt(A + v^2)
///
/// r: from the middle of the loads, A: their area; L is chosen. On v along m no force depends: it only
/// chooses which points are found, and where on the surface. What is across m tells which part of the body
/// lies beneath the tool. Without it a ball beside the middle of a bent body's hollow has 10 % of error, and
/// 36 % in its side force; with it 2 and 10 %. Without the arc a post that bends by a quarter of its
/// thickness is 9 % too stiff, with it 2 % (finite elements).
template <Real S>
class BodyShift {
 public:
  using V = VectorList::V;
  static constexpr bool active = true;

  void forget() noexcept { v_ = turn_ = Vec3<float>::Zero(), has_settled_ = true; }
  /// Whether another tick at the same pose would find the same points.
  [[nodiscard]] bool has_settled() const noexcept { return has_settled_; }
  /// After a solve with normal loads q and regular displacements w of the slope g; positions are relative to
  /// `origin` [m]. `moved`: by the tool in this tick; what begins deep in the body finds its points over some
  /// ticks.
  void measure(const PointSystem& system, const float* q, const VectorList& w, const Vec3<float>& g,
               const Vec3<S>& origin, float moved) noexcept {
    V loads{}, areas{}, along{};
    SimdVec3<V> sum{}, positions{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i);
      loads += qi, positions += qi * system.positions().load(i);
      areas += select(qi > V(0.f), V(system.areas() + i), V(0.f));
      const SimdVec3<V> displaced = qi * w.load(i);
      sum += displaced, along += dot(system.directions().load(i), displaced);
    }
    const float load = reduce(loads);
    if (!(load > 0)) return forget();
    const Vec3<float> mean = sum_of(sum) / load;
    const float size = mean.norm();
    if (!(size > 0) || !is_finite(size)) return forget();
    V squares{};  // about the mean: of equal numbers it is 0 to rounding, not to its root
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const SimdVec3<V> from = w.load(i) - each<V>(mean);
      squares += V(q + i) * dot(from, from);
    }
    const float deviation = std::sqrt(reduce(squares) / load);
    const float share = (std::max)(1 - reach * deviation / size, 0.f);
    const Vec3<float> target = share * (mean - reduce(along) / (2 * load) * g), change = target - v_;
    const float most = 2 * moved + slowly * (system.deepest() + v_.norm()), length = change.norm();
    has_settled_ = length <= settled * target.norm();
    const bool grows = target.squaredNorm() > v_.squaredNorm();
    v_ += grows && length > most ? Vec3<float>(most / length * change) : change;
    middle_ = origin + (sum_of(positions) / load).template cast<S>() + v_.template cast<S>();
    area_ = reduce(areas);
    turn_ = g;
  }
  /// After `tries` looks in vain, the tool having come back in a tick: v is less by an eighth of what it was.
  /// False at the end, where v is 0. At once from 0 a part that is thinner than the tool was deep would be
  /// met from its far side.
  [[nodiscard]] bool come_back(int tries) noexcept {
    if (tries > most_tries || v_.isZero(0)) return false;
    v_ *= float(most_tries - tries) / float(most_tries + 1 - tries);
    return true;
  }
  /// v [m]
  [[nodiscard]] const Vec3<float>& v() const noexcept { return v_; }
  /// By how much a point is deeper, over phi, that presses along m [m].
  [[nodiscard]] float deeper(const Vec3<float>& m) const noexcept { return (m - 0.5f * turn_).dot(v_); }
  /// phi at x in object coordinates.
  [[nodiscard]] float share_at(const Vec3<S>& x) const noexcept {
    const float r2 = static_cast<float>((x - middle_).squaredNorm()),
                far = r2 / (16 * (area_ + v_.squaredNorm()) + (std::numeric_limits<float>::min)());
    return 1 / (1 + far * far);
  }
  /// At least |phi v| anywhere [m].
  [[nodiscard]] S most() const noexcept { return static_cast<S>(v_.norm()); }
  /// A leaf of the tool's points over the undeformed surface.
  [[nodiscard]] PointBatch<S> before(const PointBatch<S>& now) const noexcept {
    const S phi = static_cast<S>(share_at({now.x[0], now.y[0], now.z[0]}));
    return less(now, Vec3<S>(phi * v_.template cast<S>()));
  }
  /// Of a displacement a across m, what v does not contain.
  [[nodiscard]] Vec3<float> own(const Vec3<float>& a, const Vec3<float>& m, float phi) const noexcept {
    return a - phi * (v_ - m.dot(v_) * m);
  }

 private:
  static constexpr int most_tries = 8;
  static constexpr float settled = 1e-3f;  // of v, which hardly changes what it chooses
  static constexpr float slowly = 0.01f;   // of the depth in a tick: no force is felt to change
  static constexpr float reach = 2;        // deviations, as for others' loads (loads_beside.hpp)

  Vec3<float> v_ = Vec3<float>::Zero(), turn_ = Vec3<float>::Zero();  // turn_: g
  Vec3<S> middle_ = Vec3<S>::Zero();                                  // object coordinates
  float area_ = 0;
  bool has_settled_ = true;
};

/// Of a half-space, which has no regular displacements.
struct NoBodyShift {
  static constexpr bool active = false;
  static void forget() noexcept {}
  [[nodiscard]] static bool has_settled() noexcept { return true; }
  [[nodiscard]] static bool come_back(int) noexcept { return false; }
  [[nodiscard]] static Vec3<float> v() noexcept { return Vec3<float>::Zero(); }
  [[nodiscard]] static float deeper(const auto& /*m*/) noexcept { return 0; }
  [[nodiscard]] static float share_at(const auto&) noexcept { return 0; }
  [[nodiscard]] static int most() noexcept { return 0; }
  [[nodiscard]] static const auto& before(const auto& x) noexcept { return x; }
  [[nodiscard]] static const auto& own(const auto& a, const auto& /*m*/, float) noexcept { return a; }
};

}  // namespace palpate::detail
