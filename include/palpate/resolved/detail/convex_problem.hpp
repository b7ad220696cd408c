// SPDX-License-Identifier: MIT
#pragma once

/// @file The problem of a contact resolved at its points, without friction and with it.
///
///     q >= 0,  m.u - d >= 0,  one of them 0;  u = A P, q = m.P, t = P - q m           Signorini
///     |t| <= mu s q;  sticks: u_t = a;  slips: t = mu s q along a - u_t                 Coulomb
///
/// s: 1, or of finite strain (finite_strain.hpp). Without friction by conjugate gradients on the loaded
/// points. With friction by gradients of all loads at once, projected onto the cones, with Barzilai and
/// Borwein's step: where a tool slides the cones hold every point, and conjugate gradients would begin anew
/// each time. Both begin with the last tick's result, from which a tick's hardly differs: 0 to 3 iterations.
/// A bound on them is kept; the residual says what is left.
/// Source: [polonsky1999], [barzilai1988].

#include <palpate/core/aligned_list.hpp>
#include <palpate/core/simd_math.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::detail {

/// What is left of a solve.
struct Remainder {
  int iterations = 0;
  float norm = 0;         ///< of what violates the conditions [m]
  bool is_convex = true;  ///< false where A was found not to be positive definite: the result is none
  /// Whether the result is none; `depths`: their norm, which what a start lacks is hardly more than [m].
  [[nodiscard]] bool is_astray(float depths) const noexcept { return !is_convex || !(norm <= 10 * depths); }
};

/// How well a tick has met the conditions of contact.
struct Residual {
  int iterations = 0;
  float relative = 0;            ///< norm of what violates them, over the norm of the depths
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

/// A point slips from this share of its limit on, both squared: rounding of a load on its cone is below.
inline constexpr float slips_from = 0.9999f;

/// Squared: what is along a slip, over the slip, by rounding alone. Where a tool lifts off as it slides, the
/// slip is a thousand times the depth.
inline constexpr float rounding2 = 4e-12f;

/// The same of a solve with friction: where points that stick hold the surface, a, and what an iteration
/// changes.
struct FrictionLists : LoadLists {
  VectorList anchor, load_step, u_step;
  AlignedList<float> held;    ///< 1 where the point has an anchor, 0 where it has just come in: no tractions
  AlignedList<float> per_mu;  ///< limit of the tractions over mu q, s
  float step = 0;             ///< the last tick's last; 0: none [1/m]
  float mu = 0;               ///< of the result
  void resize(std::size_t size) {
    LoadLists::resize(size);
    for (auto* list : {&anchor, &load_step, &u_step}) list->resize(size);
    for (auto* list : {&held, &per_mu}) list->resize(size);
  }
};

/// After a solve without friction: loads and displacements, of q and r = m.u - d.
inline void complete(std::size_t n, const VectorList& m, const float* d, const PressureLists& from,
                     LoadLists& to) noexcept {
  using V = VectorList::V;
  for (std::size_t i = 0; i < n; i += V::size()) {
    to.load.store(i, V(&from.q[i]) * m.load(i));
    to.u.store(i, (V(&from.r[i]) + V(d + i)) * m.load(i));
  }
}
/// With friction q and r, of those.
inline void complete(std::size_t n, const VectorList& m, const float* d, PressureLists& to,
                     const FrictionLists& from) noexcept {
  using V = VectorList::V;
  for (std::size_t i = 0; i < n; i += V::size()) {
    (max)(dot(m.load(i), from.load.load(i)), V(0.f)).copy_to(&to.q[i]);
    (dot(m.load(i), from.u.load(i)) - V(d + i)).copy_to(&to.r[i]);
  }
}

/// A load of normal part q >= 0 along m and tractions t, these within mu q.
template <class V>
[[nodiscard]] PALPATE_INLINE SimdVec3<V> within_cone(const V& mu, const SimdVec3<V>& m, const V& q,
                                                     const SimdVec3<V>& t) noexcept {
  const V t2 = dot(t, t), bound = mu * q, tiny((std::numeric_limits<float>::min)());
  return q * m + select(t2 > bound * bound, bound * inverse_sqrt((max)(t2, tiny)), V(1.f)) * t;
}

/// Loads for the depths d along m; `lists.load` is the start and the result, with u = A P. `apply(P, u)`
/// gives u = A P; `coefficient(q)`: mu at the sum q of normal loads; `tangential`: of A's tangential over its
/// normal size; tolerance on the norm [m].
template <class Apply, class Coefficient>
[[nodiscard]] Remainder solve_loads(std::size_t n, FrictionLists& lists, const VectorList& m, const float* d,
                                    float tangential, float first_step, float tolerance, int iterations,
                                    const Apply& apply, const Coefficient& coefficient) noexcept {
  using V = VectorList::V;
  const V zero(0.f), tiny((std::numeric_limits<float>::min)());
  Remainder result;
  V total(0.f);
  for (std::size_t i = 0; i < n; i += V::size()) total += (max)(dot(m.load(i), lists.load.load(i)), zero);
  lists.mu = coefficient(reduce(total));
  for (std::size_t i = 0; i < n; i += V::size()) {
    const SimdVec3<V> mi = m.load(i), P = lists.load.load(i);
    const V q = dot(mi, P);
    lists.load.store(i, within_cone(V(lists.mu) * V(&lists.per_mu[i]), mi, (max)(q, zero),
                                    V(&lists.held[i]) * (P - q * mi)));
  }
  if (lists.step == 0) lists.step = first_step;
  apply(lists.load, lists.u);
  for (;; ++result.iterations) {
    const float mu = lists.mu, normal = lists.step, across = lists.step / tangential;
    V left(0.f), PP(0.f);
    total = V(0.f);
    for (std::size_t i = 0; i < n; i += V::size()) {
      const SimdVec3<V> mi = m.load(i), P = lists.load.load(i), u = lists.u.load(i);
      const V held(&lists.held[i]), q = dot(mi, P), mui = V(mu) * V(&lists.per_mu[i]),
                                    limit = mui * (max)(q, zero);
      const SimdVec3<V> t = P - q * mi, from = u - lists.anchor.load(i);
      const V gap = dot(mi, u) - V(d + i);
      const SimdVec3<V> g = held * (from - dot(mi, from) * mi);
      // What violates the conditions: a point that slips may do so along its disc's rim.
      const V t2 = dot(t, t), out = (min)(dot(g, t), zero);
      const SimdVec3<V> along =
          g - select(t2 < V(slips_from) * limit * limit, zero, out / (max)(t2, tiny)) * t;
      const V wrong = select(q > zero, gap, (min)(gap, zero));
      const V along2 = dot(along, along), counts = V(rounding2) * dot(g, g);
      left += wrong * wrong + select(limit > zero, select(along2 > counts, along2, zero), zero);
      // A step down, held within the cone.
      const V next = (max)(q - V(normal) * gap, zero);
      const SimdVec3<V> step = within_cone(mui, mi, next, t - V(across) * g) - P;
      const V dq = dot(mi, step);
      PP += V(tangential) * dot(step, step) + V(1 - tangential) * dq * dq;
      total += next;
      lists.load_step.store(i, step);
    }
    result.norm = std::sqrt(reduce(left));
    if (!(result.norm > tolerance) || result.iterations == iterations) return result;
    apply(lists.load_step, lists.u_step);
    V Pu(0.f);
    for (std::size_t i = 0; i < n; i += V::size()) {
      const SimdVec3<V> dP = lists.load_step.load(i), du = lists.u_step.load(i);
      lists.load.store(i, lists.load.load(i) + dP);
      lists.u.store(i, lists.u.load(i) + du);
      Pu += dot(dP, du);
    }
    lists.mu = coefficient(reduce(total));
    const float moved = reduce(Pu);
    result.is_convex = !(moved < 0);
    lists.step = moved > 0 ? reduce(PP) / moved : result.is_convex ? lists.step : 0;
    if (!result.is_convex) return result;
  }
}

}  // namespace palpate::detail
