// SPDX-License-Identifier: MIT
#include "unit/luo_xiao/beam/reference.hpp"

#include <palpate/luo_xiao/beam/skeleton.hpp>
#include <palpate/luo_xiao/beam/timoshenko.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

using namespace palpate;
using palpate::test::L;
using palpate::test::MatL;
using palpate::test::VecL;

namespace {

constexpr std::uint64_t seed = 20050608;
constexpr double E = 1.3e6, volume = 5e-5;

EulerBernoulli<double> theory() { return EulerBernoulli<double>(IsotropicElasticity<double>({.E = E})); }

template <Real S>
Skeleton<S> make(const std::vector<Vec3<S>>& points, double v = volume) {
  return Skeleton<S>(points, theory(), VolumePreserving<double>({.volume = v}));
}

template <class K>
typename K::Load share(const K& skeleton, const Vec3<typename K::Scalar>& position,
                       const Vec3<typename K::Scalar>& F) {
  typename K::Load load;
  skeleton.share({.position = position, .force = F}, load);
  return load;
}

template <Real S>
std::vector<Vec3<S>> random_points(std::mt19937_64& random, std::size_t n) {
  std::vector<Vec3<S>> points;
  for (std::size_t i = 0; i < n; ++i) points.push_back(test::random_vector<S>(random, 0.03));
  return points;
}

// Largest error of the forces against the long double reference, over |F|.
template <Real S>
L error_of(const typename Skeleton<S>::Load& load, const std::vector<Vec3<S>>& points,
           const Vec3<S>& position, const Vec3<S>& F, double v = volume) {
  test::ReferenceRegions exact{{}, {position.template cast<L>()}, {F.template cast<L>()}, {{0}}, E, v};
  for (const Vec3<S>& p : points) exact.points.push_back(p.template cast<L>());
  const VecL d = exact.displacements()[0];
  L worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    worst = std::max(worst, (load.beams[i].force.template cast<L>() - exact.own(0, i) * d).norm());
  }
  return worst / F.template cast<L>().norm();
}

}  // namespace

TEST_CASE_TEMPLATE("random skeletons of 1 to 64 beams: forces are the reference's and sum to F", S, float,
                   double) {
  std::mt19937_64 random(seed);
  L worst = 0, worst_sum = 0;
  for (int round = 0; round < 300; ++round) {
    const auto n = static_cast<std::size_t>(1 + (round % 64));
    const auto points = random_points<S>(random, n);
    const Vec3<S> position = test::random_vector<S>(random, 0.03), F = test::random_vector<S>(random, 1);
    const auto load = share(make<S>(points), position, F);
    REQUIRE(load.shared);
    worst = std::max(worst, error_of<S>(load, points, position, F));
    VecL sum = VecL::Zero();
    L size = 0;
    for (const auto& beam : load.beams) {
      sum += beam.force.template cast<L>();
      size += beam.force.template cast<L>().norm();
    }
    worst_sum = std::max(worst_sum, (sum - F.template cast<L>()).norm() / size);
  }
  MESSAGE("worst error of F_i over |F| ", static_cast<double>(worst), ", of the sum ",
          static_cast<double>(worst_sum));
  // Rounding to the scene's scalar, and cond(K) <= 426 in double for spread skeletons.
  CHECK(worst <= test::ulps<S>(2) + 1e-12L);
  CHECK(worst_sum <= test::ulps<S>(2));
}

TEST_CASE("ratios (6), (7) hold: each force's parts are d's over l and l^3, in space") {
  std::mt19937_64 random(seed + 1);
  const auto points = random_points<double>(random, 9);
  const Vec3<double> position(0.01, 0.02, -0.01);
  const auto load = share(make(points), position, Vec3<double>(0.3, -1, 0.2));
  const Vec3<double> d = load.displacement;
  L first_x = 0, first_y = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const VecL e = points[i].cast<L>(), x = (position.cast<L>() - e).normalized(),
               f = load.beams[i].force.cast<L>();
    const L l = (position.cast<L>() - e).norm();
    const VecL dx = x * x.dot(d.cast<L>()), dy = d.cast<L>() - dx;
    const L ratio_x = f.dot(x) / (x.dot(d.cast<L>()) / l),
            ratio_y = (f - x * x.dot(f)).norm() / (dy.norm() / (l * l * l));
    if (i == 0) first_x = ratio_x, first_y = ratio_y;
    CHECK_RELATIVE(ratio_x, first_x, 1e-11);  // rounding times the parts' cancellation
    CHECK_RELATIVE(ratio_y, first_y, 1e-11);
    CHECK((f - x * x.dot(f)).cross(dy).norm() <=
          1e-11L * f.norm() * dy.norm());  // and the part across is along d's
  }
}

TEST_CASE("turning, reordering, scaling, doubling: what the skeleton must not depend on") {
  std::mt19937_64 random(seed + 2);
  for (int round = 0; round < 40; ++round) {
    const auto points = random_points<double>(random, 8);
    const Vec3<double> position = test::random_vector<double>(random, 0.03),
                       F = test::random_vector<double>(random, 1), G = test::random_vector<double>(random, 1);
    const auto load = share(make(points), position, F);
    const double size = F.norm();
    const double tolerance = 1e-12 * size;  // two solves of cond(K) up to some hundred

    const Mat3<double> R = test::random_rotation(random);
    std::vector<Vec3<double>> turned, reordered, scaled;
    std::vector<std::size_t> order(8);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t i = 0; i < 8; ++i) {
      turned.push_back(R * points[i]);
      reordered.push_back(points[order[i]]);
      scaled.push_back(points[i] * 8);
    }
    const auto rotated = share(make(turned), R * position, R * F);
    const auto shuffled = share(make(reordered), position, F);
    const auto larger = share(make(scaled, volume * 512), Vec3<double>(position * 8), F);
    const auto other = share(make(points), position, G);
    const auto both = share(make(points), position, Vec3<double>(2 * F - 3 * G));
    double energy = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      const Vec3<double> f = load.beams[i].force;
      CHECK((rotated.beams[i].force - R * f).norm() <= tolerance);
      CHECK((shuffled.beams[i].force - load.beams[order[i]].force).norm() <= tolerance);
      CHECK((larger.beams[i].force - f).norm() <= tolerance);
      CHECK((both.beams[i].force - (2 * f - 3 * other.beams[i].force)).norm() <=
            5 * tolerance * (1 + G.norm() / size));
      // Energy stored in this beam: force along and across over its stiffnesses.
      const auto section = make(points).section(load);
      const double l = load.beams[i].length, fx = load.beams[i].axis.dot(f);
      const double ft2 = f.squaredNorm() - fx * fx;
      energy +=
          (fx * fx / theory().axial_stiffness(section, l) + ft2 / theory().transverse_stiffness(section, l)) /
          2;
    }
    CHECK_RELATIVE(energy, F.dot(load.displacement) / 2, 1e-10);  // squares of parts that cancel
    CHECK(F.dot(load.displacement) > 0);
    CHECK_RELATIVE(larger.displacement.norm() * 8, load.displacement.norm(),
                   1e-11);  // stiffness grows with length
    CHECK_RELATIVE(G.dot(load.displacement), F.dot(other.displacement),
                   1e-9L * size * G.norm());  // reciprocity of one end
  }
}

TEST_CASE_TEMPLATE("collinear beams to l/r = 3000: right to 1e-6", S, float, double) {
  std::mt19937_64 random(seed + 3);
  for (const double slenderness : {10.0, 100.0, 1000.0, 3000.0}) {
    L worst = 0;
    for (int round = 0; round < 50; ++round) {
      const Vec3<S> axis = test::random_vector<S>(random, 1).normalized(),
                    F = test::random_vector<S>(random, 1);
      const std::vector<Vec3<S>> points{Vec3<S>(axis * S(-0.1)), Vec3<S>(axis * S(0.1)),
                                        Vec3<S>(axis * S(0.17))};
      const double r = 0.1 / slenderness, v = std::numbers::pi * r * r * 0.37;
      worst = std::max(worst, error_of<S>(share(make<S>(points, v), Vec3<S>(Vec3<S>::Zero()), F), points,
                                          Vec3<S>(Vec3<S>::Zero()), F, v));
    }
    MESSAGE("l/r ", slenderness, ": worst error of F_i over |F| ", static_cast<double>(worst));
    CHECK(worst <= 1e-6L);
  }
}

TEST_CASE("condition: eigenvalues of K stay within (4/3)(l/r)^2") {
  std::mt19937_64 random(seed + 4);
  for (int round = 0; round < 50; ++round) {
    const auto points = random_points<double>(random, 3 + static_cast<std::size_t>(round % 6));
    const Vec3<double> position = test::random_vector<double>(random, 0.03);
    const auto skeleton = make(points, 1e-7);  // slender: every ka > kt
    const auto load = share(skeleton, position, Vec3<double>(1, 0, 0));
    double bound = 0;
    const double r = skeleton.section(load).radius();
    for (const auto& beam : load.beams)
      bound = std::max(bound, 4.0 / 3 * (beam.length / r) * (beam.length / r));
    // The compliance's maximum and minimum over many directions bound its condition from below.
    double max_d = 0, min_d = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 100; ++k) {
      const Vec3<double> F = test::random_vector<double>(random, 1).normalized();
      const double d = share(skeleton, position, F).displacement.norm();
      max_d = std::max(max_d, d), min_d = std::min(min_d, d);
    }
    CHECK(max_d / min_d <= bound * (1 + 1e-9));
  }
}

TEST_CASE_TEMPLATE("on an extremal point one beam takes the whole load; near it the others' shares fall to 0",
                   S, float, double) {
  std::mt19937_64 random(seed + 5);
  const auto points = random_points<S>(random, 6);
  const auto skeleton = make<S>(points);
  const Vec3<S> F(S(0.3), S(-1), S(0.4));
  const auto on = share(skeleton, points[2], F);
  REQUIRE(on.shared);
  CHECK((on.beams[2].force - F).norm() <=
        F.norm() * S(test::ulps<S>(2) + 1e-14L));  // five others of 1e-15 each
  for (std::size_t i = 0; i < 6; ++i) {
    if (i != 2) CHECK(on.beams[i].force.norm() <= S(1e-12) * F.norm());
  }
  double last = 1;
  for (double away = 1e-2; away > 1e-25; away /= 10) {
    const Vec3<S> position = points[2] + Vec3<S>(S(away), S(-away), S(away) / 2);
    const auto near = share(skeleton, position, F);
    REQUIRE(near.shared);
    const double rest = static_cast<double>((near.beams[2].force - F).norm());
    CHECK(rest <=
          100 * away + double(test::ulps<S>(8)));  // falls like l or faster: the others' ka over its own
    CHECK(rest <= 1.01 * last + double(test::ulps<S>(8)));
    last = rest;
  }
}

TEST_CASE("one beam, coincident extremal points, everything at one point: shares without dividing by zero") {
  const Vec3<double> o = Vec3<double>::Zero(), x(0.1, 0, 0), F(1, -2, 0.5);
  const auto one = share(make<double>({x}), o, F);
  CHECK(one.shared);
  CHECK(one.beams[0].force == F);
  const auto section = make<double>({x}).section(one);
  const Vec3<double> d(1 / theory().axial_stiffness(section, 0.1),
                       -2 / theory().transverse_stiffness(section, 0.1),
                       0.5 / theory().transverse_stiffness(section, 0.1));
  CHECK((one.displacement - d).norm() <= 1e-15 * d.norm());  // the closed inverse

  const auto twins = share(make<double>({x, x}), o, F);
  for (const auto& beam : twins.beams) CHECK((beam.force - F / 2).norm() <= 1e-15 * F.norm());
  for (const double at : {0.1, 0.1 + 1e-14, 0.1 + 1e-8}) {
    const auto on_twins = share(make<double>({x, x, Vec3<double>(0, 0.1, 0)}), Vec3<double>(at, 0, 0), F);
    CHECK(on_twins.shared);
    CHECK((on_twins.beams[0].force - F / 2).norm() <= 1e-6);
    CHECK((on_twins.beams[1].force - F / 2).norm() <= 1e-6);
  }
  const auto all = share(make<double>({x, x}), x, F);
  CHECK(all.shared);
  CHECK((all.beams[0].force - F / 2).norm() <= 1e-14 * F.norm());  // rounding of the solve
}

TEST_CASE_TEMPLATE("bad input: nothing is carried, nothing is NaN; zero force gives exact zeros", S, float,
                   double) {
  std::mt19937_64 random(seed + 6);
  const auto points = random_points<S>(random, 5);
  const auto skeleton = make<S>(points);
  const S nan = std::numeric_limits<S>::quiet_NaN(), inf = std::numeric_limits<S>::infinity(),
          huge = (std::numeric_limits<S>::max)();
  const Vec3<S> good(S(0.01), S(0.02), S(0)), F(0, S(-1), 0);
  for (const S bad : {nan, inf, -inf}) {
    for (const auto& load :
         {share(skeleton, Vec3<S>(bad, S(0), S(0)), F), share(skeleton, good, Vec3<S>(S(0), bad, S(1)))}) {
      CHECK_FALSE(load.shared);
      REQUIRE(load.beams.size() == 5);
      CHECK(load.displacement == Vec3<S>(Vec3<S>::Zero()));
      for (const auto& beam : load.beams) {
        CHECK(beam.force == Vec3<S>(Vec3<S>::Zero()));
        CHECK(is_finite(beam.axis));
      }
    }
  }
  for (const auto& load :
       {share(skeleton, Vec3<S>(huge, huge, huge), F), share(skeleton, good, Vec3<S>(huge, huge, -huge))}) {
    CHECK(is_finite(load.displacement));
    for (const auto& beam : load.beams) CHECK(is_finite(beam.force));
  }
  const auto rest = share(skeleton, good, Vec3<S>(Vec3<S>::Zero()));
  CHECK(rest.shared);
  CHECK(rest.displacement == Vec3<S>(Vec3<S>::Zero()));
  for (const auto& beam : rest.beams) CHECK(beam.force == Vec3<S>(Vec3<S>::Zero()));
}

TEST_CASE("set-up reports; volume is preserved; a tick uses no heap and repeats to the bit") {
  const auto at = [](double x) { return Vec3<double>(x, 0, 0); };
  CHECK_THROWS_AS(make<double>({}), SetupError);
  CHECK_THROWS_AS(make<double>({at(0), at(std::nan(""))}), SetupError);
  CHECK_THROWS_AS(make<double>(std::vector<Vec3<double>>(65, at(1))), SetupError);
  CHECK_THROWS_AS(VolumePreserving<double>({.volume = 0}), SetupError);
  CHECK_THROWS_AS(VolumePreserving<double>({.volume = 5e-324}), SetupError);  // its radius would be 0

  std::mt19937_64 random(seed + 7);
  const auto skeleton = make(random_points<double>(random, 12));
  Skeleton<double>::Load load, again;
  const SkeletonContact<double> contact{.position = Vec3<double>(0.01, 0.02, 0),
                                        .force = Vec3<double>(0.1, -1, 0)};
  const test::HeapCount heap;
  skeleton.share(contact, load);
  skeleton.share(contact, again);
  CHECK(heap.allocations() == 0);
  double beam_volume = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    beam_volume += skeleton.section(load).area() * load.beams[i].length;
    CHECK(load.beams[i].force == again.beams[i].force);
  }
  CHECK_RELATIVE(beam_volume, volume, 1e-14);
}

TEST_CASE(
    "Timoshenko in the skeleton: forces are the reference's, and differ from Euler-Bernoulli's in a solid") {
  // A cube of side 60 mm, pressed off centre on the top: beams of l/r about 4 to 6.
  std::vector<Vec3<double>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(Vec3<double>(i & 1 ? 0.03 : -0.03, i & 2 ? 0.06 : 0, i & 4 ? 0.03 : -0.03));
  const double v = 0.06 * 0.06 * 0.06, nu = 0.5;
  const Vec3<double> position(0.01, 0.06, 0.004), F(0.2, -1, 0);
  const Timoshenko<double> shear(IsotropicElasticity<double>({.E = E, .nu = nu}));
  const Skeleton<double, Timoshenko<double>> with(points, shear, VolumePreserving<double>({.volume = v}));
  const auto a = share(with, position, F);
  const auto b = share(make(points, v), position, F);
  test::ReferenceRegions r{{}, {position.cast<L>()}, {F.cast<L>()}, {{0}}, E, v};
  for (const auto& p : points) r.points.push_back(p.cast<L>());
  const L kappa_G = 27.0L / 32 * E / 3;
  MatL k = MatL::Zero();
  for (const VecL& e : r.points) k += test::beam_stiffness(e, position.cast<L>(), E, r.area(0), kappa_G);
  std::vector<std::vector<L>> rows(3, std::vector<L>(3));
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) rows[i][j] = k(static_cast<int>(i), static_cast<int>(j));
  }
  const auto x = test::gauss(rows, {F.x(), F.y(), F.z()});
  const VecL d(x[0], x[1], x[2]);
  double change = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    const VecL exact = test::beam_stiffness(r.points[i], position.cast<L>(), E, r.area(0), kappa_G) * d;
    CHECK((a.beams[i].force.cast<L>() - exact).norm() <= 1e-13L);
    change = std::max(change, (a.beams[i].force - b.beams[i].force).norm());
  }
  MESSAGE("cube: l/r ", a.beams[2].length / with.section(a).radius(), " to ",
          a.beams[0].length / with.section(a).radius(), ", shear changes F_i by at most ", change,
          " of F and d by ", a.displacement.norm() / b.displacement.norm() - 1);
  CHECK(change > 0.001);

  // The ellipsoid 60 x 40 x 40 mm, 10 mm beside its pole: the beam to the pole is hardly longer than thick.
  const std::vector<Vec3<double>> ends{{-0.03, 0.02, 0}, {0.03, 0.02, 0},  {0, 0, 0},
                                       {0, 0.04, 0},     {0, 0.02, -0.02}, {0, 0.02, 0.02}};
  const double body = 4 * std::numbers::pi / 3 * 0.03 * 0.02 * 0.02;
  const Vec3<double> beside(0.01, 0.02 + 0.02 * std::sqrt(1 - 1.0 / 9 - 1.0 / 16), 0.005), down(0, -1, 0);
  const Skeleton<double, Timoshenko<double>> sheared(ends, shear, VolumePreserving<double>({.volume = body}));
  const auto c = share(sheared, beside, down);
  const auto e = share(make(ends, body), beside, down);
  MESSAGE("ellipsoid: beam to the pole l/r ", c.beams[3].length / sheared.section(c).radius(), " carries ",
          -e.beams[3].force.y(), " of F without shear, ", -c.beams[3].force.y(), " with it; d changes by ",
          c.displacement.norm() / e.displacement.norm() - 1);
  CHECK(c.beams[3].force.norm() < e.beams[3].force.norm());
}
