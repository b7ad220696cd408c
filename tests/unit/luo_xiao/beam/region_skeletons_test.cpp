// SPDX-License-Identifier: MIT
#include "unit/luo_xiao/beam/reference.hpp"

#include <palpate/luo_xiao/beam/region_skeletons.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/no_heap.hpp>

#include <algorithm>
#include <limits>

using namespace palpate;
using palpate::test::L;
using palpate::test::VecL;

namespace {

constexpr std::uint64_t seed = 20050610;
constexpr double E = 0.9e6, volume = 2.16e-4;  // of a cube of 60 mm

template <Real S, class G = CoupledRegions>
using Several = RegionSkeletons<Skeleton<S>, G, 4>;
template <Real S>
using Contacts = std::vector<SkeletonContact<S>>;

template <Real S, class G = CoupledRegions>
Several<S, G> make(const std::vector<Vec3<S>>& points) {
  return Several<S, G>(Skeleton<S>(points, EulerBernoulli<double>(IsotropicElasticity<double>({.E = E})),
                                   VolumePreserving<double>({.volume = volume})));
}

template <class K>
typename K::Result share(const K& several, const Contacts<typename K::Scalar>& contacts) {
  typename K::Result result;
  several.share(contacts, result);
  return result;
}

template <Real S>
std::vector<Vec3<S>> random_points(std::mt19937_64& random, std::size_t n) {
  std::vector<Vec3<S>> points;
  for (std::size_t i = 0; i < n; ++i) points.push_back(test::random_vector<S>(random, 0.03));
  return points;
}

template <Real S>
Contacts<S> random_contacts(std::mt19937_64& random, std::size_t m) {
  std::uniform_real_distribution<double> force(0.2, 2);
  Contacts<S> contacts;
  for (std::size_t j = 0; j < m; ++j) {
    contacts.push_back({.position = test::random_vector<S>(random, 0.03),
                        .force = test::random_vector<S>(random, 1),
                        .normal_force = S(force(random))});
  }
  return contacts;
}

template <Real S>
test::ReferenceRegions reference(const std::vector<Vec3<S>>& points, const Contacts<S>& contacts,
                                 bool coupled) {
  test::ReferenceRegions r{{}, {}, {}, {}, E, volume, coupled};
  for (const auto& p : points) r.points.push_back(p.template cast<L>());
  for (const auto& a : contacts) {
    r.positions.push_back(a.position.template cast<L>());
    r.forces.push_back(a.force.template cast<L>());
    r.share.emplace_back();
    for (const auto& b : contacts) {
      const L x = a.normal_force, y = b.normal_force;
      r.share.back().push_back(coupled ? std::min(x, y) / std::max(x, y) : 1.0L);
    }
  }
  return r;
}

template <Real S, class G>
void check_against_reference(std::size_t m) {
  std::mt19937_64 random(seed + m);
  L worst = 0;
  for (int round = 0; round < 60; ++round) {
    const auto points = random_points<S>(random, 3 + static_cast<std::size_t>(round % 10));
    const auto contacts = random_contacts<S>(random, m);
    const auto result = share(make<S, G>(points), contacts);
    REQUIRE(result.shared);
    const auto r = reference(points, contacts, G::coupled);
    const auto d = r.displacements();
    L size = 0;
    for (const VecL& f : r.forces) size += f.norm();
    for (std::size_t j = 0; j < m; ++j) {
      VecL passed = VecL::Zero();
      for (std::size_t k = 0; k < m; ++k) {
        if (k != j) passed += r.between(k, j) * d[k];
      }
      worst = std::max(worst, (result.from_others[j].template cast<L>() - passed).norm() / size);
      for (std::size_t i = 0; i < points.size(); ++i) {
        worst = std::max(
            worst, (result.loads[j].beams[i].force.template cast<L>() - r.own(j, i) * d[j]).norm() / size);
      }
    }
  }
  INFO("m = ", m, ", worst error over the sum of |F| ", static_cast<double>(worst));
  CHECK(worst <= test::ulps<S>(4) + 1e-11L);  // scalar's rounding; cond(K) up to some thousand in double
}

}  // namespace

TEST_CASE_TEMPLATE("one to four regions: forces and transmitted forces are the reference's", S, float,
                   double) {
  for (std::size_t m = 1; m <= 4; ++m) {
    check_against_reference<S, CoupledRegions>(m);
    check_against_reference<S, SuperposedRegions>(m);
  }
}

TEST_CASE("coupled: all load reaches the extremal points; one region is the skeleton of one contact") {
  std::mt19937_64 random(seed + 10);
  const auto points = random_points<double>(random, 8);
  const auto several = make<double>(points);
  const auto contacts = random_contacts<double>(random, 4);
  const auto result = share(several, contacts);
  Vec3<double> carried = Vec3<double>::Zero(), applied = carried;
  for (std::size_t j = 0; j < 4; ++j) {
    applied += contacts[j].force;
    for (const auto& beam : result.loads[j].beams) carried += beam.force;
  }
  CHECK((carried - applied).norm() <= 1e-13);  // rounding of 32 shares of about 1 N

  const auto alone = share(several, {contacts[0]});
  Skeleton<double>::Load load;
  several.skeleton().share(contacts[0], load);
  CHECK(alone.from_others[0] == Vec3<double>(Vec3<double>::Zero()));
  for (std::size_t i = 0; i < 8; ++i)
    CHECK((alone.loads[0].beams[i].force - load.beams[i].force).norm() <= 1e-14);
}

TEST_CASE("coupled is reciprocal: d_j under a force at k is d_k under that force at j; superposed is not") {
  std::mt19937_64 random(seed + 11);
  double worst = 0;
  std::vector<double> errors;  // superposed: relative difference of the responses 0 to 1 and 1 to 0
  for (int round = 0; round < 200; ++round) {
    const auto points = random_points<double>(random, 8);
    auto contacts = random_contacts<double>(random, 2);
    const auto several = make<double>(points);
    const auto literal = make<double, SuperposedRegions>(points);
    // Displacement of contact j under a unit force at contact k; superposed: under the force that k transmits
    // to it.
    const auto response = [&](std::size_t j, std::size_t k, int c, bool coupled) -> Vec3<double> {
      contacts[j].force.setZero();
      contacts[k].force = Vec3<double>::Unit(c);
      if (coupled) return share(several, contacts).loads[j].displacement;
      contacts[j].force = share(literal, contacts).from_others[j];
      return share(literal, contacts).loads[j].displacement;
    };
    for (const bool coupled : {true, false}) {
      Mat3<double> a, b;
      for (int c = 0; c < 3; ++c)
        a.col(c) = response(0, 1, c, coupled), b.col(c) = response(1, 0, c, coupled);
      const double error = (a - b.transpose()).norm() / a.norm();
      if (coupled)
        worst = std::max(worst, error);
      else
        errors.push_back(error);
    }
  }
  std::sort(errors.begin(), errors.end());
  MESSAGE("reciprocity error: coupled at most ", worst, "; superposed median ", errors[100], ", max ",
          errors[199]);
  CHECK(worst <= 1e-11);  // rounding times cond(K)
  CHECK(errors[100] > 0.01);
}

TEST_CASE("coupled: energy put in is what the contacts' displacements say, and is positive") {
  std::mt19937_64 random(seed + 12);
  for (int round = 0; round < 50; ++round) {
    const auto points = random_points<double>(random, 6);
    const auto contacts = random_contacts<double>(random, 3);
    const auto result = share(make<double>(points), contacts);
    const auto r = reference(points, contacts, true);
    L work = 0, stored = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const VecL d = result.loads[j].displacement.cast<L>();
      work += r.forces[j].dot(d) / 2;
      for (std::size_t i = 0; i < 6; ++i) stored += d.dot(r.own(j, i) * d) / 2;
      for (std::size_t k = 0; k < j; ++k) {
        const VecL u = d - result.loads[k].displacement.cast<L>();
        stored += u.dot(r.between(j, k) * u) / 2;
      }
    }
    CHECK(work > 0);
    CHECK_RELATIVE(stored, work, 1e-9);  // sums that cancel by up to cond(K)
  }
}

TEST_CASE("a region that appears with zero force changes nothing, to the bit; then grows without a jump") {
  std::mt19937_64 random(seed + 13);
  for (int round = 0; round < 20; ++round) {
    const auto several = make<double>(random_points<double>(random, 8));
    auto contacts = random_contacts<double>(random, 2);
    const Vec3<double> full = contacts[1].force;
    const double full_normal = contacts[1].normal_force;
    const auto alone = share(several, {contacts[0]});
    contacts[1].force.setZero();
    contacts[1].normal_force = 0;
    auto before = share(several, contacts);
    CHECK(before.from_others[0] == Vec3<double>(Vec3<double>::Zero()));
    CHECK(before.from_others[1] == Vec3<double>(Vec3<double>::Zero()));
    for (std::size_t i = 0; i < 8; ++i) {
      CHECK(before.loads[0].beams[i].force == alone.loads[0].beams[i].force);
      CHECK(before.loads[1].beams[i].force == Vec3<double>(Vec3<double>::Zero()));
    }
    double max_step = 0;
    for (int step = 1; step <= 1000; ++step) {
      contacts[1].force = full * (step / 1000.0);
      contacts[1].normal_force = full_normal * (step / 1000.0);
      const auto now = share(several, contacts);
      for (std::size_t j = 0; j < 2; ++j) {
        max_step = std::max(max_step, (now.from_others[j] - before.from_others[j]).norm());
        for (std::size_t i = 0; i < 8; ++i) {
          max_step =
              std::max(max_step, (now.loads[j].beams[i].force - before.loads[j].beams[i].force).norm());
        }
      }
      before = now;
    }
    // 1/1000 of the force and of a_jk (whose slope is N_1/N_0 <= 10) per step, times forces of a few newtons.
    CHECK(max_step <= 0.05);
  }
}

TEST_CASE("superposed, as printed: a region of zero force receives a finite force at once") {
  // Two pins on a cube of side 60 mm, 20 mm apart on the top, 1 N on the first alone.
  std::vector<Vec3<double>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(Vec3<double>(i & 1 ? 0.03 : -0.03, i & 2 ? 0.06 : 0, i & 4 ? 0.03 : -0.03));
  const Vec3<double> down(0, -1, 0), none = Vec3<double>::Zero();
  Contacts<double> pins{{.position = Vec3<double>(-0.01, 0.06, 0), .force = down, .normal_force = 1},
                        {.position = Vec3<double>(0.01, 0.06, 0), .force = none, .normal_force = 0}};
  const double literal = share(make<double, SuperposedRegions>(points), pins).from_others[1].norm();
  const double coupled = share(make<double>(points), pins).from_others[1].norm();
  pins[1].force = down;
  pins[1].normal_force = 1;
  const auto both = share(make<double>(points), pins);
  const auto both_literal = share(make<double, SuperposedRegions>(points), pins);
  MESSAGE("second pin appears: superposed gives it ", literal, " N, coupled ", coupled,
          " N; both at 1 N: superposed ", both_literal.from_others[1].y(), ", coupled ",
          both.from_others[1].y(), " N");
  CHECK(coupled == 0);
  CHECK(literal > 0.05);
  CHECK(both.from_others[0].y() < 0);  // the neighbour's dent takes load off the pin
  CHECK_RELATIVE(both.from_others[0].y(), both.from_others[1].y(), 1e-12);  // mirror images
}

TEST_CASE("turning and reordering the regions; a region on another, and on an extremal point") {
  std::mt19937_64 random(seed + 14);
  const auto points = random_points<double>(random, 7);
  auto contacts = random_contacts<double>(random, 3);
  const auto result = share(make<double>(points), contacts);
  const Mat3<double> R = test::random_rotation(random);
  auto turned = points;
  auto moved = contacts;
  for (auto& p : turned) p = Vec3<double>(R * p);
  for (auto& c : moved) c.position = Vec3<double>(R * c.position), c.force = Vec3<double>(R * c.force);
  std::swap(moved[0], moved[2]);
  const auto other = share(make<double>(turned), moved);
  const std::size_t to[] = {2, 1, 0};
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK((other.from_others[to[j]] - R * result.from_others[j]).norm() <= 1e-12);  // rounding times cond(K)
    for (std::size_t i = 0; i < 7; ++i) {
      CHECK((other.loads[to[j]].beams[i].force - R * result.loads[j].beams[i].force).norm() <= 1e-12);
    }
  }
  for (const double away : {1e-3, 1e-6, 1e-12, 0.0}) {
    contacts[1].position = contacts[0].position + Vec3<double>(away, 0, 0);
    contacts[2].position = points[3] + Vec3<double>(0, away, 0);
    const auto close = share(make<double>(points), contacts);
    REQUIRE(close.shared);
    Vec3<double> sum = Vec3<double>::Zero();
    for (const auto& load : close.loads) {
      for (const auto& beam : load.beams) sum += beam.force;
    }
    // Beams between contacts are at least 1/1000 of the lengths long, so their stiffness loses at most 9
    // digits.
    CHECK((sum - contacts[0].force - contacts[1].force - contacts[2].force).norm() <= 1e-6);
  }
}

TEST_CASE_TEMPLATE("bad input: no force anywhere; surplus regions are left out; no heap in a tick", S, float,
                   double) {
  std::mt19937_64 random(seed + 15);
  const auto several = make<S>(random_points<S>(random, 6));
  const auto good = random_contacts<S>(random, 3);
  for (const S bad : {std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity(),
                      (std::numeric_limits<S>::max)()}) {
    for (int what = 0; what < 3; ++what) {
      auto contacts = good;
      if (what == 0) contacts[1].position.x() = bad;
      if (what == 1) contacts[1].force.y() = bad;
      if (what == 2) contacts[1].normal_force = bad;
      const auto result = share(several, contacts);
      REQUIRE(result.loads.size() == 3);
      for (std::size_t j = 0; j < 3; ++j) {
        CHECK(is_finite(result.from_others[j]));
        for (const auto& beam : result.loads[j].beams) {
          CHECK(is_finite(beam.force));
          if (!result.shared) CHECK(beam.force == Vec3<S>(Vec3<S>::Zero()));
        }
      }
    }
  }
  const auto six = random_contacts<S>(random, 6);
  CHECK(share(several, six).loads.size() == 4);
  CHECK(share(several, {}).loads.size() == 0);
  typename Several<S>::Result result;
  const test::HeapCount heap;
  several.share(six, result);
  CHECK(heap.allocations() == 0);
}
