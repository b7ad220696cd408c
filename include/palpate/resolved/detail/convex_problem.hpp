// SPDX-License-Identifier: MIT
#pragma once

/// @file The two convex problems of a contact resolved at its points: pressures, and tractions at given
/// pressures.
///
///     pressures   q >= 0,  A q - d >= 0,  q.(A q - d) = 0                            Signorini
///     tractions   |t_i| <= g_i;  sticks: u_t = a;  slips: t_i = g_i along a - u_t     Coulomb, g = mu q
///
/// Pressures by conjugate gradients on the loaded points, tractions by projected gradients with Barzilai and
/// Borwein's step: where a tool slides the discs hold every point, and conjugate gradients would begin anew
/// each time. Both begin with the last tick's result, from which a tick's hardly differs: some 3
/// iterations. A bound on them is kept; the residual says what is left. Source: [polonsky1999],
/// [barzilai1988].

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

/// How well a tick has met the conditions of contact.
struct Residual {
  int iterations = 0;
  float relative = 0;  ///< norm of what violates them, over the norm of the depths
};

/// Lists of a solve, sized at set-up.
struct PressureLists {
  AlignedList<float> q, d, r, p, y;
  void resize(std::size_t size) {
    for (auto* list : {&q, &d, &r, &p, &y}) list->resize(size);
  }
};

/// Pressures for the depths d; `apply(q, y)` gives y = A q; tolerance on the norm [m]. q is the
/// start and the result, with r = A q - d.
template <class Apply>
[[nodiscard]] Remainder solve_pressures(std::size_t n, PressureLists& lists, float tolerance, int iterations,
                                        const Apply& apply) noexcept {
  float *const q = lists.q.data(), *const r = lists.r.data(), *const p = lists.p.data(),
               *const y = lists.y.data();
  const float* const d = lists.d.data();
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
    if (clamped) {
      apply(q, r);
      for (std::size_t i = 0; i < n; ++i) r[i] -= d[i];
    }
  }
}

/// Lists of a solve, sized at set-up: tractions, their limits, anchors, displacements, and what the iteration
/// needs, each along two tangents.
struct TractionLists {
  AlignedList<float> limit, raised, s, t, as, at, us, ut, ps, pt, ys, yt;
  float step = 0;  ///< the last tick's last; 0: none [1/m]
  void resize(std::size_t size) {
    for (auto* list : {&limit, &raised, &s, &t, &as, &at, &us, &ut, &ps, &pt, &ys, &yt}) list->resize(size);
  }
  /// Moves the tractions of point i by (ds, dt), held within its disc; (ps, pt) is how far they went.
  void move(std::size_t i, float ds, float dt) noexcept {
    float ns = s[i] + ds, nt = t[i] + dt;
    const float size2 = ns * ns + nt * nt;
    if (size2 > limit[i] * limit[i]) {
      const float shrink = limit[i] / std::sqrt(size2);
      ns *= shrink, nt *= shrink;
    }
    ps[i] = ns - s[i], pt[i] = nt - t[i];
    s[i] = ns, t[i] = nt;
  }
};

/// Tractions s, t within discs of radius `limit`, for the anchors as, at. (s, t) within the discs is the
/// start and the result, with (us, ut) the displacements by pressures and tractions. `apply(s, t, us, ut)`:
/// displacements by tractions.
template <class Apply>
[[nodiscard]] Remainder solve_tractions(std::size_t n, TractionLists& lists, float tolerance, int iterations,
                                        const Apply& apply) noexcept {
  float *const us = lists.us.data(), *const ut = lists.ut.data(), *const ps = lists.ps.data(),
               *const pt = lists.pt.data(), *const ys = lists.ys.data(), *const yt = lists.yt.data();
  const float *const s = lists.s.data(), *const t = lists.t.data(), *const limit = lists.limit.data(),
                     *const as = lists.as.data(), *const at = lists.at.data();
  Remainder result;
  for (;; ++result.iterations) {
    float size2 = 0;
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
    }
    result.norm = std::sqrt(size2);
    if (!(result.norm > tolerance) || result.iterations == iterations) return result;
    for (std::size_t i = 0; i < n; ++i)
      lists.move(i, lists.step * (as[i] - us[i]), lists.step * (at[i] - ut[i]));
    apply(ps, pt, ys, yt);
    float pp = 0, py = 0;
    for (std::size_t i = 0; i < n; ++i) {
      us[i] += ys[i], ut[i] += yt[i];
      pp += ps[i] * ps[i] + pt[i] * pt[i];
      py += ps[i] * ys[i] + pt[i] * yt[i];
    }
    if (py > 0) lists.step = pp / py;
  }
}

}  // namespace palpate::detail
