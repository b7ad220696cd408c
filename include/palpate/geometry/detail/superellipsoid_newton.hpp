// SPDX-License-Identifier: MIT
#pragma once

/// @file  Newton's method for the closest point of a superellipsoid, many at once.

#include <palpate/core/simd_math.hpp>
#include <palpate/core/vector.hpp>

#include <array>
#include <limits>
#include <tuple>

namespace palpate::detail {

/// Closest point p of x = (x1, x2, x3) >= 0 relative to the centre under the constraint f = (F - 1) / q = 0,
/// with
///
///     F = s^(q/p) + z3^q,   s = z1^p + z2^p,   z_i = p_i / a_i
///     M delta + mu g = tau,   g . delta = -f,   M = 1 + lambda H
///     delta = (g x (M (tau x g)) - f adj(M) g) / (g . adj(M) g)
///
/// g = grad f, H its derivatives; lambda g is the part of x - p along g, tau the rest. The last line solves
/// the one above it; no multiple of g g^T in H would change it, and H couples only the first two axes.
/// Lengths in units of about a_min. A second step from the same point (Chebyshev's method) has what delta
/// changes to second order on the right, T the third derivatives: -mu H delta - (lambda/2) T delta delta for
/// tau, (1/2) delta . H delta for f. It needs no new powers.
template <Real S>
class SuperellipsoidNewton {
 public:
  template <class V>
  using Axes = std::array<V, 3>;

  template <class V>
  struct Foot {
    Axes<V> z;        // > 0
    V u, v, w, s, A;  // z1^(p-2), z2^(p-2), z3^(q-2), s, s^(q/p-1)
  };
  template <class V>
  struct Start {
    Foot<V> foot;
    V F;
    MaskOf<V> near;     // inside, or outside by a thousandth
    MaskOf<V> shallow;  // and so far from the centre that there is a direction
  };
  template <class V>
  struct Step {
    Axes<V> d, g, h;       // delta, g, adj(|g|^2 M) g
    V Hxx, Hyy, Hxy, Hzz;  // H
    V g2, ag;              // |g|^2, lambda |g|^2
    V length, curvature;   // max |delta_i|; g . h, > 0 at a foot that is the nearest around
    V per;                 // its inverse
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

  // Everything below is of one register; what is of many goes through them stage by stage, as each waits long
  // for its own logarithms and divisions.

  /// The powers at x, and whether points are near.
  template <class V>
  PALPATE_INLINE void begin(const Axes<V>& x, Start<V>& start) const noexcept {
    Foot<V>& foot = start.foot;
    foot.z = {off_zero(x[0] * per_[0]), off_zero(x[1] * per_[1]), off_zero(x[2] * per_[2])};
    raise(foot);
    start.F = foot.A * foot.s + foot.w * foot.z[2] * foot.z[2];
    // A sum of numbers >= 0 is finite if they are. NaN may have become a number. F is 1 on the surface; a
    // thousandth more (chosen) keeps points that rounding, in float too, puts just outside.
    start.near = is_finite(x[0] + x[1] + x[2]) && is_finite(start.F) && start.F < S(1.001L);
  }
  /// On to where the ray from the centre through x leaves the body.
  template <class V>
  PALPATE_INLINE void leave(Start<V>& start) const noexcept {
    Foot<V>& foot = start.foot;
    const V log_n = log2(start.F) * (S(-1) / q_);
    start.shallow = start.near && log_n < S(3);
    // F^(1/q) is homogeneous: no new powers of each. n^(q - p), as n^q = 1 / F:
    const V n = exp2(log_n), n_p2 = across_(n, log_n), n_p = n_p2 * n * n, rest = S(1) / (start.F * n_p);
    for (V& z : foot.z) z *= n;
    foot.u *= n_p2, foot.v *= n_p2, foot.w *= n_p2 * rest, foot.s *= n_p, foot.A *= rest;
  }

  /// The powers of z.
  template <class V>
  PALPATE_INLINE void raise(Foot<V>& foot) const noexcept {
    foot.u = across_(foot.z[0]);
    foot.v = across_(foot.z[1]);
    foot.w = along_(foot.z[2]);
    foot.s = (max)(foot.u * foot.z[0] * foot.z[0] + foot.v * foot.z[1] * foot.z[1], least);
    foot.A = over_(foot.s);
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
    step.g2 = gx * gx + gy * gy + gz * gz;
    step.ag = ax * gx + ay * gy + az * gz;
    const Matrix<V> M = matrix(step);
    step.h = {M.zz * (M.yy * gx - M.xy * gy), M.zz * (M.xx * gy - M.xy * gx),
              (M.xx * M.yy - M.xy * M.xy) * gz};
    step.curvature = step.h[0] * gx + step.h[1] * gy + step.h[2] * gz;
    step.per = S(1) / step.curvature;
    step.d = solve(step, M, {step.g2 * ax, step.g2 * ay, step.g2 * az}, f);
    step.length = length(step.d);
    return step;
  }

  /// The second one from the same point, added to the first.
  template <class V>
  [[nodiscard]] PALPATE_INLINE End<V> finish(const Foot<V>& foot, const Step<V>& step) const noexcept {
    const auto& [z, u, v, w, s, A] = foot;
    const auto& [d, g] = std::tie(step.d, step.g);
    const V Hx = step.Hxx * d[0] + step.Hxy * d[1], Hy = step.Hxy * d[0] + step.Hyy * d[1],
            Hz = step.Hzz * d[2];
    // Half of T delta delta, by the derivatives of A along delta, A1 and A2, and those of the powers.
    const V e1 = d[0] * per_[0], e2 = d[1] * per_[1], e3 = d[2] * per_[2];
    const V ux = u * z[0], vy = v * z[1], ue = u * e1, ve = v * e2;
    // One division for all inverses.
    const V xy = z[0] * z[1], zs = z[2] * s, per_all = S(1) / (xy * zs * step.g2),
            per_xyzs = per_all * step.g2, per_g2 = per_all * xy * zs, per_xy = per_xyzs * zs,
            per_zs = per_xyzs * xy, per_s = per_zs * z[2];
    const V c = (q_ - p_) * A * per_s, alpha = ux * e1 + vy * e2;
    const V A2 = c * ((q_ - S(2) * p_) * alpha * alpha * per_s + (p_ - S(1)) * (ue * e1 + ve * e2)),
            A1 = (S(2) * (p_ - S(1))) * c * alpha, C = ((p_ - S(1)) * (p_ - S(2))) * A;
    // A step may move a coordinate by 1e-5 of itself (chosen): the terms left out are then about a rounding.
    const auto beyond = [](const V& e, const V& at) -> V {
      return abs(e) - (S(1e-5L) * at + std::numeric_limits<S>::epsilon());
    };
    const V Tx = (A2 * ux + A1 * ue + C * ue * e1 * (per_xy * z[1])) * (per_[0] / S(2)),
            Ty = (A2 * vy + A1 * ve + C * ve * e2 * (per_xy * z[0])) * (per_[1] / S(2)),
            Tz = w * e3 * e3 * (per_zs * s) * ((q_ - S(1)) * (q_ - S(2)) * per_[2] / S(2));
    // mu |g|^2 from the first step along g.
    const V along = g[0] * d[0] + g[1] * d[1] + g[2] * d[2],
            mu = -(along + step.ag * per_g2 * (g[0] * Hx + g[1] * Hy + g[2] * Hz));
    const Axes<V> more =
        solve(step, matrix(step), {-mu * Hx - step.ag * Tx, -mu * Hy - step.ag * Ty, -mu * Hz - step.ag * Tz},
              S(0.5) * (d[0] * Hx + d[1] * Hy + d[2] * Hz));
    return {{d[0] + more[0], d[1] + more[1], d[2] + more[2]},
            {g[0] + Hx + step.Hxx * more[0] + step.Hxy * more[1] + Tx,
             g[1] + Hy + step.Hxy * more[0] + step.Hyy * more[1] + Ty, g[2] + Hz + step.Hzz * more[2] + Tz},
            length(more),
            (max)((max)(beyond(e1, z[0]), beyond(e2, z[1])), beyond(e3, z[2]))};
  }

  /// From x by the ray and by first steps, until those of all shallow points are at most `enough`, or `most`
  /// of them; the last one. False, and no step, if no point is near.
  template <class V, std::size_t M>
  [[nodiscard]] PALPATE_INLINE bool descend(const std::array<Axes<V>, M>& x, std::array<Start<V>, M>& start,
                                            std::array<Step<V>, M>& step, S enough, int most) const noexcept {
    bool any_near = false;
    for (std::size_t k = 0; k < M; ++k) begin(x[k], start[k]);
    for (std::size_t k = 0; k < M; ++k) any_near |= any_of(start[k].near);
    if (!any_near) return false;
    for (std::size_t k = 0; k < M; ++k) leave(start[k]);
    for (int count = 1;; ++count) {
      bool done = true;
      for (std::size_t k = 0; k < M; ++k) {
        step[k] = newton(x[k], start[k].foot);
        move(step[k].d, start[k].foot);
        done &= !any_of(start[k].shallow && !is_settled(step[k], enough));
      }
      if (done || count == most) return true;
      for (std::size_t k = 0; k < M; ++k) raise(start[k].foot);
    }
  }
  template <class V>
  [[nodiscard]] static PALPATE_INLINE MaskOf<V> is_settled(const Step<V>& step, S enough) noexcept {
    return step.length <= enough && step.curvature > V{} && is_finite(step.length + step.curvature);
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
    foot.z = {off_zero(foot.z[0] + d[0] * per_[0]), off_zero(foot.z[1] + d[1] * per_[1]),
              off_zero(foot.z[2] + d[2] * per_[2])};
  }

  /// Next to the ends of the third axis powers underflow.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE MaskOf<V> is_usable(const Foot<V>& foot) noexcept {
    return foot.s > least / std::numeric_limits<S>::epsilon();
  }

 private:
  static constexpr S least = (std::numeric_limits<S>::min)();

  // Nothing in the units of the axes, but its square stays a normal number; in double, where finish() is
  // used, products of three too.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE V off_zero(const V& z) noexcept {
    return (max)(z, sizeof(S) == sizeof(float) ? S(1e-18L) : S(1e-20L));
  }

  template <class V>
  struct Matrix {
    V xx, yy, xy, zz;
  };
  // |g|^2 M.
  template <class V>
  [[nodiscard]] static PALPATE_INLINE Matrix<V> matrix(const Step<V>& step) noexcept {
    return {step.g2 + step.ag * step.Hxx, step.g2 + step.ag * step.Hyy, step.ag * step.Hxy,
            step.g2 + step.ag * step.Hzz};
  }
  // M: |g|^2 M; tau: |g|^2 tau, and any multiple of g.
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
    return (max)((max)(abs(d[0]), abs(d[1])), abs(d[2]));
  }

  Vec3<S> axes_, per_;
  S p_, q_;
  Power<S> across_, along_, over_;
};

}  // namespace palpate::detail
