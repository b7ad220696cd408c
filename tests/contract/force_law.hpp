// SPDX-License-Identifier: MIT
#pragma once

/// @file What every force law must keep (law/force/concept.hpp), run on an example of each policy.
///
/// An example is a type with
///     static constexpr double depth;      // a depth [m] at which the law is well in its range
///     static constexpr bool exact_units;  // F, dF/dD, energy commute with units of 2^n bit for bit
///     template <class S> static std::vector<S> kinks();  // where d2F/dD2 jumps [m]
///     template <class S, class T> static Law<T> make(T length, T force);
/// `make` builds the law whose parameters are those of the example, rounded to S, in units of `length` metres
/// and `force` newtons, so that the same law exists in long double and in other units.

#include "support/check.hpp"

#include <palpate/core/error.hpp>
#include <palpate/law/force/concept.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace palpate::test {

/// dF/dD by Richardson extrapolation of central differences: three step widths, error O(h^6).
template <class Law>
[[nodiscard]] long double richardson_derivative(const Law& law, long double x, long double h) {
  const auto central = [&](long double s) { return (law.force(x + s) - law.force(x - s)) / (2 * s); };
  const long double a = central(h), b = central(h / 2), c = central(h / 4);
  const long double ab = (4 * b - a) / 3, bc = (4 * c - b) / 3;
  return (16 * bc - ab) / 15;
}

/// Integral of F over [a, b] by adaptive Simpson, to about 1e-16 of the whole.
template <class Law>
[[nodiscard]] long double integral(const Law& law, long double a, long double b, long double whole,
                                   int level = 0) {
  const long double m = (a + b) / 2;
  const long double fa = law.force(a), fl = law.force((a + m) / 2), fm = law.force(m),
                    fr = law.force((m + b) / 2), fb = law.force(b);
  const long double one = (b - a) / 6 * (fa + 4 * fm + fb);
  const long double two = (b - a) / 12 * (fa + 4 * fl + 2 * fm + 4 * fr + fb);
  if (level > 3 && (level > 40 || std::fabs(two - one) <= 1e-16L * whole)) return two + (two - one) / 15;
  return integral(law, a, m, whole, level + 1) + integral(law, m, b, whole, level + 1);
}

/// Up to the largest number and to infinity, and down to the smallest: every answer is a number or infinity,
/// none falls, and the inverse stays within the law.
template <Real S, class Law>
void number_everywhere(const Law& law) {
  using L = std::numeric_limits<S>;
  std::vector<S> all{L::denorm_min(), (L::min)()};
  for (int e = L::min_exponent; e < L::max_exponent; e += 3) all.push_back(std::ldexp(S(1), e));
  all.insert(all.end(), {(L::max)() / S(2), (L::max)() * S(0.99L), (L::max)(), L::infinity()});
  const S held = S(1) - S(64) * L::epsilon();  // a step down within rounding is not a fall
  S force = S(0), energy = S(0), depth = S(0);
  int bad = 0;  // a NaN makes every comparison false
  for (const S x : all) {
    const S F = law.force(x), U = law.energy(x), D = law.depth(x);
    bad += !(F >= force * held) + !(U >= energy * held) + !(D >= depth * held);
    bad += !(law.stiffness(x) >= S(0)) + !(D <= law.max_depth()) + !(law.depth(F) >= S(0));
    force = F;
    energy = U;
    depth = D;
  }
  CHECK(bad == 0);
  CHECK((force == law.force(law.max_depth()) || force == law.force((L::max)())));
}

/// A force law of whatever type, so that the suite is compiled once for all of them.
template <Real T>
class AnyLaw {
 public:
  template <class Law>
  explicit AnyLaw(const Law& law) : law_(std::make_shared<const Of<Law>>(law)) {}
  [[nodiscard]] T force(T depth) const { return law_->force(depth); }
  [[nodiscard]] T stiffness(T depth) const { return law_->stiffness(depth); }
  [[nodiscard]] T energy(T depth) const { return law_->energy(depth); }
  [[nodiscard]] T depth(T force) const { return law_->depth(force); }
  [[nodiscard]] T max_depth() const { return law_->max_depth(); }

 private:
  struct Any {
    virtual ~Any() = default;
    virtual T force(T depth) const = 0;
    virtual T stiffness(T depth) const = 0;
    virtual T energy(T depth) const = 0;
    virtual T depth(T force) const = 0;
    virtual T max_depth() const = 0;
  };
  template <class Law>
  struct Of final : Any {
    explicit Of(const Law& l) : law(l) {}
    T force(T depth) const override { return law.force(depth); }
    T stiffness(T depth) const override { return law.stiffness(depth); }
    T energy(T depth) const override { return law.energy(depth); }
    T depth(T force) const override { return law.depth(force); }
    T max_depth() const override { return law.max_depth(); }
    Law law;
  };
  std::shared_ptr<const Any> law_;
};

template <Real S>
struct ForceLawSuite {
  using Law = AnyLaw<S>;

  std::function<Law(S length, S force)> make;
  AnyLaw<long double> exact;
  double example_depth;
  bool exact_units;
  std::vector<S> kinks;
  Law law = make(S(1), S(1));
  S limit = static_cast<S>(example_depth) < law.max_depth() ? static_cast<S>(example_depth) : law.max_depth();

  void run() const {
    no_contact();
    bad_input();
    accuracy();
    tangent_and_energy();
    monotone();
    inverse();
    held_beyond_the_stable_branch();
    units();
    ends_of_the_range();
  }

  /// Depths over many decades below the example's depth.
  [[nodiscard]] std::vector<S> depths() const {
    std::vector<S> all;
    for (int i = 0; i <= 60; ++i) all.push_back(static_cast<S>(limit * std::pow(S(10), S(-i) / S(8))));
    std::mt19937_64 random(20050608);  // fixed seed
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < 60; ++i) all.push_back(limit * static_cast<S>(share(random)));
    return all;
  }

  void no_contact() const {
    for (const S depth : {S(0), -S(0), S(-1e-30), S(-1e-3), S(-1e30), -std::numeric_limits<S>::infinity()}) {
      CHECK(law.force(depth) == S(0));
      CHECK(law.stiffness(depth) == S(0));
      CHECK(law.energy(depth) == S(0));
      CHECK(law.depth(depth) == S(0));  // no force, no depth
    }
    // and the law grows from there without a step
    CHECK(law.force(std::numeric_limits<S>::min()) < law.force(limit) * static_cast<S>(1e-6));
  }

  void bad_input() const {
    const S nan = std::numeric_limits<S>::quiet_NaN(), infinity = std::numeric_limits<S>::infinity();
    CHECK(law.force(nan) == S(0));
    CHECK(law.stiffness(nan) == S(0));
    CHECK(law.energy(nan) == S(0));
    CHECK(law.depth(nan) == S(0));
    // Infinitely deep: kept at the maximum where there is one, else infinite, which the solver catches.
    CHECK(law.force(infinity) == (is_finite(law.max_depth()) ? law.force(law.max_depth()) : infinity));
    CHECK(law.depth(infinity) <= law.max_depth());
  }

  // 1e-14 in double, 1e-6 in float: the library's promise for a point pressed in.
  static constexpr long double promise = std::numeric_limits<S>::digits > 50 ? 1e-14L : 1e-6L;

  void accuracy() const {
    for (const S depth : depths()) CHECK_RELATIVE(law.force(depth), exact.force(depth), promise);
  }

  void tangent_and_energy() const {
    for (const S depth : depths()) {
      const long double h = 1e-3L * static_cast<long double>(depth);
      bool smooth = static_cast<long double>(depth) + h < static_cast<long double>(law.max_depth());
      for (const S kink : kinks) {
        smooth = smooth && std::fabs(static_cast<long double>(kink - depth)) > h;
      }
      if (smooth) {
        // Tangents are sums of terms of the size of the secant F/D, which cancel at a fold or a limit: hence
        // the scale. The reference is good to about 1e-15 of it.
        const long double reference = richardson_derivative(exact, static_cast<long double>(depth), h);
        const long double scale = reference + exact.force(depth) / static_cast<long double>(depth);
        CHECK_ABSOLUTE(law.stiffness(depth), reference, (promise + 1e-15L) * scale);
      }
    }
    // Energy by quadrature: its own error 1e-15, plus a dozen roundings.
    for (const S share : {S(1e-4), S(0.01), S(0.3), S(0.6), S(0.9), S(1), S(1.5), S(3)}) {
      const auto depth = static_cast<long double>(share * limit);
      const long double reference = integral(exact, 0, depth, exact.energy(depth));
      CHECK_RELATIVE(law.energy(share * limit), reference, ulps<S>(16) + 1e-15L);
    }
  }

  void monotone() const {
    S before = S(0);
    int falls = 0;
    for (int i = 1; i <= 4000; ++i) {
      const S depth = limit * static_cast<S>(i) / S(4000);
      const S force = law.force(depth);
      // A step down within rounding is not a fall.
      if (!(force >= before * (S(1) - S(4) * std::numeric_limits<S>::epsilon()))) ++falls;
      if (!(law.stiffness(depth) >= S(0))) ++falls;
      before = force;
    }
    CHECK(falls == 0);
    CHECK(law.max_depth() > S(0));
  }

  void inverse() const {
    const long double unit = ulps<S>(1);
    for (const S depth : depths()) {
      // A rounded force moves the depth by its error over the stiffness; the inverse adds a few roundings of
      // its own.
      const S force = law.force(depth);
      if (!(law.stiffness(depth) > S(0))) continue;
      const long double condition =
          static_cast<long double>(force) / static_cast<long double>(law.stiffness(depth));
      // Next to the fold the stiffness itself falls within that error: second order, hence the square root.
      const long double first = 8 * unit * (static_cast<long double>(depth) + condition);
      const long double fold = std::sqrt(8 * unit) * static_cast<long double>(limit);
      const bool flat = law.stiffness(depth) < S(1e-2) * law.stiffness(limit / S(2));
      CHECK_ABSOLUTE(law.depth(force), depth, flat ? fold : first);
      CHECK_RELATIVE(law.force(law.depth(force)), force,
                     8 * unit * (1 + static_cast<long double>(depth) / condition));
    }
  }

  void held_beyond_the_stable_branch() const {
    if (!is_finite(law.max_depth())) return;
    const S most = law.force(law.max_depth());
    for (const S share : {S(1), S(1.001), S(2), S(1e6)}) {
      CHECK(law.force(share * law.max_depth()) == most);
      CHECK(law.depth(share * most) == law.max_depth());
    }
    CHECK(law.stiffness(law.max_depth() * S(1.001)) == S(0));
    CHECK_RELATIVE(law.energy(S(3) * law.max_depth()) - law.energy(S(2) * law.max_depth()),
                   most * law.max_depth(),
                   ulps<S>(32));  // difference of two numbers three times as large
  }

  // The same law in other units gives the same physics: to the bit where the units are powers of 2, unless a
  // product and a sum may be rounded together in one of two places and not in the other.
  void units() const {
    const S length = S(1) / S(1024), force = S(8);  // D [length] F [force]
    const Law other = make(length, force);
    // Where not exact: a few roundings, of the size of the terms as in tangent_and_energy().
#if defined(__FMA__)
    constexpr bool same_roundings = false;
#else
    constexpr bool same_roundings = true;
#endif
    const long double tolerance = exact_units && same_roundings ? 0 : ulps<S>(16);
    for (const S depth : depths()) {
      const S f = law.force(depth), k = law.stiffness(depth) + f / depth;
      CHECK_ABSOLUTE(other.force(depth / length) * force, f, tolerance * static_cast<long double>(f));
      CHECK_ABSOLUTE(other.stiffness(depth / length) * force / length, law.stiffness(depth),
                     tolerance * static_cast<long double>(k));
      CHECK_RELATIVE(other.energy(depth / length) * force * length, law.energy(depth), tolerance);
      // The inverse may differ in its last bits: cbrt() and pow() promise nothing about powers of 2. Close to
      // a fold or a limit (k of the order of f / depth or less) it is left to inverse().
      if (law.stiffness(depth) * depth > f / S(8)) {
        CHECK_RELATIVE(other.depth(f / force) * length, law.depth(f), ulps<S>(32));
      }
    }
    if (is_finite(law.max_depth())) CHECK_RELATIVE(other.max_depth() * length, law.max_depth(), tolerance);
    // Units that are not powers of 2: the parameters are rounded once more.
    const Law decimal = make(S(0.001), S(0.1));
    for (const S depth : depths()) {
      if (depth > S(0.99) * law.max_depth()) continue;
      CHECK_RELATIVE(decimal.force(depth / S(0.001)), law.force(depth) / S(0.1), ulps<S>(16));
    }
  }

  // As it is, and in units in which the parameters come near the ends of the range or are refused.
  void ends_of_the_range() const {
    number_everywhere<S>(law);
    int made = 0;
    for (int i = -6; i <= 6; ++i)
      for (int j = -6; j <= 6; ++j) {
        const int step = std::numeric_limits<S>::max_exponent / 8;
        try {
          const Law other = make(std::ldexp(S(1), i * step), std::ldexp(S(1), j * step));
          ++made;
          number_everywhere<S>(other);
        } catch (const SetupError&) {
        }
      }
    CHECK(made > 20);
  }
};

template <class Example, Real S>
[[nodiscard]] ForceLawSuite<S> force_law_suite() {
  return {.make = [](S length, S force) { return AnyLaw<S>(Example::template make<S>(length, force)); },
          .exact = AnyLaw<long double>(Example::template make<S>(1.0L, 1.0L)),
          .example_depth = Example::depth,
          .exact_units = Example::exact_units,
          .kinks = Example::template kinks<S>()};
}

}  // namespace palpate::test
