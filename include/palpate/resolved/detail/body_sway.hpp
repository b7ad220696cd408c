// SPDX-License-Identifier: MIT
#pragma once

/// @file The P-delta effect: a body under a load is more compliant sideways. Second order in displacement.

#include <palpate/core/simd_math.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/point_system.hpp>
#include <palpate/resolved/detail/touching_point.hpp>
#include <palpate/resolved/detail/vector_list.hpp>
#include <palpate/response/setup/element_mesh.hpp>
#include <palpate/response/setup/mesh_edges.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace palpate::detail {

/// A body that is moved sideways moves on an arc about where it is fixed, and the load that presses it does
/// work on that arc: as a column towards buckling it is more compliant sideways (P-delta effect, geometric
/// stiffness). The energy of that is, with the sum F of the loads, h from the contact to the middle of the
/// fixed region, and w_h what is across h of the contact's mean regular displacement w, others' loads
/// included,
///
///     -kappa/2 (F.h/D) w_h^2,   D = h^2 + s^2
///
/// for kappa = 1 that of a rigid body on a pivot, for 1.2 that of a slender column. A stout one is thicker
/// and shorter for the load, too: finite element cases with friction want 0.5 to 0.8. s^2, variance of the
/// fixed region along w_h: a wide base does not turn. So points that stick, or slip, are displaced by what
///
///     p = kappa (F.h/D) w_h,   kappa = 0.6
///
/// does, shared among the points as the normal loads are. By the mean of that across the surface: the mean
/// along the direction of pressing is in the sink below. By what is beyond the mean the surface turns, and
/// depths change. The body is drawn under loads that are p more in all. Of the last tick's loads, half of
/// what is new in a tick; C p, C the regular part in the mean, is at most half of w_h, beyond which the body
/// would buckle. A post pressed by a tenth of its height and dragged is a third too stiff without it, and the
/// torque about the ball that drags it is 17 % off where the surface does not turn. On its arc the body
/// sinks, too: the force that presses falls as the contact is dragged aside, by what the work of closed paths
/// needs. Dragged under a small load and back under a large one, a contact that sticks gave 0.6 % of the work
/// to and fro without p. With kappa = 0.6 it takes 0.1 % of it that way and the other way round; more, and it
/// would give some the other way.
class BodySway {
 public:
  using V = VectorList::V;
  BodySway(const auto& body, std::size_t points) {
    sway_.resize(AlignedList<float>::padded(points));
    const ElementMesh& mesh = body.field().mesh();
    double area = 0;
    Vec3<double> sum = Vec3<double>::Zero();
    Mat3<double> squares = Mat3<double>::Zero();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!mesh.fixed_triangle[t]) continue;
      std::array<Vec3<double>, 3> p;
      for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.vertices[mesh.triangles[t][k]];
      const double A = area_vector(p[0], p[1], p[2]).norm();
      area += A, sum += A / 3 * (p[0] + p[1] + p[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3<double> middle = (p[k] + p[(k + 1) % 3]) / 2;  // exact for squares
        squares += A / 3 * middle * middle.transpose();
      }
    }
    base_ = sum / area;
    variance_ = (squares / area - base_ * base_.transpose()).cast<float>();
  }

  void forget() noexcept { mean_.setZero(), pull_.setZero(), sways_ = false, has_settled_ = true; }
  /// After a solve with loads P, normal ones q; `given`: displacements by others' loads and by sway; feet are
  /// relative to `origin` [m].
  void measure(const PointSystem& system, const float* q, const VectorList& P, const auto& regular,
               const auto& given, const Vec3<double>& origin) noexcept {
    V loads{};
    SimdVec3<V> forces{}, feet{}, displaced{};
    for (std::size_t i = 0; i < system.stride(); i += V::size()) {
      const V qi(q + i);
      loads += qi, forces += P.load(i);
      feet += qi * system.feet().load(i);
      displaced += qi * (regular.response().load(i) + given.load(i));
    }
    const float load = reduce(loads);
    if (!(load > 0)) return forget();
    const Vec3<float> h = (base_ - origin).cast<float>() - sum_of(feet) / load,
                      all = sum_of(displaced) / load;
    const float h2 = h.squaredNorm();
    const Vec3<float> w_h = all - h.dot(all) / h2 * h;
    const float w2 = w_h.squaredNorm();
    if (!(w2 > 0) || !is_finite(w2 / h2)) return forget();
    const float per_D = kappa / (h2 + w_h.dot(variance_ * w_h) / w2);
    const Vec3<float> p = sum_of(forces).dot(h) * per_D * w_h, moved = regular.common() * p;
    const float far = moved.norm() / (most * std::sqrt(w2)), share = far > 1 ? 1 / far : 1.f;
    const Vec3<float> change = share / load * p - pull_;
    has_settled_ = (load * regular.common() * change).squaredNorm() <= settled * settled * w2;
    pull_ += change / 2;
  }
  /// The next tick's displacements, of which the depths feel what is beyond the mean: the surface turns. By
  /// the mean of the `last` two ticks' loads, or they would swing with it from tick to tick.
  void displace(PointSystem& system, const MemoryLists& last, auto& regular) noexcept {
    sways_ = !pull_.isZero(0);
    if (!sways_) return;
    const bool turns = !regular.is_left_out();
    if (turns)
      mean_ = regular.sway(
          [&](std::size_t i) {
            return (std::max)(system.direction(i).dot(last.load[i] - last.load_step[i] / 2), 0.f);
          },
          pull_);
    for (std::size_t i = 0; i < system.size(); ++i) {
      const Vec3<float> beyond = turns ? regular.swayed(i) : Vec3<float>(Vec3<float>::Zero());
      sway_.set(i, mean_ + beyond);
      system.depth[i] -= system.direction(i).dot(beyond);
    }
    for (std::size_t i = system.size(); i < system.stride(); ++i) sway_.set(i, Vec3<float>::Zero());
  }
  /// Of points i .. on [m].
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
    return sways_ ? sway_.load(i) : SimdVec3<V>{};
  }
  /// Whether another tick at the same pose would find the same.
  [[nodiscard]] bool has_settled() const noexcept { return has_settled_; }
  /// p over all normal loads [-]
  [[nodiscard]] const Vec3<float>& pull() const noexcept { return pull_; }

 private:
  static constexpr float kappa = 0.6f, most = 0.5f;  // most: of |C p| over |w_h|; both chosen, see above
  static constexpr float settled = 1e-4f;            // of w_h, by which no force is felt to change

  Vec3<double> base_;     // middle of the fixed region
  Mat3<float> variance_;  // of that [m^2]
  VectorList sway_;       // of the points
  Vec3<float> mean_ = Vec3<float>::Zero(), pull_ = Vec3<float>::Zero();
  bool sways_ = false, has_settled_ = true;
};

/// Without friction, and of a half-space.
struct NoBodySway {
  using V = VectorList::V;
  NoBodySway(const auto& /*body*/, std::size_t /*points*/) {}
  static void forget() noexcept {}
  static void measure(const auto&...) noexcept {}
  static void displace(const auto&...) noexcept {}
  [[nodiscard]] PALPATE_INLINE static SimdVec3<V> load(std::size_t) noexcept { return {}; }
  [[nodiscard]] static constexpr bool has_settled() noexcept { return true; }
  [[nodiscard]] static Vec3<float> pull() noexcept { return Vec3<float>::Zero(); }
};

/// Displacements that are not by a tick's own loads: by others' and by sway. Of points i .. on [m].
template <class Others, class Sway>
struct GivenDisplacements {
  using V = VectorList::V;
  const Others& others;
  const Sway& sway;

  [[nodiscard]] PALPATE_INLINE SimdVec3<V> load(std::size_t i) const noexcept {
    return others.load(i) + sway.load(i);
  }
};

}  // namespace palpate::detail
