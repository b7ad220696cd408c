// SPDX-License-Identifier: MIT
#pragma once

/// @file  Newton's method for the closest point of a superellipsoid, many at once.

#include <palpate/core/lane_register.hpp>
#include <palpate/core/vector.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace palpate::detail {

/// x^e of x > 0: by products where e is a small whole number, else by logarithm. `V`: a register of S, or S.
template <Real S>
class LanePower {
 public:
  explicit LanePower(S e) noexcept
      : exponent_(e), whole_(e >= S(0) && e <= S(18) && e == std::floor(e) ? static_cast<int>(e) : -1) {}

  template <class V>
  [[nodiscard]] PALPATE_INLINE V of(const V& x) const noexcept {
    if (whole_ >= 0) return product(x);
    return by_array<S>(x, [e = exponent_](const auto& a) { return (a.log() * e).exp(); });
  }
  /// The same where log x is known.
  template <class V>
  [[nodiscard]] PALPATE_INLINE V of(const V& x, const V& log_x) const noexcept {
    if (whole_ >= 0) return product(x);
    return exp_of<S>(V(log_x * exponent_));
  }

 private:
  template <class V>
  [[nodiscard]] PALPATE_INLINE V product(const V& x) const noexcept {
    V result = all_of<V>(S(1)), square = x;
    for (int k = whole_; k > 0; k /= 2) {
      if (k % 2 == 1) result *= square;
      square *= square;
    }
    return result;
  }

  S exponent_;
  int whole_;  // -1: not a small whole number
};

/// Closest point p of x = (x1, x2, x3) >= 0 relative to the centre under the constraint f = (F - 1) / q = 0, with
///
///     F = s^(q/p) + z3^q,   s = z1^p + z2^p,   z_i = p_i / a_i
///     M delta + mu g = tau,   g . delta = -f,   M = 1 + lambda H
///     delta = (g x (M (tau x g)) - f adj(M) g) / (g . adj(M) g)
///
/// g = grad f, H its derivatives; lambda g is the part of x - p along g, tau the rest. The last line solves the one
/// above it; no multiple of g g^T in H would change it, and H couples only the first two axes. Lengths in units of a_min.
/// A second step from the same place (Chebyshev's method) has what delta changes to second order on the right, T the third
/// derivatives: -mu H delta - (lambda/2) T delta delta for tau, (1/2) delta . H delta for f. It needs no new powers.
template <Real S>
class SuperellipsoidNewton {
 public:
  template <class V>
  using Axes = std::array<V, 3>;

  template <class V>
  struct Foot {
    Axes<V> z;
    V u, v, w, s, A;  // z1^(p-2), z2^(p-2), z3^(q-2), s, s^(q/p-1)
  };
  template <class V>
  struct Start {
    Foot<V> foot;
    MaskOf<V> near;     // inside, or outside by a thousandth
    MaskOf<V> shallow;  // and so far from the centre that there is a direction
  };
  template <class V>
  struct Step {
    Axes<V> d, g, h;        // delta, g, adj(M) g
    V Hxx, Hyy, Hxy, Hzz;   // H
    V lambda, per_g2, per;  // 1 / |g|^2, 1 / (g . adj(M) g)
    V length, curvature;    // largest |delta_i|; g . adj(M) g, > 0 at a foot that is the nearest around
  };
  template <class V>
  struct End {
    Axes<V> d, g;  // both steps together, and g after them
    V length;      // of the second one
    V excess;      // <= 0: no coordinate changed by so much that powers are not their series
  };

  SuperellipsoidNewton(const Vec3<S>& axes, S p, S q) noexcept
      : axes_(axes),
        per_(axes.cwiseInverse()),
        p_(p),
        q_(q),
        across_(p - S(2)),
        along_(q - S(2)),
        over_(q / p - S(1)) {}

  [[nodiscard]] const Vec3<S>& axes() const noexcept { return axes_; }

  /// Where the ray from the centre through x leaves the body, for lanes that are near; false if none is.
  template <class V>
  [[nodiscard]] PALPATE_INLINE bool on_ray(const Axes<V>& x, Start<V>& start) const noexcept {
    Foot<V>& foot = start.foot;
    foot.z = {x[0] * per_[0], x[1] * per_[1], x[2] * per_[2]};
    raise(foot);
    const V F = foot.A * foot.s + foot.w * foot.z[2] * foot.z[2];
    // A sum of numbers >= 0 is finite if they are. NaN may have become `tiny` above.
    start.near =
        all_true<MaskOf<V>>(finite<S>(V(x[0] + x[1] + x[2])), finite<S>(F), F < all_of<V>(S(1.001L)));
    if (!any<S>(MaskOf<V>(start.near))) return false;
    const V log_n = log_of<S>(F) * (S(-1) / q_);
    start.shallow = all_true<MaskOf<V>>(start.near, log_n < all_of<V>(S(2)));
    // N is homogeneous: no new powers of each.
    const V n = exp_of<S>(log_n), n_p2 = across_.of(n, log_n), n_q2 = along_.of(n, log_n);
    for (V& z : foot.z) z *= n;
    foot.u *= n_p2, foot.v *= n_p2, foot.w *= n_q2, foot.s *= n_p2 * n * n, foot.A *= n_q2 / n_p2;
    return true;
  }

  /// The powers of z.
  template <class V>
  PALPATE_INLINE void raise(Foot<V>& foot) const noexcept {
    // The square must stay a normal number.
    const V tiny = all_of<V>(sizeof(S) == sizeof(float) ? S(1e-18L) : S(1e-150L));
    for (V& z : foot.z) z = larger_of(z, tiny);
    foot.u = across_.of(foot.z[0]);
    foot.v = across_.of(foot.z[1]);
    foot.w = along_.of(foot.z[2]);
    foot.s = larger_of(V(foot.u * foot.z[0] * foot.z[0] + foot.v * foot.z[1] * foot.z[1]), all_of<V>(least));
    foot.A = over_.of(foot.s);
  }

  /// The first step; the foot stays where it is.
  template <class V>
  [[nodiscard]] PALPATE_INLINE Step<V> newton(const Axes<V>& x, const Foot<V>& foot) const noexcept {
    const auto& [z, u, v, w, s, A] = foot;
    Step<V> step;
    const V ux = u * z[0], vy = v * z[1], wz = w * z[2];
    const V f = (A * s + wz * z[2] - S(1)) * (S(1) / q_);
    step.g = {A * ux * per_[0], A * vy * per_[1], wz * per_[2]};
    const auto& [gx, gy, gz] = step.g;
    const V B = (p_ - S(1)) * A, c = (q_ - p_) * A / s;
    step.Hxx = (B * u + c * ux * ux) * (per_[0] * per_[0]);
    step.Hyy = (B * v + c * vy * vy) * (per_[1] * per_[1]);
    step.Hxy = c * ux * vy * (per_[0] * per_[1]);
    step.Hzz = w * ((q_ - S(1)) * per_[2] * per_[2]);
    const V ax = x[0] - z[0] * axes_[0], ay = x[1] - z[1] * axes_[1], az = x[2] - z[2] * axes_[2];
    step.per_g2 = S(1) / (gx * gx + gy * gy + gz * gz);
    step.lambda = (ax * gx + ay * gy + az * gz) * step.per_g2;
    const Matrix<V> M = matrix(step);
    step.h = {M.zz * (M.yy * gx - M.xy * gy), M.zz * (M.xx * gy - M.xy * gx),
              (M.xx * M.yy - M.xy * M.xy) * gz};
    step.curvature = step.h[0] * gx + step.h[1] * gy + step.h[2] * gz;
    step.per = S(1) / step.curvature;
    step.d = solve(step, M, {ax - step.lambda * gx, ay - step.lambda * gy, az - step.lambda * gz}, f);
    step.length = length(step.d);
    return step;
  }

  /// The second one from the same place, added to the first.
  template <class V>
  [[nodiscard]] PALPATE_INLINE End<V> finish(const Foot<V>& foot, const Step<V>& step) const noexcept {
    const auto& [z, u, v, w, s, A] = foot;
    const auto& [d, g] = std::tie(step.d, step.g);
    const V Hx = step.Hxx * d[0] + step.Hxy * d[1], Hy = step.Hxy * d[0] + step.Hyy * d[1],
            Hz = step.Hzz * d[2];
    // Half of T delta delta, by the derivatives of A along delta, A1 and A2, and those of the powers.
    const V e1 = d[0] * per_[0], e2 = d[1] * per_[1], e3 = d[2] * per_[2];
    const V ux = u * z[0], vy = v * z[1], ue = u * e1, ve = v * e2;
    const V per_s = S(1) / s, c = (q_ - p_) * A * per_s, alpha = ux * e1 + vy * e2;
    const V A2 = c * ((q_ - S(2) * p_) * alpha * alpha * per_s + (p_ - S(1)) * (ue * e1 + ve * e2)),
            A1 = (S(2) * (p_ - S(1))) * c * alpha, C = ((p_ - S(1)) * (p_ - S(2))) * A;
    const auto beyond = [](const V& e, const V& at) -> V {
      return absolute(e) - (S(1e-5L) * at + std::numeric_limits<S>::epsilon());
    };
    const V Tx = (A2 * ux + A1 * ue + C * ue * e1 / z[0]) * (per_[0] / S(2)),
            Ty = (A2 * vy + A1 * ve + C * ve * e2 / z[1]) * (per_[1] / S(2)),
            Tz = w * e3 * e3 / z[2] * ((q_ - S(1)) * (q_ - S(2)) * per_[2] / S(2));
    // mu from the first step along g.
    const V along = g[0] * d[0] + g[1] * d[1] + g[2] * d[2],
            mu = -(along + step.lambda * (g[0] * Hx + g[1] * Hy + g[2] * Hz)) * step.per_g2;
    const Axes<V> more =
        solve(step, matrix(step),
              {-mu * Hx - step.lambda * Tx, -mu * Hy - step.lambda * Ty, -mu * Hz - step.lambda * Tz},
              V(S(0.5) * (d[0] * Hx + d[1] * Hy + d[2] * Hz)));
    return {{d[0] + more[0], d[1] + more[1], d[2] + more[2]},
            {g[0] + Hx + step.Hxx * more[0] + step.Hxy * more[1] + Tx,
             g[1] + Hy + step.Hxy * more[0] + step.Hyy * more[1] + Ty, g[2] + Hz + step.Hzz * more[2] + Tz},
            length(more),
            larger_of(larger_of(beyond(e1, z[0]), beyond(e2, z[1])), beyond(e3, z[2]))};
  }

  /// First steps only, until those of all lanes of `which` are at most `enough`, or `most` of them; the last one.
  template <class V>
  [[nodiscard]] PALPATE_INLINE Step<V> descend(const Axes<V>& x, Foot<V>& foot, const MaskOf<V>& which,
                                               S enough, int most) const noexcept {
    for (int k = 1;; ++k) {
      const Step<V> step = newton(x, foot);
      move(step.d, foot);
      if (k == most || !any<S>(all_true(which, negated(is_settled(step, enough))))) return step;
      raise(foot);
    }
  }
  template <class V>
  [[nodiscard]] static PALPATE_INLINE MaskOf<V> is_settled(const Step<V>& step, S enough) noexcept {
    return all_true<MaskOf<V>>(step.length <= all_of<V>(enough), step.curvature > V{},
                               finite<S>(V(step.length + step.curvature)));
  }
  /// g after a first step that is small.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE Axes<V> turned(const Step<V>& step) noexcept {
    const auto& [d, g] = std::tie(step.d, step.g);
    return {g[0] + step.Hxx * d[0] + step.Hxy * d[1], g[1] + step.Hxy * d[0] + step.Hyy * d[1],
            g[2] + step.Hzz * d[2]};
  }

  template <class V>
  PALPATE_INLINE void move(const Axes<V>& d, Foot<V>& foot) const noexcept {
    for (std::size_t i = 0; i < 3; ++i) foot.z[i] += d[i] * per_[static_cast<Eigen::Index>(i)];
  }

  /// Next to the ends of the third axis powers underflow.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE MaskOf<V> is_usable(const Foot<V>& foot) noexcept {
    return foot.s > all_of<V>(least / std::numeric_limits<S>::epsilon());
  }

 private:
  static constexpr S least = (std::numeric_limits<S>::min)();

  template <class V>
  struct Matrix {
    V xx, yy, xy, zz;
  };
  template <class V>
  [[nodiscard]] static PALPATE_INLINE Matrix<V> matrix(const Step<V>& step) noexcept {
    const V& l = step.lambda;
    return {S(1) + l * step.Hxx, S(1) + l * step.Hyy, l * step.Hxy, S(1) + l * step.Hzz};
  }
  template <class V>
  [[nodiscard]] static PALPATE_INLINE Axes<V> solve(const Step<V>& step, const Matrix<V>& M,
                                                    const Axes<V>& tau, const V& f) noexcept {
    const auto& [g, h] = std::tie(step.g, step.h);
    const V cx = tau[1] * g[2] - tau[2] * g[1], cy = tau[2] * g[0] - tau[0] * g[2],
            cz = tau[0] * g[1] - tau[1] * g[0];
    const V ex = M.xx * cx + M.xy * cy, ey = M.xy * cx + M.yy * cy, ez = M.zz * cz;
    return {(g[1] * ez - g[2] * ey - f * h[0]) * step.per, (g[2] * ex - g[0] * ez - f * h[1]) * step.per,
            (g[0] * ey - g[1] * ex - f * h[2]) * step.per};
  }
  template <class V>
  [[nodiscard]] static PALPATE_INLINE V length(const Axes<V>& d) noexcept {
    return larger_of(larger_of(absolute(d[0]), absolute(d[1])), absolute(d[2]));
  }

  Vec3<S> axes_, per_;
  S p_, q_;
  LanePower<S> across_, along_, over_;
};

}  // namespace palpate::detail
