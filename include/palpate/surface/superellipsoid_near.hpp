// SPDX-License-Identifier: MIT
#pragma once

/// @file  Depth of points inside a superellipsoid near its surface, many at once.

#include <palpate/surface/concept.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::detail {

/// Depth and normal of N points inside a superellipsoid, by Newton's method for the closest point p of x = (x1, x2, x3) >= 0
/// relative to the centre, under the constraint f = (F - 1) / q = 0 with
///
///     F = (z1^p + z2^p)^(q/p) + z3^q,   z_i = p_i / a_i
///     (1 + lambda K) delta + mu g = tau,   g . delta = -f
///
/// g = grad f; lambda g is the part of x - p along g, tau the rest; K is the Hessian of the norm F^(1/q), which is that
/// of f less (q - 1) g g^T: so it is positive semidefinite, and only mu is another. Lengths in units of a_min.
/// Starts from the radial projection; at most 8 steps. Against long double, over exponents e1, e2 in [0.1, 1]: depth within 1
/// epsilon a_max, normal within 21 epsilon down to 0.9 of the reach.
template <Real S, int N>
struct SuperellipsoidNear {
  using Lanes = LaneArray<S, N>;
  using Axes = std::array<Lanes, 3>;

  struct Result {
    Axes normal;  // this and depth: of lanes that are settled
    Lanes depth;
    std::array<bool, std::size_t{N}> inside, settled;
    bool any_inside, all_settled;  // all that can
  };

  static constexpr int max_steps = 8;

  [[nodiscard]] static Result solve(const Vec3<S>& axes, S p, S q, const Axes& x) noexcept {
    constexpr S epsilon = std::numeric_limits<S>::epsilon(), least = (std::numeric_limits<S>::min)();
    // The square must stay a normal number.
    constexpr S tiny = sizeof(S) == sizeof(float) ? S(1e-18L) : S(1e-150L);
    // A step's error is the square of its length, times a curvature over another.
    const S small = (std::max)(S(0.01) * std::sqrt(epsilon), S(64) * epsilon);
    const Vec3<S> per = axes.cwiseInverse();

    Result result;
    Axes z{(x[0] * per.x()).max(tiny), (x[1] * per.y()).max(tiny), (x[2] * per.z()).max(tiny)};
    Lanes u = power(z[0], p), v = power(z[1], p), s = (u + v).max(least), t = power(s, q / p),
          w = power(z[2], q);
    Lanes F = t + w;
    result.any_inside = false;
    for (int i = 0; i < N; ++i) {
      // A sum of numbers >= 0 is finite if they are. NaN may have become `tiny` above.
      result.inside[at(i)] = is_finite(S(x[0][i] + x[1][i] + x[2][i])) && is_finite(S(F[i])) && F[i] < S(1);
      result.settled[at(i)] = false;
      result.any_inside = result.any_inside || result.inside[at(i)];
    }
    if (!result.any_inside) return result;

    // Onto the surface along the radius: by homogeneity without new powers of each.
    const Lanes log_F = F.log(), per_N = (log_F * (S(-1) / q)).exp(), shrink = (log_F * (-p / q)).exp(),
                per_F = F.inverse();
    z[0] *= per_N, z[1] *= per_N, z[2] *= per_N;
    u *= shrink, v *= shrink, s *= shrink, t *= per_F, w *= per_F;
    Lanes f = Lanes::Zero();
    const std::array<bool, std::size_t{N}> inside = result.inside;
    for (int step = 0; step < max_steps; ++step) {
      if (step > 0) {
        u = power(z[0], p), v = power(z[1], p), s = (u + v).max(least), t = power(s, q / p),
        w = power(z[2], q);
        f = (t + w - S(1)) / q;
      }
      const Lanes ix = z[0].inverse(), iy = z[1].inverse(), iz = z[2].inverse(), is = s.inverse();
      const Lanes A = t * is, ux = u * ix, vy = v * iy, wz = w * iz;
      const Lanes gx = A * ux * per.x(), gy = A * vy * per.y(), gz = wz * per.z();
      // Second derivatives of the norm.
      const Lanes c = A * ((q - p) * is) - (q - S(1)) * A * A, Ap = (p - S(1)) * A;
      const Lanes Kxx = (Ap * ux * ix + c * ux * ux) * (per.x() * per.x()),
                  Kyy = (Ap * vy * iy + c * vy * vy) * (per.y() * per.y()),
                  Kxy = c * ux * vy * (per.x() * per.y()), Kxz = (S(1) - q) * gx * gz,
                  Kyz = (S(1) - q) * gy * gz, Kzz = (q - S(1)) * (wz * iz * (per.z() * per.z()) - gz * gz);
      const Lanes ax = x[0] - z[0] * axes.x(), ay = x[1] - z[1] * axes.y(), az = x[2] - z[2] * axes.z();
      const Lanes lambda = (ax * gx + ay * gy + az * gz) / (gx * gx + gy * gy + gz * gz);
      const Lanes tx = ax - lambda * gx, ty = ay - lambda * gy, tz = az - lambda * gz;
      const Lanes Mxx = S(1) + lambda * Kxx, Myy = S(1) + lambda * Kyy, Mzz = S(1) + lambda * Kzz,
                  Mxy = lambda * Kxy, Mxz = lambda * Kxz, Myz = lambda * Kyz;
      // M by its cofactors.
      const Lanes Cxx = Myy * Mzz - Myz * Myz, Cxy = Mxz * Myz - Mxy * Mzz, Cxz = Mxy * Myz - Mxz * Myy,
                  Cyy = Mxx * Mzz - Mxz * Mxz, Cyz = Mxy * Mxz - Mxx * Myz, Czz = Mxx * Myy - Mxy * Mxy;
      const Lanes det = Mxx * Cxx + Mxy * Cxy + Mxz * Cxz;
      const Lanes hx = Cxx * gx + Cxy * gy + Cxz * gz, hy = Cxy * gx + Cyy * gy + Cyz * gz,
                  hz = Cxz * gx + Cyz * gy + Czz * gz;
      const Lanes mu = (hx * tx + hy * ty + hz * tz + det * f) / (hx * gx + hy * gy + hz * gz);
      const Lanes rx = tx - mu * gx, ry = ty - mu * gy, rz = tz - mu * gz, per_det = det.inverse();
      const Lanes dx = (Cxx * rx + Cxy * ry + Cxz * rz) * per_det,
                  dy = (Cxy * rx + Cyy * ry + Cyz * rz) * per_det,
                  dz = (Cxz * rx + Cyz * ry + Czz * rz) * per_det;
      z[0] = (z[0] + dx * per.x()).max(tiny), z[1] = (z[1] + dy * per.y()).max(tiny),
      z[2] = (z[2] + dz * per.z()).max(tiny);
      const Lanes length = dx.abs().max(dy.abs()).max(dz.abs());
      result.all_settled = true;
      for (int i = 0; i < N; ++i) {
        // Towards the centre nothing is left of the direction; next to the ends of the third axis powers underflow.
        const bool usable = log_F[i] > S(-2) * q && s[i] > least / epsilon;
        result.settled[at(i)] = inside[at(i)] && usable && is_finite(S(length[i] + det[i])) &&
                                length[i] <= small && det[i] > S(0);
        result.all_settled = result.all_settled && (result.settled[at(i)] || !inside[at(i)] || !usable);
      }
      if (!result.all_settled && step + 1 < max_steps) continue;
      // The normal has turned by K delta in the last step.
      const Lanes nx = gx + Kxx * dx + Kxy * dy + Kxz * dz, ny = gy + Kxy * dx + Kyy * dy + Kyz * dz,
                  nz = gz + Kxz * dx + Kyz * dy + Kzz * dz;
      const Lanes per_n = (nx * nx + ny * ny + nz * nz).sqrt().inverse();
      result.normal[0] = nx * per_n, result.normal[1] = ny * per_n, result.normal[2] = nz * per_n;
      result.depth = (z[0] * axes.x() - x[0]) * result.normal[0] +
                     (z[1] * axes.y() - x[1]) * result.normal[1] +
                     (z[2] * axes.z() - x[2]) * result.normal[2];
      break;
    }
    return result;
  }

 private:
  [[nodiscard]] static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  [[nodiscard]] static Lanes power(const Lanes& x, S exponent) noexcept { return (x.log() * exponent).exp(); }
};

}  // namespace palpate::detail
