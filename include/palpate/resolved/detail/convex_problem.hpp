// SPDX-License-Identifier: MIT
#pragma once

/// @file The two convex problems of a contact resolved at its points: pressures, and tractions at given
/// pressures. Both by conjugate gradients in the set that is free, begun with the last tick's result.
///
///     pressures   q >= 0,  A q - d >= 0,  q.(A q - d) = 0                            Signorini
///     tractions   |t_i| <= g_i;  sticks: u_t = a;  slips: t_i = g_i along a - u_t     Coulomb, g = mu q
///
/// A tick's state hardly differs from the last one's: some 3 iterations. A bound on them is kept; the
/// residual says what is left. Source: [polonsky1999].

#include <palpate/core/aligned_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::detail {

/// What is left of a solve.
struct Remainder {
  int iterations = 0;
  float norm = 0;  ///< of what violates the conditions [m]
};

/// Lists of a solve, sized at set-up.
struct PressureLists {
  AlignedList<float> q, d, r, p, y;
  void resize(std::size_t size) {
    for (auto* list : {&q, &d, &r, &p, &y}) list->resize(size);
  }
};

/// Pressures for the depths d; `apply(q, y)` gives y = A q; tolerance on the norm [m]. q is the
/// start and the result, r = A q - d.
template <class Apply>
[[nodiscard]] Remainder solve_pressures(std::size_t n, PressureLists& lists, float tolerance, int iterations,
                                        const Apply& apply) noexcept {
  float *const q = lists.q.data(), *const r = lists.r.data(), *const p = lists.p.data(),
               *const y = lists.y.data();
  const float* const d = lists.d.data();
  const auto residual = [&] {
    apply(q, r);
    for (std::size_t i = 0; i < n; ++i) r[i] -= d[i];
  };
  residual();
  float before = 1;
  bool restart = true;
  Remainder result;
  for (;; ++result.iterations) {
    float free2 = 0, overlap2 = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const float r2 = r[i] * r[i];
      free2 += q[i] > 0 ? r2 : 0;
      overlap2 += q[i] <= 0 && r[i] < 0 ? r2 : 0;
    }
    result.norm = std::sqrt(free2 + overlap2);
    if (!(result.norm > tolerance) || result.iterations == iterations) return result;
    const float beta = restart ? 0 : free2 / before;
    before = free2;
    // Points that overlap come in along the same step.
    float rp = 0;
    for (std::size_t i = 0; i < n; ++i) {
      p[i] = q[i] > 0 ? r[i] + beta * p[i] : (std::min)(r[i], 0.f);
      rp += r[i] * p[i];
    }
    apply(p, y);
    float py = 0;
    for (std::size_t i = 0; i < n; ++i) py += p[i] * y[i];
    if (!(py > 0) || !(rp > 0)) {  // rounding has used up the direction
      if (restart) return result;
      restart = true;
      continue;
    }
    const float step = rp / py;
    bool clamped = false;
    for (std::size_t i = 0; i < n; ++i) {
      const float next = q[i] - step * p[i];
      clamped |= next < 0;
      q[i] = (std::max)(next, 0.f);
      r[i] -= step * y[i];
    }
    restart = clamped || overlap2 > 0;
    if (clamped) residual();
  }
}

/// Lists of a solve, sized at set-up: tractions, their limits, anchors, displacements, and what the iteration
/// needs, each along two tangents.
struct TractionLists {
  AlignedList<float> limit, s, t, as, at, us, ut, zs, zt, ps, pt, ys, yt;
  void resize(std::size_t size) {
    for (auto* list : {&limit, &s, &t, &as, &at, &us, &ut, &zs, &zt, &ps, &pt, &ys, &yt}) list->resize(size);
  }
};

/// Tractions s, t within discs of radius `limit`, for the anchors as, at. us, ut: displacements by
/// pressures and tractions; they are kept so. `apply(s, t, us, ut)`: displacements by tractions.
template <class Apply>
[[nodiscard]] Remainder solve_tractions(std::size_t n, TractionLists& lists, float tolerance, int iterations,
                                        const Apply& apply) noexcept {
  float *const s = lists.s.data(), *const t = lists.t.data(), *const us = lists.us.data(),
               *const ut = lists.ut.data(), *const zs = lists.zs.data(), *const zt = lists.zt.data(),
               *const ps = lists.ps.data(), *const pt = lists.pt.data(), *const ys = lists.ys.data(),
               *const yt = lists.yt.data();
  const float *const limit = lists.limit.data(), *const as = lists.as.data(), *const at = lists.at.data();
  // By (ps, pt), held within the discs; what has changed goes to (ys, yt). False where a disc held a point.
  const auto move = [&](float step) {
    bool within = true;
    for (std::size_t i = 0; i < n; ++i) {
      float ns = s[i] + step * ps[i], nt = t[i] + step * pt[i];
      const float size2 = ns * ns + nt * nt;
      if (size2 > limit[i] * limit[i]) {
        const float shrink = limit[i] / std::sqrt(size2);
        ns *= shrink, nt *= shrink;
        within = false;
      }
      ys[i] = ns - s[i], yt[i] = nt - t[i];  // what apply() put there was added before
      s[i] = ns, t[i] = nt;
    }
    return within;
  };
  const auto add_image = [&](float step) {
    for (std::size_t i = 0; i < n; ++i) us[i] += step * ys[i], ut[i] += step * yt[i];
  };
  const auto follow = [&] {  // u of what has changed
    for (std::size_t i = 0; i < n; ++i) ps[i] = ys[i], pt[i] = yt[i];
    apply(ps, pt, ys, yt);
    add_image(1);
  };
  for (std::size_t i = 0; i < n; ++i) ps[i] = pt[i] = 0;
  if (!move(0)) follow();  // the last tick's tractions, within the new discs

  float before = 1;
  bool restart = true;
  Remainder result;
  for (;; ++result.iterations) {
    float size2 = 0, mixed = 0;
    for (std::size_t i = 0; i < n; ++i) {
      float gs = as[i] - us[i], gt = at[i] - ut[i];
      const float held2 = s[i] * s[i] + t[i] * t[i], outward = gs * s[i] + gt * t[i];
      if (!(limit[i] > 0)) {
        gs = gt = 0;
      } else if (outward > 0 &&
                 held2 >= 0.9999f * limit[i] * limit[i]) {  // slips: along the disc's rim alone
        gs -= outward / held2 * s[i];
        gt -= outward / held2 * t[i];
      }
      size2 += gs * gs + gt * gt;
      mixed += gs * zs[i] + gt * zt[i];
      zs[i] = gs, zt[i] = gt;
    }
    result.norm = std::sqrt(size2);
    if (!(result.norm > tolerance) || result.iterations == iterations) return result;
    const float beta = restart ? 0 : (std::max)((size2 - mixed) / before, 0.f);
    before = size2;
    float zp = 0;
    for (std::size_t i = 0; i < n; ++i) {
      ps[i] = limit[i] > 0 ? zs[i] + beta * ps[i] : 0;
      pt[i] = limit[i] > 0 ? zt[i] + beta * pt[i] : 0;
      zp += zs[i] * ps[i] + zt[i] * pt[i];
    }
    apply(ps, pt, ys, yt);
    float py = 0;
    for (std::size_t i = 0; i < n; ++i) py += ps[i] * ys[i] + pt[i] * yt[i];
    if (!(py > 0) || !(zp > 0)) {
      if (restart) return result;
      restart = true;
      continue;
    }
    const float step = zp / py;
    restart = false;
    for (std::size_t i = 0; i < n; ++i) {
      const float ns = s[i] + step * ps[i], nt = t[i] + step * pt[i];
      restart |= ns * ns + nt * nt > limit[i] * limit[i];
    }
    if (restart) {
      move(step);
      follow();
    } else {
      add_image(step);
      move(step);
    }
  }
}

}  // namespace palpate::detail
