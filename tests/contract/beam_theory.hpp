// SPDX-License-Identifier: MIT
#pragma once

/// @file What every beam theory must keep (luo_xiao/beam/concept.hpp), run on an example of each.
///
/// An example is a type with
///     template <class T> static Theory<T> make(T pressure);   // in units of `pressure` pascals
///     static long double tip(E, nu, S, I, l);                 // tip compliance [m/N], from the literature

#include "support/check.hpp"

#include <palpate/luo_xiao/beam/concept.hpp>
#include <palpate/luo_xiao/beam/section.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace palpate::test {

template <class Example, Real S>
struct BeamTheorySuite {
  using L = long double;
  using Theory = decltype(Example::template make<S>(S(1)));
  Theory theory = Example::template make<S>(S(1));
  CircularSection<S> section{{.radius = S(0.004)}};

  void run() const {
    static_assert(BeamTheory<Theory>);
    for (const double l : {0.002, 0.01, 0.08, 4.0}) {
      INFO("length ", l);
      closed_form(S(l));
      deflection_line(S(l));
      equation(S(l));
      units(S(l));
    }
    slender_limit();
  }

  void closed_form(S l) const {
    const auto& p = theory.material().params();
    const L r = section.radius(), area = std::numbers::pi_v<L> * r * r, I = area * r * r / 4;
    CHECK_RELATIVE(theory.axial_stiffness(section, l), p.E * area / l, ulps<S>(8));
    CHECK_RELATIVE(theory.transverse_stiffness(section, l),
                   1 / Example::tip(p.E, p.nu, area, I, static_cast<L>(l)), ulps<S>(16));
  }
  void deflection_line(S l) const {
    const S F = S(2.5), tip = theory.deflection(section, l, F, l);
    CHECK(theory.deflection(section, l, F, S(0)) == 0);
    CHECK_RELATIVE(tip * theory.transverse_stiffness(section, l), F, ulps<S>(16));
    S before = 0;
    for (int i = 1; i <= 16; ++i) {
      const S x = l * S(i) / S(16), y = theory.deflection(section, l, F, x);
      CHECK(y > before);
      CHECK(theory.deflection(section, l, -F, x) == -y);
      CHECK_RELATIVE(theory.deflection(section, l, S(2) * F, x), S(2) * y, ulps<S>(2));
      before = y;
    }
  }
  /// E I y'' = F (l - x): shear adds nothing to the curvature. Second differences are exact for the cubic.
  void equation(S l) const {
    const auto exact = Example::template make<L>(1.0L);
    const CircularSection<L> wide({.radius = static_cast<L>(section.radius())});
    const L h = static_cast<L>(l) / 64, EI = exact.material().params().E * wide.second_moment_z(), length = l;
    for (int i = 4; i <= 60; i += 8) {
      const L x = h * i;
      const auto y = [&](L s) { return exact.deflection(wide, length, 1.0L, s); };
      // (l/h)^2 = 4096 rounding errors of the deflection, larger by the shear's share in a short beam
      CHECK_ABSOLUTE(EI * (y(x + h) - 2 * y(x) + y(x - h)) / (h * h), length - x, 1e-12L * length);
      CHECK_RELATIVE(theory.deflection(section, l, S(1), static_cast<S>(x)), y(x), ulps<S>(32));
    }
  }
  /// Metres to 1/8 m and pascals to 64 Pa: the same beam.
  void units(S l) const {
    const auto scaled = Example::template make<S>(S(64));
    const CircularSection<S> eighths({.radius = section.radius() * S(8)});
    const S per_length = S(64) / S(8);  // stiffness is pressure times length
    CHECK_RELATIVE(scaled.transverse_stiffness(eighths, l * S(8)) * per_length,
                   theory.transverse_stiffness(section, l), ulps<S>(8));
    CHECK_RELATIVE(scaled.axial_stiffness(eighths, l * S(8)) * per_length, theory.axial_stiffness(section, l),
                   ulps<S>(8));
  }
  void slender_limit() const {
    const S l = S(1e4) * section.radius();
    const S k = S(3) * theory.material().params().E * (section.second_moment_z() / l) / (l * l);
    CHECK_RELATIVE(theory.transverse_stiffness(section, l), k,
                   1e-6L);  // shear's share is 3.6 (r/l)^2, and float
    for (const double ratio : {0.5, 1.0, 5.0, 20.0}) {
      const S s = S(ratio) * section.radius();
      const S bending = S(3) * theory.material().params().E * (section.second_moment_z() / s) / (s * s);
      CHECK(theory.transverse_stiffness(section, s) <=
            bending * S(1.000001));  // nothing is stiffer than bending alone
    }
  }
};

}  // namespace palpate::test
