// SPDX-License-Identifier: MIT
// The suite of force laws with memory on every shipped law, float and double.

#include "contract/stateful_force_law.hpp"

#include <palpate/law/force/duffing.hpp>
#include <palpate/law/force/linear.hpp>
#include <palpate/law/force/plastic.hpp>
#include <palpate/law/force/power_law.hpp>
#include <palpate/law/force/relaxing.hpp>

using namespace palpate;

namespace {

struct Linear {
  template <class T>
  static LinearForce<T> make() {
    return LinearForce<T>({.k = T(512)});
  }
};
struct Duffing {
  template <class T>
  static DuffingForce<T> make() {
    return DuffingForce<T>({.c1 = T(512), .c3 = T(3e6f)});
  }
};
struct Softening {
  template <class T>
  static DuffingForce<T> make() {
    return DuffingForce<T>({.c1 = T(512), .c3 = T(-1e6f)});
  }
};
struct Hertz {
  template <class T>
  static PowerLawForce<T> make() {
    return PowerLawForce<T>({.k = T(1e4f), .p = T(1.5)});
  }
};

template <class Inner, int Hardening>
struct Plastic {
  static constexpr double depth = 0.01, time = 1;
  static constexpr bool curved = false;
  template <class T>
  static auto make() {
    return PlasticForce(Inner::template make<T>(),
                        {.yield_force = T(1.5), .hardening = T(Hardening), .extent = T(0.01f)});
  }
};

template <class Inner, std::size_t N>
struct Relaxing {
  static constexpr double depth = 0.01, time = 0.1;
  static constexpr bool curved = !std::is_same_v<Inner, Linear>;
  template <class T>
  static auto make() {
    using Law = decltype(Inner::template make<T>());
    if constexpr (N == 1) {
      return RelaxingForce<Law, 1>(Inner::template make<T>(),
                                   {.terms = {{{T(0.75), T(0.1f)}}}, .extent = T(0.01f)});
    } else {
      return RelaxingForce<Law, 3>(
          Inner::template make<T>(),
          {.terms = {{{T(0.25), T(0.01f)}, {T(0.25), T(0.1f)}, {T(0.375), T(1)}}}, .extent = T(0.01f)});
    }
  }
};

template <class Example_, class Scalar_>
struct Case {
  using Example = Example_;
  using Scalar = Scalar_;
};

TEST_CASE_TEMPLATE_DEFINE("force law with memory", C, stateful_force_law) {
  test::check_stateful_force_law<typename C::Example, typename C::Scalar>();
}

#define PALPATE_STATEFUL_SUITE(...) \
  TEST_CASE_TEMPLATE_INVOKE(stateful_force_law, Case<__VA_ARGS__, float>, Case<__VA_ARGS__, double>)

PALPATE_STATEFUL_SUITE(Plastic<Linear, 0>);
PALPATE_STATEFUL_SUITE(Plastic<Linear, 128>);
PALPATE_STATEFUL_SUITE(Plastic<Duffing, 64>);
PALPATE_STATEFUL_SUITE(Plastic<Softening, 64>);
PALPATE_STATEFUL_SUITE(Plastic<Hertz, 256>);
PALPATE_STATEFUL_SUITE(Relaxing<Linear, 1>);
PALPATE_STATEFUL_SUITE(Relaxing<Linear, 3>);
PALPATE_STATEFUL_SUITE(Relaxing<Duffing, 1>);
PALPATE_STATEFUL_SUITE(Relaxing<Duffing, 3>);
PALPATE_STATEFUL_SUITE(Relaxing<Softening, 3>);
PALPATE_STATEFUL_SUITE(Relaxing<Hertz, 3>);

}  // namespace
