// SPDX-License-Identifier: MIT
#pragma once

/// @file  Any body's depth from samples on a grid: a few dozen instructions per point, whatever the body.

#include <palpate/core/error.hpp>
#include <palpate/core/simd_shuffle.hpp>
#include <palpate/geometry/concept.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

/// What can be sampled: signed distance, and a box around the body.
template <class B>
concept SampledBody = HasClosest<B> && HasReach<B> && requires(const B& body) {
  { body.lower() } noexcept -> std::same_as<Vec3<typename B::Scalar>>;
  { body.upper() } noexcept -> std::same_as<Vec3<typename B::Scalar>>;
};

/// Depth of a body from its signed distance d at the nodes of a grid, for scenes where the body's own
/// penetration() is too slow: meshes, superellipsoids.
///
/// | symbol | name      | unit | range                                                         |
/// |--------|-----------|------|---------------------------------------------------------------|
/// | w      | `spacing` | m    | > 0, no default; at most 50 million nodes over the body's box |
///
///     depth(x) = - sum_i B((x - x_i) / w) c_i,   c = f - (1/8) (dx^2 + dy^2 + dz^2) f, f = min(d, 8 w)
///
/// B is the product of three quadratic B-splines, dx^2 the second difference. The field and its derivative
/// are continuous, and `gradient` is the exact derivative of `depth`: unlike a shading normal the force has
/// no curl, so a closed path gains no energy. Where d is smooth the error is of order w^3 in depth and w^2 in
/// direction [deboor1978]; edges of the mesh and of the body are rounded over about w, and parts thinner than
/// about 2 w lose depth (|depth + d| <= 1.62 w anywhere: d has slope at most 1, and so has each term).
/// Samples are float, in units of w: depth is rounded to about 1e-7 of the body's size, in any unit alike.
///
/// closest() is the body's own. Set-up asks it once for each node inside and near the body; a bad spacing is
/// reported. A query that is not finite: no contact, not separated.
template <SampledBody B>
class SampledSurface {
 public:
  using Scalar = typename B::Scalar;
  using S = Scalar;

  struct Params {
    S spacing{};  ///< w [m]
  };

  SampledSurface(B body, const Params& params) : body_(std::move(body)), w_(params.spacing) {
    require_positive(w_, "SampledSurface", "spacing [m] must be > 0");
    per_w_ = S(1) / w_;
    const Vec3<S> extent = body_.upper() - body_.lower();
    S nodes = S(1);
    for (int k = 0; k < 3; ++k) {
      // A node's own cell reaches half a spacing to each side, its spline one more; blocks are whole.
      const S n = std::ceil(extent[k] / w_ / S(4)) + S(2);
      nodes *= S(4) * n;
      if (!(nodes <= S(5e7L)))  // chosen: 200 MB
        fail("SampledSurface", "spacing [m] asks for more than 50 million nodes", static_cast<double>(w_));
      blocks_[static_cast<std::size_t>(k)] = static_cast<std::size_t>(n);
      middle_[static_cast<std::size_t>(k)] = S(2) * n - S(1);
    }
    const Vec3<S> blocks(static_cast<S>(blocks_[0]), static_cast<S>(blocks_[1]), static_cast<S>(blocks_[2]));
    origin_ = body_.lower() + extent / S(2) - (S(2) * blocks - Vec3<S>::Constant(S(0.5L))) * w_;
    row_ = 4 * blocks_[0];
    layer_ = row_ * 4 * blocks_[1];
    sample();
    slope_ = steepest();
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept { return body_.closest(x); }

  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Penetration<S> none{S(0), Vec3<S>::Zero()};
    std::array<std::size_t, 3> node;
    std::array<float, 3> t;
    if (!locate(x, node, t)) return none;
    const float* const at = &field_[index(node)];
    if (*at > clear) return none;
    const Spline<float> wx(t[0]);
    const Rows rows = rows_around(at, Spline<float>(t[1]), Spline<float>(t[2]));
    const float d = wx.sum(rows.value);
    if (!(d < 0.0f)) return none;
    return {-w_ * static_cast<S>(d),
            Vec3<S>(static_cast<S>(wx.slope_sum(rows.value)), static_cast<S>(wx.sum(rows.along_y)),
                    static_cast<S>(wx.sum(rows.along_z)))};
  }

  /// The same of a batch.
  void penetration(const PointBatch<S>& x, PenetrationBatch<S>& in) const noexcept {
    using V = detail::batch_simd<S>;
    std::array<std::array<S, batch_size>, 3> u;  // from the first node, in units of w
    std::array<std::array<float, batch_size>, 3> t;
    std::array<double, batch_size> at;  // whole numbers below 2^53
    for (std::size_t i = 0; i < batch_size; i += V::size()) {
      const detail::SimdVec3<V> from_first = per_w_ * detail::load_from<V>(x, i, origin_);
      const std::array<V, 3> from{from_first.x, from_first.y, from_first.z};
      std::array<V, 3> node;
      for (std::size_t k = 0; k < 3; ++k) {
        node[k] = floor(from[k] + S(0.5L));
        detail::store(&u[k][i], from[k]);
        detail::store(&t[k][i], detail::simd_cast<float>(from[k] - node[k]));
      }
      detail::store(&at[i], detail::simd_cast<double>(node[0]) +
                                static_cast<double>(row_) * detail::simd_cast<double>(node[1]) +
                                static_cast<double>(layer_) * detail::simd_cast<double>(node[2]));
    }
    const SplineBatch wx(t[0]), wy(t[1]), wz(t[2]);
    std::array<Rows, batch_size> rows;
    for (std::size_t i = 0; i < batch_size; ++i) {
      rows[i] = Rows{};
      if (!has_cell(Vec3<S>(u[0][i], u[1][i], u[2][i]))) continue;
      const float* const here = &field_[static_cast<std::size_t>(at[i])];
      if (*here > clear) continue;
      rows[i] = rows_around(here, wy.at(i), wz.at(i));
    }
    for (std::size_t i = 0; i < batch_size; i += Four::size()) {
      const Spline<Four> w = wx.four(i);
      const auto value = columns(rows, i, &Rows::value);
      const auto put = [i](const Four& v, std::array<S, batch_size>& out)
                           PALPATE_INLINE_LAMBDA { detail::store(&out[i], detail::simd_cast<S>(v)); };
      detail::store(&in.depth[i], detail::simd_cast<S>((detail::max)(-w.sum(value), 0.0f)) * w_);
      put(w.slope_sum(value), in.gradient_x);
      put(w.sum(columns(rows, i, &Rows::along_y)), in.gradient_y);
      put(w.sum(columns(rows, i, &Rows::along_z)), in.gradient_z);
    }
  }

  /// True only if penetration() is 0 all over the ball (c, r); false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    if (!is_finite(c) || !is_finite(r) || r < S(0)) return false;
    const Vec3<S> away = (body_.lower() - c).cwiseMax(c - body_.upper()).cwiseMax(S(0));
    const S apart = r + S(1.63L) * w_;  // 1.62 w and its rounding
    // One coordinate first, so that nothing overflows.
    if (away.maxCoeff() > apart || away.squaredNorm() > apart * apart) return true;
    std::array<std::size_t, 3> node;
    std::array<float, 3> t;
    if (!locate(c, node, t)) return false;
    const std::array<std::size_t, 3> b{node[0] / 4, node[1] / 4, node[2] / 4};
    const S block = w_ * static_cast<S>(block_[(b[2] * blocks_[1] + b[1]) * blocks_[0] + b[0]]);
    if (block - (c - centre(b)).norm() > apart) return true;
    // On the way to a point inside the field falls to 0, no faster than by its slope. It is not worked out
    // where the nearest coefficient, and a spacing more, would be too little.
    const float* const at = &field_[index(node)];
    if (w_ * (static_cast<S>(*at) + S(1)) <= slope_ * r) return false;
    const Rows rows = rows_around(at, Spline<float>(t[1]), Spline<float>(t[2]));
    const S field = w_ * static_cast<S>(Spline<float>(t[0]).sum(rows.value));
    return field > slope_ * (r + S(1e-3L) * w_);  // of floats below 8
  }

  [[nodiscard]] S reach() const noexcept { return body_.reach(); }
  [[nodiscard]] S spacing() const noexcept { return w_; }
  [[nodiscard]] const B& body() const noexcept { return body_; }

 private:
  using Four = detail::Simd4;

  // A coefficient is within 0.75 w of its sample, the nearest sample is within 0.87 w, and the field within
  // 1.62 w of d, together 3.24 w: a coefficient of more than `clear` has no contact in its cell. `far` is
  // chosen: more than that, and few enough nodes.
  static constexpr float clear = 3.25f;
  static constexpr S far = S(8);  // of samples that do not count

  /// The three quadratic B-splines that are not 0 at an offset t in [-1/2, 1/2] from a node, and their
  /// derivatives.
  template <class T>
  struct Spline {
    std::array<T, 3> value, slope;
    Spline() = default;
    PALPATE_INLINE explicit Spline(const T& t) noexcept {
      const T a = 0.5f - t, b = 0.5f + t;
      value = {0.5f * a * a, 0.75f - t * t, 0.5f * b * b};
      slope = {-a, -2.0f * t, b};
    }
    /// Over three nodes.
    template <class V>
    [[nodiscard]] PALPATE_INLINE T sum(const V& v) const noexcept {
      return v[0] * value[0] + v[1] * value[1] + v[2] * value[2];
    }
    template <class V>
    [[nodiscard]] PALPATE_INLINE T slope_sum(const V& v) const noexcept {
      return v[0] * slope[0] + v[1] * slope[1] + v[2] * slope[2];
    }
  };

  /// The splines of a batch of offsets.
  struct SplineBatch {
    std::array<std::array<float, batch_size>, 3> value, slope;

    PALPATE_INLINE explicit SplineBatch(const std::array<float, batch_size>& t) noexcept {
      using V = detail::batch_simd<float>;
      for (std::size_t i = 0; i < batch_size; i += V::size()) {
        const Spline<V> w{V(&t[i])};
        for (std::size_t k = 0; k < 3; ++k)
          detail::store(&value[k][i], w.value[k]), detail::store(&slope[k][i], w.slope[k]);
      }
    }
    [[nodiscard]] PALPATE_INLINE Spline<float> at(std::size_t i) const noexcept {
      Spline<float> w;
      for (std::size_t k = 0; k < 3; ++k) w.value[k] = value[k][i], w.slope[k] = slope[k][i];
      return w;
    }
    [[nodiscard]] PALPATE_INLINE Spline<Four> four(std::size_t i) const noexcept {
      Spline<Four> w;
      for (std::size_t k = 0; k < 3; ++k) w.value[k] = Four(&value[k][i]), w.slope[k] = Four(&slope[k][i]);
      return w;
    }
  };

  /// Sums over y and z of the nodes around a point, by nodes along x, of which the first three count.
  struct Rows {
    Four value, along_y, along_z;  // field, and derivatives by offsets
  };
  [[nodiscard]] PALPATE_INLINE Rows rows_around(const float* node, const Spline<float>& wy,
                                                const Spline<float>& wz) const noexcept {
    Rows rows{};
    const float* from = node - layer_ - row_ - 1;
    for (std::size_t k = 0; k < 3; ++k, from += layer_) {
      const std::array<Four, 3> in{Four(from), Four(from + row_), Four(from + 2 * row_)};
      const Four value = wy.value[0] * in[0] + wy.value[1] * in[1] + wy.value[2] * in[2];
      rows.value += wz.value[k] * value;
      rows.along_y += wz.value[k] * (wy.slope[0] * in[0] + wy.slope[1] * in[1] + wy.slope[2] * in[2]);
      rows.along_z += wz.slope[k] * value;
    }
    return rows;
  }
  /// A sum of four points by nodes instead of by points.
  [[nodiscard]] PALPATE_INLINE static std::array<Four, 3> columns(const std::array<Rows, batch_size>& rows,
                                                                  std::size_t i, Four Rows::*of) noexcept {
    Four a = rows[i].*of, b = rows[i + 1].*of, c = rows[i + 2].*of, d = rows[i + 3].*of;
    detail::transpose(a, b, c, d);
    return {a, b, c};
  }

  /// Middle of a block of 4 x 4 x 4 nodes.
  [[nodiscard]] Vec3<S> centre(const std::array<std::size_t, 3>& b) const noexcept {
    return origin_ + w_ * Vec3<S>(S(4) * static_cast<S>(b[0]) + S(1.5L),
                                  S(4) * static_cast<S>(b[1]) + S(1.5L),
                                  S(4) * static_cast<S>(b[2]) + S(1.5L));
  }

  /// Is the point at u, in units of w from the first node, far enough from the rim? False if not finite.
  [[nodiscard]] PALPATE_INLINE bool has_cell(const Vec3<S>& u) const noexcept {
    return is_within(u[0] - middle_[0], middle_[0] - S(0.5L)) &&
           is_within(u[1] - middle_[1], middle_[1] - S(0.5L)) &&
           is_within(u[2] - middle_[2], middle_[2] - S(0.5L));
  }
  /// Nearest node and the offset from it in units of w; false near and past the rim.
  [[nodiscard]] bool locate(const Vec3<S>& x, std::array<std::size_t, 3>& node,
                            std::array<float, 3>& t) const noexcept {
    const Vec3<S> u = (x - origin_) * per_w_;
    if (!has_cell(u)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const S at = u[static_cast<int>(k)];
      node[k] = static_cast<std::size_t>(at + S(0.5L));
      t[k] = static_cast<float>(at - static_cast<S>(node[k]));
    }
    return true;
  }
  [[nodiscard]] std::size_t index(const std::array<std::size_t, 3>& node) const noexcept {
    return node[2] * layer_ + node[1] * row_ + node[0];
  }

  /// A bound of the field's slope outside the body. In a node's cell its derivative along an axis is a mean
  /// of differences of neighbouring coefficients, weighted by B-splines, and no more than the largest.
  [[nodiscard]] S steepest() const {
    const std::array<std::size_t, 3> step{1, row_, layer_};
    float most2 = 0;
    for (std::size_t z = 1; z + 1 < 4 * blocks_[2]; ++z) {
      for (std::size_t y = 1; y + 1 < 4 * blocks_[1]; ++y) {
        for (std::size_t x = 1; x + 1 < 4 * blocks_[0]; ++x) {
          const float* const node = &field_[index({x, y, z})];
          float slope2 = 0, highest = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t along = step[k], across = step[(k + 1) % 3], up = step[(k + 2) % 3];
            float most = 0;
            for (std::size_t i = 0; i < 9; ++i) {
              const float* const at = node - across - up + i % 3 * across + i / 3 * up;
              const float before = *(at - along), here = *at, after = *(at + along);
              most = (std::max)({most, std::abs(here - before), std::abs(after - here)});
              highest = (std::max)({highest, before, here, after});
            }
            slope2 += most * most;
          }
          if (highest > 0) most2 = (std::max)(most2, slope2);
        }
      }
    }
    return static_cast<S>(std::sqrt(most2));
  }

  void sample() {
    const std::array<std::size_t, 3> n{4 * blocks_[0], 4 * blocks_[1], 4 * blocks_[2]};
    std::vector<float> f(layer_ * n[2], static_cast<float>(far));
    for (std::size_t c = 0; c < blocks_[2]; ++c) {
      for (std::size_t b = 0; b < blocks_[1]; ++b) {
        for (std::size_t a = 0; a < blocks_[0]; ++a) {
          const S d = body_.closest(centre({a, b, c})).distance;
          block_.push_back(static_cast<float>(d * per_w_));
          // The farthest node of a block is sqrt(3) 1.5 w = 2.6 w from its middle.
          if (d > (far + S(2.6L)) * w_) continue;
          for (std::size_t i = 0; i < 64; ++i) {
            const std::size_t x = 4 * a + i % 4, y = 4 * b + i / 4 % 4, z = 4 * c + i / 16;
            const Vec3<S> at =
                origin_ + w_ * Vec3<S>(static_cast<S>(x), static_cast<S>(y), static_cast<S>(z));
            f[index({x, y, z})] = static_cast<float>((std::min)(body_.closest(at).distance * per_w_, far));
          }
        }
      }
    }
    // The rim keeps its samples: the body is farther from it than splines reach. Rows are read four at a
    // time.
    field_ = f;
    field_.push_back(0.0f);
    for (std::size_t z = 1; z + 1 < n[2]; ++z) {
      for (std::size_t y = 1; y + 1 < n[1]; ++y) {
        for (std::size_t x = 1; x + 1 < n[0]; ++x) {
          const std::size_t i = index({x, y, z});
          field_[i] =  // c of the formula above, 1.75 = 1 + 6/8
              f[i] * 1.75f -
              (f[i - 1] + f[i + 1] + f[i - row_] + f[i + row_] + f[i - layer_] + f[i + layer_]) / 8.0f;
        }
      }
    }
  }

  B body_;
  S w_, per_w_;
  Vec3<S> origin_;                     // the first node
  std::array<std::size_t, 3> blocks_;  // along each axis
  std::array<S, 3> middle_;            // of the grid, in units of w from the first node
  std::size_t row_, layer_;            // nodes in each
  S slope_{};                          // of the field outside, at most
  std::vector<float> field_;           // c/w, x fastest
  std::vector<float> block_;           // d/w at the middle of each block
};

}  // namespace palpate
