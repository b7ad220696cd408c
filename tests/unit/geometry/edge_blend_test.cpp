// SPDX-License-Identifier: MIT

#include "support/check.hpp"

#include <palpate/geometry/detail/edge_blend.hpp>

#include <random>

using namespace palpate;

namespace {

constexpr std::uint64_t seed = 20250713;

// phi straight from sum psi(phi / d_j) = 1, by bisection.
template <Real S, std::size_t N>
long double reference(const std::array<S, N>& d) {
  long double low = 0, high = static_cast<long double>(d[0]);
  for (const S x : d) high = std::fmin(high, static_cast<long double>(x));
  for (int k = 0; k < 80; ++k) {
    const long double phi = (low + high) / 2;
    long double sum = 0;
    for (const S x : d) {
      const long double t = 2 * phi / x - 1;
      if (t > 0) sum += t * t;
    }
    (sum < 1 ? low : high) = phi;
  }
  return high;
}

}  // namespace

TEST_CASE_TEMPLATE("edge blend: solves its equation, weights are its derivatives", S, float, double) {
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.1, 1);
  for (int i = 0; i < 3000; ++i) {
    std::array<S, 6> d{};
    for (S& x : d) x = static_cast<S>(uniform(random));
    if (i % 4 == 0) d[3] = d[1];  // equal depths
    const EdgeBlend<S, 6> blend = edge_blend(d);
    CHECK_RELATIVE(blend.depth, reference(d), test::ulps<S>(16));  // condition number at most 2
    S sum = 0;
    for (std::size_t j = 0; j < 6; ++j) {
      CHECK(blend.weight[j] >= S(0));
      sum += blend.weight[j] * d[j];
      if constexpr (std::is_same_v<S, double>) {
        std::array<S, 6> up = d, down = d;
        const double step = 1e-6;
        up[j] += step, down[j] -= step;
        // Second derivatives are of the order of 10 / depth, and kinked: 1e-6 * 10 / 0.1.
        CHECK_ABSOLUTE((edge_blend(up).depth - edge_blend(down).depth) / (2 * step), blend.weight[j], 1e-4);
      }
    }
    CHECK_RELATIVE(sum, blend.depth, test::ulps<S>(32));  // Euler: homogeneous of degree one
  }
}

TEST_CASE_TEMPLATE("edge blend: nearest depth exactly while the others are twice as far", S, float, double) {
  const EdgeBlend<S, 3> far = edge_blend<S, 3>({S(2), S(1), S(5)});
  CHECK(far.depth == S(1));
  CHECK((far.weight == std::array<S, 3>{0, 1, 0}));
  const EdgeBlend<S, 3> near = edge_blend<S, 3>({S(1.99), S(1), S(5)});
  CHECK(near.depth < S(1));
  CHECK(near.depth > S(0.9999));
  // All equal: t = 1/2 + 1 / (2 sqrt N).
  CHECK_RELATIVE((edge_blend<S, 6>({S(3), S(3), S(3), S(3), S(3), S(3)}).depth),
                 3 * (0.5L + 0.5L / std::sqrt(6.0L)), test::ulps<S>(8));
  CHECK_RELATIVE((edge_blend<S, 2>({S(3), S(3)}).depth), 3 * (0.5L + 0.5L / std::sqrt(2.0L)),
                 test::ulps<S>(8));
}
