// SPDX-License-Identifier: MIT
// What changes linearly over a contact: its gradient by regression, and loads with a given moment.
#include <palpate/resolved/detail/load_fit.hpp>
#include <palpate/resolved/detail/loads_beside.hpp>
#include <palpate/resolved/detail/regular_gradient.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <array>
#include <cmath>
#include <vector>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<float>;
using Simd = detail::VectorList::V;
constexpr std::size_t most = 64;
constexpr float cell = 1e-6f;  // [m^2]

struct Loaded {
  detail::PointSystem system{most, 0.02f, true};
  AlignedList<float> q;

  /// A square lattice, `side` points a side, that presses along -y, more towards +x; `unit`: of the loads.
  explicit Loaded(std::size_t side, float unit = 1e-9f) {
    q.resize(AlignedList<float>::padded(most));
    system.begin_tick();
    system.clear();
    system.touch(1e-3f, 1e-9f, V::Zero(), -1e-9f * V::UnitY());
    for (std::size_t i = 0; i < side * side; ++i) {
      const V x = std::sqrt(cell) * V(float(i % side), 0, float(i / side));
      system.add(x - 1e-3f * V::UnitY(), -V::UnitY(), 1e-3f, cell);
      q[i] = unit * (1 + float(i % side));
    }
    system.build();
  }
};

/// Of a function with the gradient (3, 0, -2).
V slope_of(const Loaded& contact) {
  const detail::LoadFit fit(contact.system, contact.q.data());
  return fit.slope([&](std::size_t i) {
    const detail::SimdVec3<Simd> x = contact.system.feet().load(i);
    return Simd(0.1f) + Simd(3.f) * x.x - Simd(2.f) * x.z;
  });
}

}  // namespace

TEST_CASE("the slope over a contact's loads is the function's, less what few points' own cells take") {
  // Of 2 x 2 points: x has the variance 2/9 of a cell for loads 1 to 2, z 1/4, and a cell's own is 1/12 of
  // it, for 4 sum q^2/(sum q)^2 >= 1. Rounding of float: 1e-7 of 0.1 over slopes of 1e-3 m, 1e-5; ten such.
  const V four = slope_of(Loaded(2)), many = slope_of(Loaded(8));
  CHECK_RELATIVE(four.x(), 3 * (2. / 9) / (2. / 9 + 1. / 12), 1e-4);
  CHECK_RELATIVE(four.z(), -2 * (1. / 4) / (1. / 4 + 1. / 12), 1e-4);
  // Of 8 x 8: 35/9 and 21/4 of it, and 4 sum q^2/(sum q)^2 = 4 * 204/(8 * 36^2), squared.
  const double own = std::pow(4 * 204. / (8 * 36 * 36), 2) / 12;
  CHECK_RELATIVE(many.x(), 3 * (35. / 9) / (35. / 9 + own), 1e-4);
  CHECK_RELATIVE(many.z(), -2 * 5.25 / (5.25 + own), 1e-4);
  for (const V& v : {four, many}) CHECK(std::abs(v.y()) <= 1e-4);
  // Loads whose squares are no floats: as others.
  CHECK((slope_of(Loaded(8, 1e-25f)) - many).norm() <= 1e-4 * many.norm());
}

TEST_CASE("the stretch of a contact's surface is measured where w turns and bends it, too, and is bounded") {
  const Loaded contact(8);
  const auto stretch = [&](float size) {
    detail::VectorList w;
    w.resize(contact.system.stride());
    for (std::size_t i = 0; i < contact.system.size(); ++i) {
      const V& x = contact.system.foot(i);
      w.set(i, size * V(0.02f * x.x() + 0.05f * x.z(), 0.1f * x.x() + 9 * x.z() * x.z(),
                        0.01f * x.z() - 0.05f * x.x()));
    }
    detail::RegularGradient<true> gradient(contact.system.size());
    const ToolPoints<double> tool(std::vector<Vec3<double>>{{0, 0, 0}}, {1e-4}, {.contact_area = 1e-4});
    gradient.measure(contact.system, contact.q.data(), w, V(0, 0, 0), detail::NoLoadsBeside(0, 0, 0),
                     std::array<int, 0>{}, tool);
    return gradient.stretch();
  };
  const double own = std::pow(4 * 204. / (8 * 36 * 36), 2) / 12;  // as above, variances and tolerance, too
  CHECK_RELATIVE(stretch(1), 0.02 * (35. / 9) / (35. / 9 + own) + 0.01 * 5.25 / (5.25 + own), 1e-4);
  CHECK(stretch(100) == 0.2f);
  CHECK(stretch(-100) == -0.2f);
}

TEST_CASE("loads that change linearly over a contact have the moment asked for and no sum") {
  const Loaded contact(8);
  const detail::LoadFit fit(contact.system, contact.q.data());
  const V moment(2e-12f, 0, -1e-12f), D = fit.tilt(moment + 5e-12f * V::UnitY());  // along m: no moment
  V found = V::Zero();
  float sum = 0, sizes = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const V r = contact.system.foot(i) - fit.mean();
    const float load = contact.q[i] * D.dot(r);
    found += load * r, sum += load, sizes += std::abs(load);
  }
  // A cell's own spread takes 4 * 204/(8 * 36^2)/12 = 0.0066 of it, beside 35/9 and more.
  CHECK((found - moment).norm() <= 0.0066 / (35. / 9) * moment.norm());
  CHECK(std::abs(sum) <= 1e-5 * sizes);  // rounding
}

TEST_CASE("a surface is flat to a milliradian") {
  // Two normals at an angle a: their mean is shorter than 1 by a^2/8.
  for (const float angle : {0.f, 1e-3f, 5e-3f, 0.1f}) {
    detail::PointSystem system(most, 0.02f, false);
    system.begin_tick();
    system.touch(1e-3f, 1e-9f, V::Zero(), -1e-9f * V::UnitY());
    system.touch(1e-3f, 1e-9f, V::Zero(), 1e-9f * V(std::sin(angle), -std::cos(angle), 0));
    CHECK(system.is_flat() == (angle < 2e-3f));
  }
}

TEST_CASE("points that press from two sides have no direction of pressing in the mean") {
  detail::PointSystem system(most, 0.02f, true);
  AlignedList<float> q;
  q.resize(AlignedList<float>::padded(most));
  system.begin_tick();
  system.clear();
  for (const float side : {-1.f, 1.f}) {
    const V x(0, 0.1f * side, 0), n = -side * V::UnitY();
    system.touch(1e-3f, 1e-9f, 1e-9f * x, 1e-9f * n);
    system.add(x, n, 1e-3f, cell);
  }
  system.build();
  q[0] = q[1] = 1e-9f;
  CHECK(detail::LoadFit(system, q.data()).one_sided() == 0);  // both directions alike, so they cancel out
  const Loaded from_one(8);
  CHECK_RELATIVE(detail::LoadFit(from_one.system, from_one.q.data()).one_sided(), 1, 1e-6);  // float
}

TEST_CASE("without load there is nothing to fit") {
  Loaded contact(2);
  for (std::size_t i = 0; i < 4; ++i) contact.q[i] = 0;
  CHECK_FALSE(detail::LoadFit(contact.system, contact.q.data()).has_load());
}
