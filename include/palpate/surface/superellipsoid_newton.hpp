// SPDX-License-Identifier: MIT
#pragma once

/// @file  Newton's method for the closest point of a superellipsoid, many at once.

#include <palpate/surface/concept.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace palpate::detail {

template <int N>
using LaneMask = std::array<bool, static_cast<std::size_t>(N)>;

/// x^e of many x > 0: by products where e is a small whole number, else by logarithm.
template <Real S>
class LanePower {
 public:
  explicit LanePower(S e) noexcept
      : exponent_(e), whole_(e >= S(0) && e <= S(18) && e == std::floor(e) ? static_cast<int>(e) : -1) {}

  template <int N>
  [[nodiscard]] LaneArray<S, N> of(const LaneArray<S, N>& x) const noexcept {
    return whole_ < 0 ? of_log<N>(x.log()) : product<N>(x);
  }
  /// The same where log x is known.
  template <int N>
  [[nodiscard]] LaneArray<S, N> of(const LaneArray<S, N>& x, const LaneArray<S, N>& log_x) const noexcept {
    return whole_ < 0 ? of_log<N>(log_x) : product<N>(x);
  }

 private:
  template <int N>
  [[nodiscard]] LaneArray<S, N> of_log(const LaneArray<S, N>& log_x) const noexcept {
    return (log_x * exponent_).exp();
  }
  template <int N>
  [[nodiscard]] LaneArray<S, N> product(const LaneArray<S, N>& x) const noexcept {
    LaneArray<S, N> result = LaneArray<S, N>::Ones(), square = x;
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
///     (1 + lambda H) delta + mu g = tau,   g . delta = -f
///     delta = (g x (M (tau x g)) - f adj(M) g) / (g . adj(M) g),   M = 1 + lambda H
///
/// g = grad f, H its derivatives; lambda g is the part of x - p along g, tau the rest. The last line solves the one
/// above it; no multiple of g g^T in H would change it, and H couples only the first two axes. Lengths in units of a_min.
template <Real S>
class SuperellipsoidNewton {
 public:
  template <int N>
  using Lanes = LaneArray<S, N>;
  template <int N>
  using Axes = std::array<Lanes<N>, 3>;

  template <int N>
  struct Foot {
    Axes<N> z;
    Lanes<N> u, v, w, s, A;  // z1^(p-2), z2^(p-2), z3^(q-2), s, s^(q/p-1)

    /// Next to the ends of the third axis powers underflow.
    [[nodiscard]] bool is_usable(Eigen::Index i) const noexcept {
      return s[i] > least / std::numeric_limits<S>::epsilon();
    }
  };
  template <int N>
  struct Start {
    Foot<N> foot;
    LaneMask<N> near;     // inside, or outside by a thousandth
    LaneMask<N> shallow;  // and so far from the centre that there is a direction
  };
  template <int N>
  struct Step {
    Axes<N> d, g;  // delta, g
    Lanes<N> Hxx, Hyy, Hxy, Hzz;
    Lanes<N> length, curvature;  // largest |delta_i|; g . adj(M) g, > 0 at a foot that is the nearest around

    [[nodiscard]] bool is_settled(Eigen::Index i, S enough) const noexcept {
      return length[i] <= enough && curvature[i] > S(0) && is_finite(S(length[i] + curvature[i]));
    }
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
  template <int N>
  [[nodiscard]] bool on_ray(const Axes<N>& x, Start<N>& start) const noexcept {
    Foot<N>& foot = start.foot;
    foot.z = {x[0] * per_.x(), x[1] * per_.y(), x[2] * per_.z()};
    raise<N>(foot);
    const Lanes<N> F = foot.A * foot.s + foot.w * foot.z[2] * foot.z[2], log_N = F.log() * (S(1) / q_);
    bool any_near = false;
    for (std::size_t i = 0; i < start.near.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      // A sum of numbers >= 0 is finite if they are. NaN may have become `tiny` above.
      start.near[i] = is_finite(S(x[0][k] + x[1][k] + x[2][k])) && is_finite(S(F[k])) && F[k] < S(1.001L);
      start.shallow[i] = start.near[i] && log_N[k] > S(-2);
      any_near = any_near || start.near[i];
    }
    if (!any_near) return false;
    // N is homogeneous: no new powers of each.
    const Lanes<N> log_n = -log_N, n = log_n.exp(), n_p2 = across_.template of<N>(n, log_n),
                   n_q2 = along_.template of<N>(n, log_n);
    for (Lanes<N>& z : foot.z) z *= n;
    foot.u *= n_p2, foot.v *= n_p2, foot.w *= n_q2, foot.s *= n_p2 * n.square(), foot.A *= n_q2 / n_p2;
    return true;
  }

  /// Newton steps until those of every shallow lane are at most `enough`, or `most` of them; the last one.
  template <int N>
  Step<N> descend(const Axes<N>& x, Start<N>& start, S enough, int most) const noexcept {
    for (int k = 1;; ++k) {
      const Step<N> step = newton<N>(x, start.foot);
      bool settled = true;
      for (std::size_t i = 0; i < start.shallow.size(); ++i)
        settled = settled && (!start.shallow[i] || step.is_settled(static_cast<Eigen::Index>(i), enough));
      if (settled || k == most) return step;
      raise<N>(start.foot);
    }
  }

  /// The powers of z.
  template <int N>
  PALPATE_INLINE void raise(Foot<N>& foot) const noexcept {
    // The square must stay a normal number.
    constexpr S tiny = sizeof(S) == sizeof(float) ? S(1e-18L) : S(1e-150L);
    for (Lanes<N>& z : foot.z) z = z.max(tiny);
    foot.u = across_.template of<N>(foot.z[0]);
    foot.v = across_.template of<N>(foot.z[1]);
    foot.w = along_.template of<N>(foot.z[2]);
    foot.s = (foot.u * foot.z[0] * foot.z[0] + foot.v * foot.z[1] * foot.z[1]).max(least);
    foot.A = over_.template of<N>(foot.s);
  }

 private:
  static constexpr S least = (std::numeric_limits<S>::min)();

  // Moves foot.z; its powers stay behind.
  template <int N>
  [[nodiscard]] PALPATE_INLINE Step<N> newton(const Axes<N>& x, Foot<N>& foot) const noexcept {
    using L = Lanes<N>;
    const auto& [z, u, v, w, s, A] = foot;
    Step<N> step;
    const L ux = u * z[0], vy = v * z[1], wz = w * z[2];
    const L f = (A * s + wz * z[2] - S(1)) * (S(1) / q_);
    const L gx = A * ux * per_.x(), gy = A * vy * per_.y(), gz = wz * per_.z();
    const L B = (p_ - S(1)) * A, c = (q_ - p_) * A / s;
    step.Hxx = (B * u + c * ux * ux) * (per_.x() * per_.x());
    step.Hyy = (B * v + c * vy * vy) * (per_.y() * per_.y());
    step.Hxy = c * ux * vy * (per_.x() * per_.y());
    step.Hzz = w * ((q_ - S(1)) * per_.z() * per_.z());
    const L ax = x[0] - z[0] * axes_.x(), ay = x[1] - z[1] * axes_.y(), az = x[2] - z[2] * axes_.z();
    const L lambda = (ax * gx + ay * gy + az * gz) / (gx * gx + gy * gy + gz * gz);
    const L tx = ax - lambda * gx, ty = ay - lambda * gy, tz = az - lambda * gz;
    const L Mxx = S(1) + lambda * step.Hxx, Myy = S(1) + lambda * step.Hyy, Mxy = lambda * step.Hxy,
            Mzz = S(1) + lambda * step.Hzz;
    const L cx = ty * gz - tz * gy, cy = tz * gx - tx * gz, cz = tx * gy - ty * gx;
    const L ex = Mxx * cx + Mxy * cy, ey = Mxy * cx + Myy * cy, ez = Mzz * cz;
    const L hx = Mzz * (Myy * gx - Mxy * gy), hy = Mzz * (Mxx * gy - Mxy * gx),
            hz = (Mxx * Myy - Mxy * Mxy) * gz;
    step.curvature = hx * gx + hy * gy + hz * gz;
    const L per = step.curvature.inverse();
    step.g = {gx, gy, gz};
    step.d = {(gy * ez - gz * ey - f * hx) * per, (gz * ex - gx * ez - f * hy) * per,
              (gx * ey - gy * ex - f * hz) * per};
    step.length = step.d[0].abs().max(step.d[1].abs()).max(step.d[2].abs());
    for (std::size_t i = 0; i < 3; ++i) foot.z[i] += step.d[i] * per_[static_cast<Eigen::Index>(i)];
    return step;
  }

  Vec3<S> axes_, per_;
  S p_, q_;
  LanePower<S> across_, along_, over_;
};

}  // namespace palpate::detail
