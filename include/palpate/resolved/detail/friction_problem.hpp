// SPDX-License-Identifier: MIT
#pragma once

/// @file The problem of a contact resolved at its points, with friction:
///
///     q >= 0,  m.u - d >= 0,  one of them 0;  u = A P, q = m.P, t = P - q c           Signorini
///     |t| <= mu s q;  sticks: u_t = a;  slips: t = mu s q along a - u_t                 Coulomb
///
/// s, c: friction_cones.hpp; c.m = 1. By gradients of all loads at once, projected onto the cones: where a
/// tool slides the cones hold every point, and conjugate gradients would begin anew each time. A step is that
/// of a simpler body,
///
///     du_i = D_i dP_i + z,   z = C sum_j dP_j
///
/// D diagonal, by Barzilai and Borwein; C, 3 x 3, what all loads do to all points: a slender part bends by a
/// thousand times its dent, and a step that is short enough for that leaves the dent as it is. For a given z
/// each point's step is known; z itself is found by Newton's method. Source: [barzilai1988], [becker2012].

#include <palpate/core/simd_math.hpp>
#include <palpate/core/vector.hpp>
#include <palpate/resolved/detail/convex_problem.hpp>
#include <palpate/resolved/detail/vector_list.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace palpate::detail {

/// A point slips from this share of its limit on, both squared: rounding of a load on its cone is below.
inline constexpr float slips_from = 0.9999f;

/// Squared: what is along a slip, over the slip, by rounding alone. Where a tool lifts off as it slides, the
/// slip is a thousand times the depth.
inline constexpr float rounding2 = 4e-12f;

/// The same: where points that stick hold the surface, a, and what an iteration
/// changes.
struct FrictionLists : LoadLists {
  VectorList anchor, load_step, u_step;
  AlignedList<float> anchored;  ///< 1 where the point has an anchor; 0 where it is new: no tractions
  AlignedList<float> per_mu;    ///< limit of the tractions over mu q, s; 1 from set-up on
  float step = 0;               ///< the last tick's last; 0: none [1/m]
  float mu = 0;                 ///< of the result
  void resize(std::size_t size) {
    LoadLists::resize(size);
    for (auto* list : {&anchor, &load_step, &u_step}) list->resize(size);
    for (auto* list : {&anchored, &per_mu}) list->resize(size);
    std::fill_n(per_mu.data(), size, 1.f);
  }
};

/// With friction q and r, of those.
inline void complete(std::size_t n, const VectorList& m, const float* d, PressureLists& to,
                     const FrictionLists& from) noexcept {
  using V = VectorList::V;
  for (std::size_t i = 0; i < n; i += V::size()) {
    (max)(dot(m.load(i), from.load.load(i)), V(0.f)).copy_to(&to.q[i]);
    (dot(m.load(i), from.u.load(i)) - V(d + i)).copy_to(&to.r[i]);
  }
}

/// What A is taken for in a step.
struct LoadModel {
  float step;          ///< the first, of loads along m: 1/D [m]
  float tangential;    ///< of A's tangential over its normal size
  Mat3<float> common;  ///< C [1/m]; not used where it is not positive definite
  [[nodiscard]] bool has_common() const noexcept {
    return common(0, 0) > 0 && common.topLeftCorner<2, 2>().determinant() > 0 && common.determinant() > 0;
  }
};

/// Points of a solve, a register of them, with all displacements z more than they are.
struct LoadedPoints {
  using V = VectorList::V;
  SimdVec3<V> m, c, t, slip;        // of pressing; axis; tractions; surface over anchor
  V q, limit_per_q, anchored, gap;  // normal load; mu s; FrictionLists::anchored; m.u - d

  PALPATE_INLINE LoadedPoints(const FrictionLists& lists, const VectorList& directions,
                              const VectorList& axes, const float* d, std::size_t i,
                              const SimdVec3<V>& z) noexcept
      : m(directions.load(i)),
        c(axes.load(i)),
        limit_per_q(V(lists.mu) * V(&lists.per_mu[i])),
        anchored(&lists.anchored[i]) {
    const SimdVec3<V> P = lists.load.load(i), u = lists.u.load(i);
    q = dot(m, P), t = P - q * c;
    // z last: it may be less than the last digit of u.
    gap = (dot(m, u) - V(d + i)) + dot(m, z);
    slip = anchored * (across(m, u - lists.anchor.load(i)) + across(m, z));
  }
};

/// How the steps of points answer to z: -d(dP)/dz.
struct StepSlope {
  using V = VectorList::V;
  SimdVec3<V> m, e, by_m, by_e;
  V all;

  /// They yield by `normal` along c to what is along m, and by `tangential` across m. Those that slip (1,
  /// else 0), along e, with `per_q` of their normal load, yield along e by that alone.
  PALPATE_INLINE StepSlope(const SimdVec3<V>& m_, const SimdVec3<V>& c, const SimdVec3<V>& e_,
                           const V& normal, const V& tangential, const V& slips, const V& per_q) noexcept
      : m(m_),
        e(e_),
        by_m(normal * (c + (slips * per_q) * e) - tangential * m),
        by_e((slips * tangential) * e),
        all(tangential) {}
  [[nodiscard]] PALPATE_INLINE SimdVec3<V> operator*(const SimdVec3<V>& z) const noexcept {
    return dot(m, z) * by_m - dot(e, z) * by_e + all * z;
  }
};

/// The same of the sum of all steps.
class SlopeSum {
 public:
  using V = VectorList::V;
  PALPATE_INLINE void operator+=(const StepSlope& s) noexcept {
    x_ += s.m.x * s.by_m - s.e.x * s.by_e;
    y_ += s.m.y * s.by_m - s.e.y * s.by_e;
    z_ += s.m.z * s.by_m - s.e.z * s.by_e;
    all_ += s.all;
  }
  [[nodiscard]] Mat3<float> matrix() const noexcept {
    Mat3<float> S;
    S << sum_of(x_), sum_of(y_), sum_of(z_);
    return S + reduce(all_) * Mat3<float>::Identity();
  }

 private:
  SimdVec3<V> x_{}, y_{}, z_{};  // columns
  V all_{};                      // on the diagonal, too
};

/// Steps of all loads towards the conditions of contact.
class FrictionSteps {
 public:
  using V = VectorList::V;
  FrictionSteps(std::size_t n, FrictionLists& lists, const VectorList& m, const VectorList& axes,
                const float* d, const LoadModel& model) noexcept
      : n_(n),
        lists_(lists),
        m_(m),
        axes_(axes),
        d_(d),
        model_(model),
        has_common_(model.has_common()),
        stiffness_(model.common.cast<double>().inverse()) {}

  /// Loads into their cones; those without an anchor have no tractions.
  template <class Coefficient>
  void begin(const Coefficient& coefficient) noexcept {
    V total{};
    for (std::size_t i = 0; i < n_; i += V::size())
      total += (max)(dot(m_.load(i), lists_.load.load(i)), V(0.f));
    lists_.mu = coefficient(reduce(total));
    for (std::size_t i = 0; i < n_; i += V::size()) {
      const SimdVec3<V> c = axes_.load(i), P = lists_.load.load(i);
      const V q = dot(m_.load(i), P), next = (max)(q, V(0.f));
      const SimdVec3<V> t = V(&lists_.anchored[i]) * (P - q * c);
      lists_.load.store(i, next * c + within(V(lists_.mu) * V(&lists_.per_mu[i]) * next, dot(t, t)) * t);
    }
    if (lists_.step == 0) lists_.step = model_.step;
  }

  /// The norm of what violates the conditions [m].
  [[nodiscard]] float violation() noexcept {
    const V zero(0.f);
    V left{}, loads{};
    for (std::size_t i = 0; i < n_; i += V::size()) {
      const LoadedPoints p(lists_, m_, axes_, d_, i, SimdVec3<V>{});
      const V limit = p.limit_per_q * (max)(p.q, zero), t2 = dot(p.t, p.t),
              out = (min)(dot(p.slip, p.t), zero);
      // A point that slips may do so along its disc's rim.
      const SimdVec3<V> along =
          p.slip - select(t2 < V(slips_from) * limit * limit, zero, out / (max)(t2, V(tiny))) * p.t;
      const V wrong = select(p.q > zero, p.gap, (min)(p.gap, zero));
      const V along2 = dot(along, along), counts = V(rounding2) * dot(p.slip, p.slip);
      left += wrong * wrong + select(limit > zero, select(along2 > counts, along2, zero), zero);
      loads += (max)(p.q, zero);
    }
    rounding_ = has_common_ ? rounding * model_.common.diagonal().maxCoeff() * reduce(loads) : 0;
    return std::sqrt(reduce(left));
  }
  /// What that cannot be less than with loads in single precision [m].
  [[nodiscard]] float rounding_error() const noexcept { return rounding_; }

  /// The step, to lists.load_step. Returns the sum of normal loads after it.
  float find() noexcept {
    if (has_common_) begin_shift();
    // Newton's method, with a search along each direction, for the z at which C^-1 z is the sum of steps.
    Vec3<double> from = Vec3<double>::Zero(), direction = from;
    double share = 1, low = 0, high = 0, begin = 0;
    for (int k = 0;; ++k) {
      SlopeSum slopes;
      const float total = step(slopes);
      if (!has_common_ || k == most_shifts) return total;
      const float miss = (z_ - model_.common * sum_).norm();
      if (miss <= (std::max)(close * z_.norm(), rounding_ / 4)) return total;
      const Vec3<double> z = z_.cast<double>(), left = stiffness_ * z - sum_.cast<double>();
      const Mat3<double> slope = slope_of(slopes);
      const double off = direction.dot(left);
      if (k == 0 || std::abs(off) <= std::abs(begin) / 2 || (off < 0 && !(high > 0))) {
        from = z, direction = -(slope.inverse() * left), begin = direction.dot(left);
        share = 1, low = high = 0;
      } else {
        (off > 0 ? high : low) = share;
        share -= off / direction.dot(slope * direction);
        if (!(share > low && share < high)) share = (low + high) / 2;
      }
      const Vec3<float> next = (from + share * direction).cast<float>();
      if (!is_finite(next)) return total;
      z_ = next;
    }
  }
  /// Takes the step, with lists.u_step = A lists.load_step. False where A is not positive definite.
  template <class Coefficient>
  [[nodiscard]] bool take(float total, const Coefficient& coefficient) noexcept {
    V done{}, sizes{};
    for (std::size_t i = 0; i < n_; i += V::size()) {
      const SimdVec3<V> m = m_.load(i), dP = lists_.load_step.load(i), du = lists_.u_step.load(i);
      lists_.load.store(i, lists_.load.load(i) + dP);
      lists_.u.store(i, lists_.u.load(i) + du);
      const V dq = dot(m, dP);
      done += dot(dP, du);
      sizes += V(model_.tangential) * dot(dP, dP) + V(1 - model_.tangential) * dq * dq;
    }
    lists_.mu = coefficient(total);
    const float work = reduce(done), own = has_common_ ? work - sum_.dot(model_.common * sum_) : work;
    const float most = 2 * model_.step;
    lists_.step = work < 0 ? 0 : reduce(sizes) < most * own ? reduce(sizes) / own : most;
    return !(work < 0);
  }

 private:
  static constexpr float tiny = (std::numeric_limits<float>::min)();
  static constexpr float close = 0.03f;     // of z: a step is as good, and the next one's is less
  static constexpr float rounding = 1e-6f;  // of what the loads do: 17 of the last digits
  static constexpr int most_shifts = 10;    // loops over the points for a step: 1 or 2 are common

  // Of tractions, their square, that are to be at most `bound`.
  [[nodiscard]] static PALPATE_INLINE V within(const V& bound, const V& t2) noexcept {
    return select(t2 > bound * bound, bound * inverse_sqrt((max)(t2, V(tiny))), V(1.f));
  }
  // How C^-1 z less the sum of steps answers to z.
  [[nodiscard]] Mat3<double> slope_of(const SlopeSum& steps) const noexcept {
    return stiffness_ + steps.matrix().cast<double>();
  }
  // The z that would do if points went on to be loaded and to slip as they do.
  void begin_shift() noexcept {
    const V zero(0.f), one(1.f), normal(lists_.step), tangential(lists_.step / model_.tangential);
    SlopeSum slopes;
    SimdVec3<V> steps{};
    for (std::size_t i = 0; i < n_; i += V::size()) {
      const LoadedPoints p(lists_, m_, axes_, d_, i, SimdVec3<V>{});
      const V limit = p.limit_per_q * p.q, t2 = dot(p.t, p.t), loaded = select(p.q > zero, one, zero),
              slips = select(t2 < V(slips_from) * limit * limit, zero,
                             select(dot(p.slip, p.t) < zero, one, zero));
      const StepSlope slope(p.m, p.c, inverse_sqrt((max)(t2, V(tiny))) * p.t, loaded * normal,
                            loaded * p.anchored * tangential, slips, p.limit_per_q);
      slopes += slope;
      steps -= slope * (p.gap * p.m + p.slip);
    }
    const Vec3<double> z = slope_of(slopes).inverse() * sum_of(steps).cast<double>();
    z_ = is_finite(z) ? Vec3<float>(z.cast<float>()) : Vec3<float>(Vec3<float>::Zero());
  }
  // The points' steps at z. Returns the sum of normal loads then.
  float step(SlopeSum& slopes) noexcept {
    const V zero(0.f), one(1.f), normal(lists_.step), tangential(lists_.step / model_.tangential);
    const SimdVec3<V> z = each<V>(z_);
    V total{};
    SimdVec3<V> sum{};
    for (std::size_t i = 0; i < n_; i += V::size()) {
      const LoadedPoints p(lists_, m_, axes_, d_, i, z);
      const V dq = (max)(-(normal * p.gap), -p.q), next = p.q + dq;
      const SimdVec3<V> t = p.t - tangential * p.slip;
      const V t2 = dot(t, t), bound = p.limit_per_q * next, share = within(bound, t2);
      const SimdVec3<V> dP = dq * p.c + (share - one) * p.t - (share * tangential) * p.slip;
      lists_.load_step.store(i, dP);
      total += next, sum += dP;
      if (!has_common_) continue;
      slopes += StepSlope(p.m, p.c, inverse_sqrt((max)(t2, V(tiny))) * t, select(next > zero, normal, zero),
                          select(next > zero, share * p.anchored * tangential, zero),
                          select(share < one, one, zero), p.limit_per_q);
    }
    sum_ = sum_of(sum);
    return reduce(total);
  }

  std::size_t n_;
  FrictionLists& lists_;
  const VectorList &m_, &axes_;
  const float* d_;
  const LoadModel& model_;
  bool has_common_;
  Mat3<double> stiffness_;                                           // C^-1 [m]
  Vec3<float> z_ = Vec3<float>::Zero(), sum_ = Vec3<float>::Zero();  // [m]; of the steps
  float rounding_ = 0;
};

/// Loads for the depths d along m, on cones about `axes`; `lists.load` is the start and the result, with
/// u = A P. `apply(P, u)` gives u = A P; `coefficient(q)`: mu at the sum q of normal loads; tolerance on the
/// norm [m].
template <class Apply, class Coefficient>
[[nodiscard]] Remainder solve_loads(std::size_t n, FrictionLists& lists, const VectorList& m,
                                    const VectorList& axes, const float* d, const LoadModel& model,
                                    float tolerance, int iterations, const Apply& apply,
                                    const Coefficient& coefficient) noexcept {
  FrictionSteps steps(n, lists, m, axes, d, model);
  steps.begin(coefficient);
  apply(lists.load, lists.u);
  Remainder result;
  for (;; ++result.iterations) {
    result.norm = steps.violation();
    result.tolerance = (std::max)(tolerance, steps.rounding_error());
    if (!(result.norm > result.tolerance) || result.iterations == iterations) return result;
    const float total = steps.find();
    apply(lists.load_step, lists.u_step);
    result.is_convex = steps.take(total, coefficient);
    if (!result.is_convex) return result;
  }
}

}  // namespace palpate::detail
