// SPDX-License-Identifier: MIT
// The beam theory suite on every shipped theory, float and double.

#include "contract/beam_theory.hpp"

#include <palpate/luo_xiao/beam/euler_bernoulli.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>

using namespace palpate;

namespace {

struct EulerBernoulliExample {
  template <class T>
  static EulerBernoulli<T> make(T pressure) {
    return EulerBernoulli<T>(IsotropicElasticity<T>({.E = T(2097152) / pressure, .nu = T(0.375)}));
  }
  static long double tip(long double E, long double, long double, long double I, long double l) {
    return l * l * l / (3 * E * I);
  }
};

struct TimoshenkoExample {
  template <class T>
  static Timoshenko<T> make(T pressure) {
    return Timoshenko<T>(IsotropicElasticity<T>({.E = T(2097152) / pressure, .nu = T(0.375)}));
  }
  static long double tip(long double E, long double nu, long double S, long double I, long double l) {
    const long double kappa = 6 * (1 + nu) * (1 + nu) / (7 + 14 * nu + 8 * nu * nu);
    return l * l * l / (3 * E * I) + l * 2 * (1 + nu) / (kappa * E * S);
  }
};

}  // namespace

TEST_CASE_TEMPLATE("beam theory suite: Euler-Bernoulli", S, float, double) {
  test::BeamTheorySuite<EulerBernoulliExample, S>{}.run();
}
TEST_CASE_TEMPLATE("beam theory suite: Timoshenko", S, float, double) {
  test::BeamTheorySuite<TimoshenkoExample, S>{}.run();
}
