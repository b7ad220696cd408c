// SPDX-License-Identifier: MIT
#pragma once

/// @file The problem of a contact resolved at its points, without friction:
///
///     q >= 0,  m.u - d >= 0,  one of them 0;  u = A P,  P = q m                         Signorini
///
/// By conjugate gradients on the loaded points. They begin with the last tick's result, from which a tick's
/// hardly differs: 0 to 3 iterations. A bound on them is kept; the residual says what is left.
/// Source: [polonsky1999].

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace palpate::detail {

/// What is left of a solve.
struct Remainder {
  int iterations = 0;
  float norm = 0;         ///< of what violates the conditions [m]
  float tolerance = 0;    ///< on it
  bool is_convex = true;  ///< false where A was found not to be positive definite: the result is none
  /// Whether the result is none; `depths`: their norm, which what a start lacks is hardly more than [m].
  [[nodiscard]] bool is_astray(float depths) const noexcept { return !is_convex || !(norm <= 10 * depths); }
};

/// How well a tick has met the conditions of contact.
struct Residual {
  int iterations = 0;
  /// Norm of what violates them, over the norm of the depths, or over what rounding allows if that is more.
  float relative = 0;
  bool near_field_only = false;  ///< the body's regular part is left out: Status::near_field_only
};

/// Loads P on the body and displacements u, by which a solve ends, sized at set-up.
struct LoadLists {
  VectorList load, u;
  void resize(std::size_t size) {
    for (auto* list : {&load, &u}) list->resize(size);
  }
};

/// Lists of a solve, sized at set-up.
struct PressureLists {
  AlignedList<float> q, r, p, y;
  void resize(std::size_t size) {
    for (auto* list : {&q, &r, &p, &y}) list->resize(size);
  }
};

/// Pressures for the depths d; `apply(q, y)` gives y = A q; tolerance on the norm [m]. q is the start and the
/// result, with r = A q - d.
template <class Apply>
[[nodiscard]] Remainder solve_pressures(std::size_t n, PressureLists& lists, const float* d, float tolerance,
                                        int iterations, const Apply& apply) noexcept {
  float *const q = lists.q.data(), *const r = lists.r.data(), *const p = lists.p.data(),
               *const y = lists.y.data();
  const auto begin = [&] {
    apply(q, r);
    for (std::size_t i = 0; i < n; ++i) r[i] -= d[i];
  };
  begin();
  float before = 1;
  bool restart = true;
  Remainder result{.tolerance = tolerance};
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
      result.is_convex = !(py < 0);
      if (restart || !result.is_convex) return result;
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
    if (clamped) begin();
  }
}

/// After a solve without friction: loads and displacements, of q and r = m.u - d.
inline void complete(std::size_t n, const VectorList& m, const float* d, const PressureLists& from,
                     LoadLists& to) noexcept {
  using V = VectorList::V;
  for (std::size_t i = 0; i < n; i += V::size()) {
    to.load.store(i, V(&from.q[i]) * m.load(i));
    to.u.store(i, (V(&from.r[i]) + V(d + i)) * m.load(i));
  }
}

}  // namespace palpate::detail
