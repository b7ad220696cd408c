// SPDX-License-Identifier: MIT
#pragma once

/// @file  Any body's depth from samples on a grid: a few dozen instructions per point, whatever the body.

#include <palpate/core/error.hpp>
#include <palpate/surface/concept.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {

/// What can be sampled: signed distance, and a box around the body.
template <class B>
concept SampledBody = HasClosest<B> && HasReach<B> && requires(const B& body) {
  { body.lower() }
  noexcept->std::same_as<Vec3<typename B::Scalar>>;
  { body.upper() }
  noexcept->std::same_as<Vec3<typename B::Scalar>>;
};

/// Depth of a body from its signed distance d at the nodes of a grid, for scenes where the body's own
/// penetration() is too slow: meshes, superellipsoids.
///
/// | symbol | name      | unit | range                                                                       |
/// |--------|-----------|------|-----------------------------------------------------------------------------|
/// | w      | `spacing` | m    | > 0, no default; at most 50 million nodes over the body's box               |
///
///     depth(x) = - sum_i B((x - x_i) / w) c_i,        c = f - (1/8) (dx^2 + dy^2 + dz^2) f,     f = min(d, 8 w)
///
/// B is the product of three quadratic B-splines, dx^2 the second difference. The field and its derivative are
/// continuous, and `gradient` is the exact derivative of `depth`: unlike a shading normal the force has no
/// curl, so a closed path gains no energy. Where d is smooth the error is of order w^3 in depth and w^2 in
/// direction [deboor1978]; edges of the mesh and of the body are rounded over about w, and parts thinner than
/// about 2 w lose depth (|depth + d| <= 1.62 w anywhere: d has slope at most 1, and so has each term).
/// Samples are float: depth is rounded to about 1e-7 of the body's size.
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
    const Vec3<S> extent = body_.upper() - body_.lower();
    S nodes = S(1);
    for (int k = 0; k < 3; ++k) {
      // A node's own cell reaches half a spacing to each side, its spline one more; blocks are whole.
      const S n = std::ceil(extent[k] / w_ / S(4)) + S(2);
      nodes *= S(4) * n;
      if (!(nodes <= S(5e7L)))
        fail("SampledSurface", "spacing [m] asks for more than 50 million nodes", static_cast<double>(w_));
      blocks_[static_cast<std::size_t>(k)] = static_cast<std::size_t>(n);
    }
    const Vec3<S> blocks(static_cast<S>(blocks_[0]), static_cast<S>(blocks_[1]), static_cast<S>(blocks_[2]));
    origin_ = body_.lower() + extent / S(2) - (S(2) * blocks - Vec3<S>::Constant(S(0.5L))) * w_;
    sample();
  }

  [[nodiscard]] SurfacePoint<S> closest(const Vec3<S>& x) const noexcept { return body_.closest(x); }

  [[nodiscard]] Penetration<S> penetration(const Vec3<S>& x) const noexcept {
    const Penetration<S> none{S(0), Vec3<S>::Zero()};
    std::array<std::size_t, 3> node;
    Vec3<S> t;
    if (!locate(x, node, t)) return none;
    const std::size_t row = 4 * blocks_[0], layer = row * 4 * blocks_[1];
    const float* at = &field_[(node[2] - 1) * layer + (node[1] - 1) * row + node[0] - 1];
    if (at[layer + row + 1] > clear_) return none;
    const Spline wx(t.x()), wy(t.y()), wz(t.z());
    // Sums of three rows and of three layers, four nodes along x at a time; written out, because a loop would keep
    // them in memory.
    const auto rows = [&](const float* from, const std::array<float, 3>& w) -> Lanes {
      using In = Eigen::Map<const Lanes, Eigen::Unaligned>;
      return w[0] * In(from) + w[1] * In(from + row) + w[2] * In(from + 2 * row);
    };
    const Lanes low = rows(at, wy.value), mid = rows(at + layer, wy.value),
                high = rows(at + 2 * layer, wy.value);
    const Lanes value = wz.value[0] * low + wz.value[1] * mid + wz.value[2] * high;
    const float d = sum(value, wx.value);
    if (!(d < 0.0f)) return none;
    const Lanes along_z = wz.slope[0] * low + wz.slope[1] * mid + wz.slope[2] * high;
    const Lanes along_y = wz.value[0] * rows(at, wy.slope) + wz.value[1] * rows(at + layer, wy.slope) +
                          wz.value[2] * rows(at + 2 * layer, wy.slope);
    const S per = S(1) / w_;
    return {-static_cast<S>(d),
            Vec3<S>(per * static_cast<S>(sum(value, wx.slope)), per * static_cast<S>(sum(along_y, wx.value)),
                    per * static_cast<S>(sum(along_z, wx.value)))};
  }

  /// True only if penetration() is 0 all over the ball (c, r); false when anything is not finite or r < 0.
  [[nodiscard]] bool separated(const Vec3<S>& c, S r) const noexcept {
    if (!is_finite(c) || !is_finite(r) || r < S(0)) return false;
    const Vec3<S> away = (body_.lower() - c).cwiseMax(c - body_.upper()).cwiseMax(S(0));
    const S apart = r + S(1.63L) * w_;
    // One coordinate first, so that nothing overflows.
    if (away.maxCoeff() > apart || away.squaredNorm() > apart * apart) return true;
    std::array<std::size_t, 3> node;
    Vec3<S> t;
    if (!locate(c, node, t)) return false;
    const std::size_t row = 4 * blocks_[0];
    const S here = static_cast<S>(field_[(node[2] * 4 * blocks_[1] + node[1]) * row + node[0]]);
    if (here - margin * w_ > r) return true;
    const std::array<std::size_t, 3> b{node[0] / 4, node[1] / 4, node[2] / 4};
    const S block = static_cast<S>(block_[(b[2] * blocks_[1] + b[1]) * blocks_[0] + b[0]]);
    return block - (c - centre(b)).norm() > apart;
  }

  [[nodiscard]] S reach() const noexcept { return body_.reach(); }
  [[nodiscard]] S spacing() const noexcept { return w_; }
  [[nodiscard]] const B& body() const noexcept { return body_; }

 private:
  // A coefficient is within 0.75 w of its sample, the nearest sample is within 0.87 w, and the field within 1.62 w
  // of d: a coefficient of more than this has no contact in its cell.
  static constexpr S margin = S(3.25L);

  using Lanes = Eigen::Array<float, 4, 1>;

  /// The three quadratic B-splines that are not 0 at an offset t in [-1/2, 1/2] from a node, and their derivatives.
  struct Spline {
    std::array<float, 3> value, slope;
    explicit Spline(S t) noexcept {
      const float u = static_cast<float>(t), a = 0.5f - u, b = 0.5f + u;
      value = {0.5f * a * a, 0.75f - u * u, 0.5f * b * b};
      slope = {-a, -2.0f * u, b};
    }
  };
  [[nodiscard]] static float sum(const Lanes& v, const std::array<float, 3>& w) noexcept {
    return v[0] * w[0] + v[1] * w[1] + v[2] * w[2];
  }

  /// Middle of a block of 4 x 4 x 4 nodes.
  [[nodiscard]] Vec3<S> centre(const std::array<std::size_t, 3>& b) const noexcept {
    return origin_ + w_ * Vec3<S>(S(4) * static_cast<S>(b[0]) + S(1.5L),
                                  S(4) * static_cast<S>(b[1]) + S(1.5L),
                                  S(4) * static_cast<S>(b[2]) + S(1.5L));
  }

  /// Nearest node and the offset from it in units of w; false near and past the rim.
  [[nodiscard]] bool locate(const Vec3<S>& x, std::array<std::size_t, 3>& node, Vec3<S>& t) const noexcept {
    if (!is_finite(x)) return false;
    const Vec3<S> u = (x - origin_) / w_;
    for (std::size_t k = 0; k < 3; ++k) {
      const S at = u[static_cast<int>(k)];
      if (!(at >= S(0.5L) && at < static_cast<S>(4 * blocks_[k]) - S(2.5L))) return false;
      node[k] = static_cast<std::size_t>(at + S(0.5L));
      t[static_cast<int>(k)] = at - static_cast<S>(node[k]);
    }
    return true;
  }

  void sample() {
    const std::array<std::size_t, 3> n{4 * blocks_[0], 4 * blocks_[1], 4 * blocks_[2]};
    const std::size_t row = n[0], layer = n[0] * n[1];
    std::vector<float> f(layer * n[2], static_cast<float>(S(8) * w_));
    for (std::size_t c = 0; c < blocks_[2]; ++c) {
      for (std::size_t b = 0; b < blocks_[1]; ++b) {
        for (std::size_t a = 0; a < blocks_[0]; ++a) {
          const S d = body_.closest(centre({a, b, c})).distance;
          block_.push_back(static_cast<float>(d));
          // The farthest node of a block is sqrt(3) 1.5 w = 2.6 w from its middle.
          if (d > S(10.6L) * w_) continue;
          for (std::size_t i = 0; i < 64; ++i) {
            const std::size_t x = 4 * a + i % 4, y = 4 * b + i / 4 % 4, z = 4 * c + i / 16;
            const Vec3<S> at =
                origin_ + w_ * Vec3<S>(static_cast<S>(x), static_cast<S>(y), static_cast<S>(z));
            f[z * layer + y * row + x] =
                static_cast<float>((std::min)(body_.closest(at).distance, S(8) * w_));
          }
        }
      }
    }
    // The rim keeps its samples: the body is farther from it than splines reach. Rows are read four at a time.
    field_ = f;
    field_.push_back(0.0f);
    for (std::size_t z = 1; z + 1 < n[2]; ++z) {
      for (std::size_t y = 1; y + 1 < n[1]; ++y) {
        for (std::size_t x = 1; x + 1 < n[0]; ++x) {
          const std::size_t i = z * layer + y * row + x;
          field_[i] = f[i] * 1.75f -
                      (f[i - 1] + f[i + 1] + f[i - row] + f[i + row] + f[i - layer] + f[i + layer]) / 8.0f;
        }
      }
    }
    clear_ = static_cast<float>(margin * w_);
  }

  B body_;
  S w_;
  Vec3<S> origin_;                     // the first node
  std::array<std::size_t, 3> blocks_;  // along each axis
  std::vector<float> field_;           // c, x fastest
  std::vector<float> block_;           // d at the middle of each block
  float clear_ = 0;                    // margin w
};

}  // namespace palpate
