// SPDX-License-Identifier: MIT
#pragma once

/// @file  Phong displacement: the paper's interpolation (V.A.2).

#include <palpate/core/simd.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/luo_xiao/interpolation/concept.hpp>
#include <palpate/luo_xiao/interpolation/detail/face_weights.hpp>
#include <palpate/luo_xiao/interpolation/detail/vector_load.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace palpate {

/// Magnitude |u| and displacement angle theta (between u and the outward normal) of the corners, interpolated
/// linearly over each face: an extension of Phong shading.
///
///     |u| = sum_i w_i |u_i|                    theta = sum_i w_i g_i theta_i / sum_i w_i g_i
///     u = |u| (cos theta n + sin theta t)      t = (sum_i w_i g_i s_i) projected across n, normalised
///
/// | symbol  | name                    | unit | range                                                    |
/// |---------|-------------------------|------|----------------------------------------------------------|
/// | u_i     | corners, and D          | m    | at most 1e6; otherwise nothing moves                     |
/// | theta_i | displacement angle      | rad  | [0, pi], between u_i and the normal at corner i          |
/// | s_i     | tangential part         | -    | of u_i/|u_i| at corner i                                 |
/// | n       | `partition().normal()`  | -    | undeformed surface's at the vertex                       |
/// | g_i     | weight of a direction   | -    | min(1, 16 |u_i| / max_j |u_j|): a corner of zero         |
/// |         |                         |      | displacement has no direction; g avoids a jump there     |
/// | w_i     | weights                 | -    | of `FacePartition`, the contact's among them             |
///
/// Where the tangential directions cancel, t is undefined. sin theta t is then at most 4 |sum w g s| / sum w
/// g long, and the missing part e of sin theta is taken from the linear interpolation L of the vectors: u =
/// (1 - e) |u| (...) + e L. The factors 16 and 4 are chosen: they bound how fast the direction may turn as a
/// corner or the sum of directions passes through zero (docs/shape.md, continuity in time).
///
/// Limits: not linear in the load; a rigid translation is not reproduced (its angle to the normal differs
/// from corner to corner); |u| is never above the max of the corners. Source: [luo2005], V.A.2; azimuth, g_i
/// and the fall-back are this library's reading (docs/shape.md).
template <Real S>
class PhongInterpolation {
 public:
  using Scalar = S;

  /// The terms of a corner that are summed with its weight: |u|, g, g theta, g s (3), u (3).
  static constexpr std::size_t terms = 9;
  using Corner = std::array<S, terms>;

  struct Load {
    bool active = false;
    PointWeights<S> at;
    std::array<Corner, max_extremal_points> corner;  // read for active loads only
    Corner contact{};
  };

  explicit PhongInterpolation(FacePartition<S> partition) : partition_(std::move(partition)) {}

  [[nodiscard]] const FacePartition<S>& partition() const noexcept { return partition_; }

  void prepare(std::span<const Vec3<S>> corners, const ContactDisplacement<S>& contact,
               Load& load) const noexcept {
    load.active = false;
    const auto points = partition_.points();
    if (corners.size() != points.size() || !is_drawable(contact)) return;
    S max_size = stable_norm(contact.displacement);
    for (const Vec3<S>& u : corners) {
      if (!is_drawable(u)) return;
      max_size = (std::max)(max_size, stable_norm(u));
    }
    load.at = partition_.locate(contact.position);
    // Below 16 times the least normal number g would lose digits: nothing that a display shows.
    if (!load.at.valid || !is_finite(max_size) || !(max_size > S(16) * (std::numeric_limits<S>::min)()))
      return;
    for (std::size_t i = 0; i < corners.size(); ++i)
      load.corner[i] = terms_of(corners[i], points[i].normal, max_size);
    load.contact = terms_of(contact.displacement, contact.normal, max_size);
    load.active = true;
  }

  [[nodiscard]] bool moves(const Load& load, std::size_t face) const noexcept {
    if (!load.active) return false;
    const Face<S>& f = partition_.faces()[face];
    for (std::size_t k = 0; k < f.corners; ++k) {
      if (load.corner[f.corner[k]][magnitude] > S(0)) return true;
    }
    return load.contact[magnitude] > S(0) && partition_.share(load.at, face) > S(0);
  }

  [[nodiscard]] bool same(const Load& a, const Load& b, std::size_t face) const noexcept {
    if (!a.active || !b.active) return !moves(a, face) && !moves(b, face);
    return detail::same_values(partition_, a, b, face);
  }

  PALPATE_FLATTEN void add(const Load& load, std::size_t face, std::size_t from, std::size_t count,
                           const Lists<const S>& start, const Lists<S>& to) const noexcept {
    using namespace detail;
    const Face<S>& f = partition_.faces()[face];
    using Terms = FaceTerms<S, terms>;
    Terms value;
    for (std::size_t k = 0; k < f.corners; ++k) value.corner[k] = Terms::row(load.corner[f.corner[k]].data());
    value.contact = Terms::row(load.contact.data());
    // Several short loops: each operation of one long loop would wait for the one before it.
    Sums sum;
    with_weights(partition_, load.at, face, from, [&](const auto& weights) PALPATE_INLINE_LAMBDA {
      for (std::size_t i = 0; i < count; i += V::size()) {
        const auto w = weights.at(i);
        w.sum(value, magnitude).copy_to(&sum[magnitude][i]);
        unroll<linear - direction>([&](std::size_t k) PALPATE_INLINE_LAMBDA {
          w.sum(value, direction + k).copy_to(&sum[direction + k][i]);
        });
      }
    });
    Block<S> missing;
    find_angles(count, sum, missing);
    if (!add_directed(f, from, count, sum, missing, start, to)) return;
    with_weights(partition_, load.at, face, from, [&](const auto& weights) PALPATE_INLINE_LAMBDA {
      for (std::size_t i = 0; i < count; i += V::size()) {
        const V part(&missing[i]);
        if (!any_of(part > V{})) continue;
        const auto w = weights.at(i);
        unroll<3>([&](std::size_t axis) PALPATE_INLINE_LAMBDA {
          store(to[axis] + i, V(to[axis] + i) + part * w.sum(value, linear + axis));
        });
      }
    });
  }

 private:
  using V = detail::simd_group<S>;
  static constexpr std::size_t magnitude = 0, direction = 1, angle = 2, tangent = 3,
                               linear = 6;  // entries of a Corner
  using Sums = std::array<Block<S>, linear>;

  // Sums of g and g theta become 1 / g and cos theta; sin theta goes to `sine`.
  static PALPATE_INLINE void find_angles(std::size_t count, Sums& sum, Block<S>& sine) noexcept {
    using namespace detail;
    constexpr S tiny = (std::numeric_limits<S>::min)(), quarter = std::numbers::pi_v<S> / S(2);
    for (std::size_t i = 0; i < count; i += V::size()) {
      // Where g is 0 all magnitudes are 0.
      const V per_g = S(1) / (max)(V(&sum[direction][i]), V(tiny));
      V s, c;
      sine_and_cosine(V(&sum[angle][i]) * per_g - quarter, s, c);
      per_g.copy_to(&sum[direction][i]);
      (-s).copy_to(&sum[angle][i]);
      c.copy_to(&sine[i]);
    }
  }

  // Adds (1 - e) |u| (cos theta n + sin theta t). In: `sine` is sin theta; out: e. True if an e is > 0.
  PALPATE_INLINE bool add_directed(const Face<S>& face, std::size_t from, std::size_t count, const Sums& sum,
                                   Block<S>& sine, const Lists<const S>& start,
                                   const Lists<S>& to) const noexcept {
    using namespace detail;
    const S *const nx = partition_.normal(face, 0) + from, *const ny = partition_.normal(face, 1) + from,
                   *const nz = partition_.normal(face, 2) + from;
    V max_missing{};
    for (std::size_t i = 0; i < count; i += V::size()) {
      const V n[3] = {V(nx + i), V(ny + i), V(nz + i)};
      V t[3] = {V(&sum[tangent][i]), V(&sum[tangent + 1][i]), V(&sum[tangent + 2][i])};  // times g
      const V along_normal = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
      unroll<3>([&](std::size_t k) PALPATE_INLINE_LAMBDA { t[k] = t[k] - along_normal * n[k]; });
      const V square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2], per_length = inverse_sqrt(square);
      const V wanted = V(&sine[i]), max_per_t = S(4) * V(&sum[direction][i]);
      // Exactly 0 where sin theta is at most 4 |t|.
      const V missing = (max)(wanted - max_per_t * (square * per_length), V{});
      const V size = V(&sum[magnitude][i]) * (S(1) - missing);
      const V along = size * V(&sum[angle][i]), aside = size * (min)(wanted * per_length, max_per_t);
      missing.copy_to(&sine[i]);
      max_missing = (max)(max_missing, missing);
      unroll<3>([&](std::size_t k) PALPATE_INLINE_LAMBDA {
        (V(start[k] + i) + (along * n[k] + aside * t[k])).copy_to(to[k] + i);
      });
    }
    return any_of(max_missing > V{});
  }

  static Corner terms_of(const Vec3<S>& u, const Vec3<S>& normal, S max_size) noexcept {
    const S size = stable_norm(u);
    if (!(size > (std::numeric_limits<S>::min)())) return {};
    const Vec3<S> n = unit_or<S>(normal, Vec3<S>::UnitY()), unit = u / size, s = tangential(unit, n);
    const S g = (std::min)(S(1), S(16) * size / max_size), theta = std::atan2(s.norm(), unit.dot(n));
    return {size, g, g * theta, g * s.x(), g * s.y(), g * s.z(), u.x(), u.y(), u.z()};
  }

  FacePartition<S> partition_;
};

static_assert(BlockInterpolation<PhongInterpolation<float>> &&
              BlockInterpolation<PhongInterpolation<double>>);

}  // namespace palpate
