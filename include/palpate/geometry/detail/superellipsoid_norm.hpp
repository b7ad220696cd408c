// SPDX-License-Identifier: MIT
#pragma once

/// @file  The nested norm of a superellipsoid with its first two derivatives; its dual gives support points.

#include <palpate/core/vector.hpp>

#include <cmath>
#include <limits>

namespace palpate::detail {

template <Real S>
struct NormJet {
  S value;
  Vec3<S> gradient;
  Mat3<S> hessian;
};

/// N(z) = l_q(l_p(z1, z2), z3) for z >= 0, p, q >= 2. Scaled by the larger argument, so nothing overflows.
template <Real S>
struct NestedNorm {
  S p = S(2), q = S(2);

  [[nodiscard]] S value(const Vec3<S>& z) const noexcept { return length(length(z.x(), z.y(), p), z.z(), q); }

  /// With s = l_p(z1, z2), c = the arguments over their norm (at most 1):
  /// dl/da = ca^(p-1), d2l/da2 = (p-1)/l ca^(p-2) cb^p, d2l/dadb = -(p-1)/l (ca cb)^(p-1). The term
  /// dN/ds d2s/dz2 is written with (s/N)^(q-2), which holds at s = 0.
  [[nodiscard]] NormJet<S> jet(const Vec3<S>& z) const noexcept {
    const Level in(z.x(), z.y(), p), out(in.norm, z.z(), q);
    const S sx = in.a2 * in.a, sy = in.b2 * in.b;      // ds/dz1, ds/dz2
    const S ns = out.a2 * out.a, nz = out.b2 * out.b;  // dN/ds, dN/dz3
    NormJet<S> jet{out.norm, Vec3<S>(ns * sx, ns * sy, nz), Mat3<S>::Zero()};
    if (!(out.norm > S(0))) return jet;
    const S inverse = S(1) / out.norm, k = (q - S(1)) * inverse;
    const S nss = k * out.a2 * nz * out.b, nzz = k * out.b2 * ns * out.a, nsz = -k * ns * nz;
    const S c = (p - S(1)) * inverse * out.a2;
    Mat3<S>& H = jet.hessian;
    H(0, 0) = nss * sx * sx + c * in.a2 * sy * in.b;
    H(1, 1) = nss * sy * sy + c * in.b2 * sx * in.a;
    H(2, 2) = nzz;
    H(0, 1) = H(1, 0) = nss * sx * sy - c * sx * sy;
    H(0, 2) = H(2, 0) = nsz * sx;
    H(1, 2) = H(2, 1) = nsz * sy;
    return jet;
  }

  /// Gradient of the dual norm (exponents p/(p-1), q/(q-1)) at m >= 0: the z with N(z) = 1 and largest m . z.
  [[nodiscard]] Vec3<S> dual_gradient(const Vec3<S>& m) const noexcept {
    const S ps = p / (p - S(1)), qs = q / (q - S(1));
    const S s = length(m.x(), m.y(), ps), n = length(s, m.z(), qs);
    const S ds = s > S(0) ? std::pow(s / n, qs - S(1)) : S(0),
            dz = m.z() > S(0) ? std::pow(m.z() / n, qs - S(1)) : S(0);
    const S dx = m.x() > S(0) ? std::pow(m.x() / s, ps - S(1)) : S(0),
            dy = m.y() > S(0) ? std::pow(m.y() / s, ps - S(1)) : S(0);
    return Vec3<S>(ds * dx, ds * dy, dz);
  }

  /// Moves z along one axis onto N = 1; false when that line misses the surface.
  [[nodiscard]] bool project(int axis, Vec3<S>& z) const noexcept {
    if (axis == 2) {
      const S s = length(z.x(), z.y(), p);
      if (!(s < S(1))) return false;
      z.z() = other(s, q);
      return true;
    }
    if (!(z.z() < S(1))) return false;
    const S s = other(z.z(), q), kept = z[1 - axis];
    if (!(kept < s)) return false;
    z[axis] = s * other(kept / s, p);
    return true;
  }

 private:
  struct Level {
    S norm, a, b, a2, b2;  // l(a, b); a / norm, b / norm; these to the power exponent - 2
    Level(S first, S second, S exponent) noexcept {
      const bool swap = second > first;
      const S large = swap ? second : first, small = swap ? first : second;
      const bool none = !(large >= (std::numeric_limits<S>::min)());  // 0: taken on the diagonal
      const S ratio = none ? S(1) : small / large;
      const S power = std::pow(ratio, exponent), base = S(1) + power, root = std::pow(base, S(1) / exponent);
      norm = none ? S(0) : large * root;
      const S high = S(1) / root, low = ratio * high, high2 = root * root / base;
      // ratio^2 must stay a normal number.
      const bool vanishes = ratio < S(4) * std::sqrt((std::numeric_limits<S>::min)());
      const S low2 = exponent == S(2) ? S(1) : vanishes ? S(0) : high2 * (power / (ratio * ratio));
      a = swap ? low : high, b = swap ? high : low;
      a2 = exponent == S(2) ? S(1) : swap ? low2 : high2;
      b2 = exponent == S(2) ? S(1) : swap ? high2 : low2;
    }
  };

  [[nodiscard]] static S length(S a, S b, S exponent) noexcept {
    const S large = a > b ? a : b, small = a > b ? b : a;
    if (!(large >= (std::numeric_limits<S>::min)())) return S(0);
    return large * std::pow(S(1) + std::pow(small / large, exponent), S(1) / exponent);
  }
  // b with l(a, b) = 1, for 0 <= a < 1.
  [[nodiscard]] static S other(S a, S exponent) noexcept {
    return std::pow(S(1) - std::pow(a, exponent), S(1) / exponent);
  }
};

}  // namespace palpate::detail
