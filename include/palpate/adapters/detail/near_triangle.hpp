// SPDX-License-Identifier: MIT
#pragma once

/// @file  Ball against triangle, for the trees of other libraries.

#include <palpate/geometry/detail/triangle_query.hpp>

namespace palpate::detail {

/// True unless triangle (p, q, s) is farther than r from c.
template <Real S>
[[nodiscard]] inline bool is_near(const Vec3<S>& c, S r, const Vec3<S>& p, const Vec3<S>& q,
                                  const Vec3<S>& s) noexcept {
  const Vec3<S> w = closest_on_triangle<S>(c, p, q, s);
  S d2 = S(0);
  for (int k = 0; k < 3; ++k) {
    const S e = c[k] - (w[0] * p[k] + w[1] * q[k] + w[2] * s[k]);
    d2 += e * e;
  }
  return !(d2 > r * r);
}

}  // namespace palpate::detail
