// SPDX-License-Identifier: MIT
// The force law suite on every shipped law, float and double.

#include "contract/force_law.hpp"

#include <palpate/law/force/damped.hpp>
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/hertz.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/force/saturated.hpp>
#include <palpate/law/force/tabulated.hpp>
#include <palpate/law/map/duffing_map.hpp>
#include <palpate/law/map/hertz_map.hpp>

#include <array>

using namespace palpate;

namespace {

// Parameters of c [N/m^p] in other units: F' = F / force, D' = D / length.
template <class T>
T convert(T c, T length, T force, int p) {
  for (int i = 0; i < p; ++i) c *= length;
  return c / force;
}

template <int Sign>
struct DuffingExample {
  static constexpr double depth = 0.01;
  static constexpr bool exact_units = true;
  template <class S>
  static std::vector<S> kinks() {
    return {};
  }
  template <class S, class T>
  static DuffingForce<T> make(T length, T force) {
    const T c1 = S(40.7), c3 = Sign * S(3.1e5);
    return DuffingForce<T>({.c1 = convert(c1, length, force, 1), .c3 = convert(c3, length, force, 3)});
  }
};

struct PureCubicExample : DuffingExample<1> {
  template <class S, class T>
  static DuffingForce<T> make(T length, T force) {
    return DuffingForce<T>({.c1 = T(0), .c3 = convert(T(S(3.1e5)), length, force, 3)});
  }
};

struct LinearExample : DuffingExample<1> {
  template <class S, class T>
  static LinearForce<T> make(T length, T force) {
    return LinearForce<T>({.k = convert(T(S(512.3)), length, force, 1)});
  }
};

template <int TwiceP>
struct PowerLawExample : DuffingExample<1> {
  static constexpr bool exact_units = false;  // pow() promises nothing about powers of 2
  template <class S, class T>
  static PowerLawForce<T> make(T length, T force) {
    T k = S(9.7e4);
    for (int i = 0; i < TwiceP; ++i) k *= std::sqrt(length);
    return PowerLawForce<T>({.k = k / force, .p = T(TwiceP) / T(2)});
  }
};

// C in nanometres per newton: 0 a half-space, 2e5 with as much depth in the body as in the contact, 1e8 a
// spring; -2e4 a layer, -5e4 one that is stiffer than the series has numbers for.
template <int Compliance>
struct HertzExample : DuffingExample<1> {
  static constexpr bool exact_units = false;  // cbrt() promises nothing about powers of 2
  template <class S>
  static std::vector<S> kinks() {
    if (Compliance >= 0) return {};
    const S root = S(0.3L) / (S(9.7e-5L) * S(-Compliance));  // C k sqrt(D) = -0.3
    return {root * root};
  }
  template <class S, class T>
  static HertzForce<T> make(T length, T force) {
    const T k = S(9.7e4), C = S(1e-9) * S(Compliance);
    return HertzForce<T>({.k = k * length * std::sqrt(length) / force, .compliance = C * force / length});
  }
};

struct TabulatedExample {
  static constexpr double depth = 0.014;
  static constexpr bool exact_units = true;
  static constexpr double d[] = {0, 0.001, 0.0025, 0.003, 0.006, 0.0095, 0.012};
  static constexpr double f[] = {0, 0.11, 0.2, 0.5, 0.51, 2.75, 3.5};
  template <class S>
  static std::vector<S> kinks() {
    return {S(d[1]), S(d[2]), S(d[3]), S(d[4]), S(d[5]), S(d[6])};
  }
  template <class S, class T>
  static TabulatedForce<T, 16> make(T length, T force) {
    std::array<typename TabulatedForce<T, 16>::Sample, 7> samples;
    for (std::size_t i = 0; i < 7; ++i) samples[i] = {T(S(d[i])) / length, T(S(f[i])) / force};
    return TabulatedForce<T, 16>(samples);
  }
};

template <class Inner>
struct SaturatedExample {
  static constexpr double depth = 0.02;
  static constexpr bool exact_units = Inner::exact_units;
  template <class S>
  static std::vector<S> kinks() {
    const auto inner = Inner::template make<S>(S(1), S(1));
    return {inner.depth(S(0.75) * S(0.3125)), make<S>(S(1), S(1)).max_depth()};
  }
  template <class S, class T>
  static auto make(T length, T force) {
    return SaturatedForce(Inner::template make<S>(length, force),
                          {.limit = T(0.3125) / force, .knee = T(0.75)});
  }
};

template <class Inner, class Form>
struct DampedExample : Inner {
  template <class S, class T>
  static auto make(T length, T force) {
    using Law = decltype(Inner::template make<S>(length, force));
    return DampedForce<Law, Form>(Inner::template make<S>(length, force), {.damping = T(0.5)});
  }
};

template <class Example_, class Scalar_>
struct Case {
  using Example = Example_;
  using Scalar = Scalar_;
};

TEST_CASE_TEMPLATE_DEFINE("force law", C, force_law) {
  test::force_law_suite<typename C::Example, typename C::Scalar>().run();
}

#define PALPATE_FORCE_LAW_SUITE(...) \
  TEST_CASE_TEMPLATE_INVOKE(force_law, Case<__VA_ARGS__, float>, Case<__VA_ARGS__, double>)

PALPATE_FORCE_LAW_SUITE(DuffingExample<1>);
PALPATE_FORCE_LAW_SUITE(DuffingExample<0>);
PALPATE_FORCE_LAW_SUITE(DuffingExample<-1>);
PALPATE_FORCE_LAW_SUITE(PureCubicExample);
PALPATE_FORCE_LAW_SUITE(LinearExample);
PALPATE_FORCE_LAW_SUITE(PowerLawExample<2>);
PALPATE_FORCE_LAW_SUITE(PowerLawExample<3>);
PALPATE_FORCE_LAW_SUITE(PowerLawExample<4>);
PALPATE_FORCE_LAW_SUITE(HertzExample<0>);
PALPATE_FORCE_LAW_SUITE(HertzExample<200000>);
PALPATE_FORCE_LAW_SUITE(HertzExample<100000000>);
PALPATE_FORCE_LAW_SUITE(HertzExample<-20000>);
PALPATE_FORCE_LAW_SUITE(HertzExample<-50000>);
PALPATE_FORCE_LAW_SUITE(TabulatedExample);
PALPATE_FORCE_LAW_SUITE(SaturatedExample<DuffingExample<1>>);
PALPATE_FORCE_LAW_SUITE(SaturatedExample<PowerLawExample<3>>);
PALPATE_FORCE_LAW_SUITE(SaturatedExample<TabulatedExample>);
PALPATE_FORCE_LAW_SUITE(SaturatedExample<DuffingExample<-1>>);  // 0.18 N at most: never reaches the limit
PALPATE_FORCE_LAW_SUITE(DampedExample<DuffingExample<1>, HuntCrossley>);
PALPATE_FORCE_LAW_SUITE(DampedExample<SaturatedExample<DuffingExample<1>>, Viscous>);

template <class Map>
void map_at_the_ends_of_the_range(const typename Map::Coefficients& soft,
                                  const typename Map::Coefficients& hard) {
  using S = typename Map::Scalar;
  const Vec3<S> corner = Vec3<S>::Constant(S(0.02));
  const Map map({S(0.01), -corner, corner}, [&](const Vec3<S>& x) { return x.x() < S(0) ? soft : hard; });
  for (const S x : {S(-1), S(-0.008), S(0), S(0.003), S(0.01), std::numeric_limits<S>::infinity()}) {
    const auto law = map.at(Vec3<S>(x, S(0.001), S(0)));
    test::number_everywhere<S>(law);
    int bad = 0;
    for (int e = -40; e < std::numeric_limits<S>::max_exponent; ++e)
      bad += !is_finite(law.configurational_force(std::ldexp(S(1), e)));
    CHECK(bad == 0);
    CHECK(is_finite(law.configurational_force((std::numeric_limits<S>::max)())));
    CHECK(is_finite(law.configurational_force(std::numeric_limits<S>::infinity())));
  }
}

TEST_CASE_TEMPLATE("a law of a force map has numbers up to an infinite depth", S, float, double) {
  map_at_the_ends_of_the_range<DuffingMap<S>>({S(40), S(0)}, {S(400), S(3e5)});
  map_at_the_ends_of_the_range<DuffingMap<S>>({S(40), S(-3e5)}, {S(0), S(3e5)});
  map_at_the_ends_of_the_range<HertzMap<S>>({S(9.7e4), S(0)}, {S(9.7e5), S(2e-4)});
  map_at_the_ends_of_the_range<HertzMap<S>>({S(9.7e4), S(-2e-5)}, {S(9.7e5), S(2e-4)});
  map_at_the_ends_of_the_range<HertzMap<S>>({S(1e-30), S(1e9)}, {S(1e9), S(1e-30)});
}

TEST_CASE("a Hertz map whose blend of two laws would be none is refused") {
  using Map = HertzMap<float>;
  const Map::Params params{0.01f, Vec3<float>::Constant(-0.02f), Vec3<float>::Constant(0.02f)};
  const auto made = [&](float k, float C) {
    return Map(params, [&](const Vec3<float>& x) {
      return x.x() < 0 ? Map::Coefficients{k, 0} : Map::Coefficients{1, C};
    });
  };
  CHECK_NOTHROW((void)made(1e8f, 1e8f));
  CHECK_THROWS_AS((void)made(1e12f, 1e12f), SetupError);
}

}  // namespace
