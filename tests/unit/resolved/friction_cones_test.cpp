// SPDX-License-Identifier: MIT
// The cones of friction at a contact's points: their axes by the slopes of tool, body and regular part, how
// wide they are; and what else the tool's slopes do.
#include <palpate/geometry/ellipsoid.hpp>
#include <palpate/law/friction/coulomb.hpp>
#include <palpate/resolved/contact_samples.hpp>
#include <palpate/resolved/detail/friction_cones.hpp>
#include <palpate/resolved/detail/loads_beside.hpp>
#include <palpate/resolved/detail/reaction.hpp>
#include <palpate/solver/contact_solver.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>
#include <support/on_half_space.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

using namespace palpate;
using namespace palpate::test;

namespace {

using V = Vec3<float>;
constexpr std::size_t most = 64;

/// Points that press along m, with cells of 1 mm^2.
struct Points {
  detail::PointSystem system;
  detail::FrictionLists lists;
  AlignedList<float> loads;
  float passes = 0;  ///< how far tractions point the same way

  explicit Points(double nu, const V& m = -V::UnitY()) : system(most, static_cast<float>(1 - 2 * nu), true) {
    lists.resize(most), loads.resize(most);
    system.begin_tick();
    system.clear();
    system.touch(1e-3f, 1e-9f, V::Zero(), 1e-9f * m);
  }
  void add(const V& x, const V& normal, float q) {
    loads[system.size()] = q;
    system.add(x, normal, 0, 1e-6f);
  }
  void place(auto& cones, const V& g = V::Zero(), const Vec3<double>& origin = Vec3<double>::Zero()) {
    cones.place(system, loads.data(), origin, g, passes, lists);
  }
};

}  // namespace

TEST_CASE("the limit of tractions grows with the slope up to a rim's, and halves at most where it passes") {
  constexpr double nu = 0.3;
  Points points(nu);
  points.add(V::Zero(), -V::UnitY(), 0);
  points.system.build();
  detail::FrictionCones cones(nu, most);
  detail::LinearCones linear(nu, most);
  points.place(linear);
  CHECK(points.lists.per_mu[0] == 1);
  const auto limit = [&](float cosine, float q) {
    cones.outward.set(0, V(std::sqrt(1 - cosine * cosine), -cosine, 0));
    points.loads[0] = q;
    points.place(cones);
    return points.lists.per_mu[0];
  };
  CHECK(limit(1, 0) == 1);
  CHECK_RELATIVE(limit(0.9f, 0), std::sqrt((1 + 1 / 0.81) / 2) / 0.9,
                 1e-6);  // rounding of float, here and below
  CHECK(limit(0.7f, 0) == limit(0.8f, 0));
  CHECK(limit(-1, 0) == limit(0.8f, 0));
  // Pressure counts by how far the surface passes.
  CHECK(limit(0.9f, 1e-7f) == limit(0.9f, 0));
  points.passes = 0.6f;
  CHECK_RELATIVE(limit(0.9f, 1e-7f) / limit(0.9f, 0), 1 - 0.6 * (1 - 2 * nu) * 2 * std::numbers::pi / 3 * 0.1,
                 1e-6);
  CHECK(limit(1, 1) == 0.5f);
  // Lift counts by that, too; a coefficient above 1 lifts the surface as 1 does.
  const float still = limit(0.9f, 0);
  points.lists.mu = 0.5f;
  CHECK_RELATIVE(limit(0.9f, 0) / still, 1 + 0.6 * 0.25 / 2 * (1 / 0.81 - 1), 1e-6);
  points.lists.mu = 1;
  const float most_lifted = limit(0.9f, 0);
  points.lists.mu = 3;
  CHECK(limit(0.9f, 0) == most_lifted);
  points.passes = 0;
  CHECK(limit(0.9f, 0) == still);
}

TEST_CASE("how far tractions point the same way is a share of 1, however small the first touch's loads are") {
  // Loads of 1e-22 m^2 have squares that are 0, and what they pass on would be infinite from then on.
  for (const float size : {1e-38f, 1e-30f, 1e-24f, 1e-22f, 1e-20f, 1e-9f}) {
    CAPTURE(size);
    Points points(0.3);
    for (std::size_t i = 0; i < 20; ++i) {
      points.add(V(1e-3f * float(i), 0, 0), -V::UnitY(), size);
      points.lists.load.set(i, size * V(0.1f, -1, 0));
    }
    points.system.build();
    points.lists.mu = 0.3f;
    detail::Reaction<true> reaction;
    reaction.resize(most);
    for (int tick = 1; tick <= 100; ++tick) {
      reaction.measure(points.system, points.system.directions(), points.loads, points.lists,
                       detail::NoLoadsBeside(0, 0, 0), V::Zero());
      CHECK(reaction.passes() >= 0);
      CHECK(reaction.passes() <= 1);
    }
    if (size > 1e-10f) CHECK_RELATIVE(reaction.passes(), 1, 1e-5);  // (7/8)^100 = 2e-6, rounding of float
  }
}

TEST_CASE(
    "cones lean with the tool's normal, up to a rim's slope; no load aside is left of all, none at nu 1/2") {
  for (const double nu : {0.1, 0.4, 0.5}) {
    CAPTURE(nu);
    Points points(nu);
    detail::FrictionCones cones(nu, most);
    const V normals[] = {{0, -1, 0}, {0.28f, -0.96f, 0}, {0, -0.6f, -0.8f}, {0, 0, 1}, {0, 0, 0}};
    const float loads[] = {4, 2, 1, 1, 0};
    for (std::size_t i = 0; i < 5; ++i) {
      points.add(1e-3f * V(float(i), 0, 0), -V::UnitY(), loads[i]);
      cones.outward.set(i, normals[i]);
    }
    points.system.build();
    points.place(cones);
    const float lean = nu < 0.25 ? 1.f : static_cast<float>(2 * (1 - 2 * nu));
    const V slopes[] = {{0, 0, 0}, {0.28f / 0.96f, 0, 0}, {0, 0, -0.75f}, {0, 0, 0.75f}, {0, 0, 0}};
    const V mean(2 * (0.28f / 0.96f) / 8, 0, 0);
    for (std::size_t i = 0; i < 5; ++i)  // rounding of float
      CHECK((cones.axes(points.system)[i] - (lean * (slopes[i] - mean) - V::UnitY())).norm() <= 1e-6f);
    CHECK(&detail::LinearCones(nu, most).axes(points.system) == &points.system.directions());
  }
}

TEST_CASE("cones turn with the surface, and their axes stay as long along the direction of pressing") {
  const V n(0.6f, -0.8f, 0), g(0.05f, 0.01f, -0.02f);
  Points points(0.49, n);
  points.add(V::Zero(), n, 1);
  points.system.build();
  detail::FrictionCones cones(0.3, most);
  cones.outward.set(0, n);
  points.place(cones, g);
  const V m = points.system.direction(0), c = cones.axes(points.system)[0];
  CHECK((c - (m - (g - m.dot(g) * m))).norm() <= 1e-6f);  // rounding of float
  CHECK_RELATIVE(c.dot(m), 1, 1e-6);
}

TEST_CASE("cones turn with a curved body's normals over ticks, wherever positions are counted from") {
  // Of a parabola, whose slope is linear: its regression is the slope itself, but for the cells' own spread,
  // 0.02 % for 7 x 7 points that carry alike (load_fit.hpp).
  constexpr float R = 0.05f, exactly = 1e-3f;
  const auto normal = [](float x) { return V(-x / R, -1, 0).normalized(); };
  Points points(0.5);
  for (const float x : {-2e-3f, 2e-3f}) points.system.touch(1e-3f, 1e-9f, V::Zero(), 1e-9f * normal(x));
  for (int i = -3; i <= 3; ++i)
    for (int k = -3; k <= 3; ++k)
      points.add(1e-3f * V(float(i), 0, float(k)), normal(1e-3f * float(i)), 1e-9f);
  points.system.build();
  detail::LinearCones cones(0.5, most);
  points.place(cones);
  constexpr float slope = 3e-3f / R;                                     // at the first point
  CHECK_RELATIVE(cones.axes(points.system)[0].x(), slope / 2, exactly);  // the mean of none and this tick's
  for (int tick = 0; tick < 40; ++tick) points.place(cones);
  CHECK_RELATIVE(cones.axes(points.system)[0].x(), slope, exactly);
  // The same point as seen from another origin.
  const auto turned = cones.slope.over(Vec3<double>(0.01, 0, 0), V::Zero());
  CHECK_RELATIVE(turned(detail::each(V(-0.013f, 0, -0.003f))).x[0], slope, exactly);
  cones.slope.forget();
  CHECK(cones.slope.is_zero());
}

TEST_CASE(
    "a contact is stiffer to a turn by its tool's slope within the rim, drawn in, and pressed densely") {
  constexpr float R = 0.02f, cell = 1e-6f, q = 1e-9f, pi = std::numbers::pi_v<float>;
  // u by loads that turn, over r, less what the formula has, over that. Friction has drawn the surface
  // together by `strain`, and moved it all.
  const auto off = [&](double nu, float strain, auto slope, float tool) {
    Points points(nu);
    detail::VectorList slopes, anchors, P, u;
    for (auto* list : {&slopes, &anchors, &P, &u}) list->resize(most);
    float moment = 0;
    for (int i = -4; i <= 4; ++i)
      for (int k = -4; k <= 4; ++k) {
        const V x = 1e-3f * V(float(i), 0, float(k));
        if (i * i + k * k > 18) continue;
        const std::size_t n = points.system.size();
        slopes.set(n, slope(x)), anchors.set(n, V(1e-4f, 0, 0) - strain * x), P.set(n, x.cross(V::UnitY()));
        moment += x.squaredNorm();
        points.add(x, -V::UnitY(), q);
      }
    points.system.build();
    detail::TwistStiffening twist;
    twist.measure(points.system, points.loads.data(), {points.system, points.loads.data()}, slopes, anchors);
    twist.add(points.system, P, u);
    for (std::size_t i = points.system.size(); i < most; ++i) CHECK(u[i] == V::Zero());  // fills up registers
    // Even loads on n cells: a^2 = 9/8 of their area over pi.
    const float a = std::sqrt(9 * cell * float(points.system.size()) / (8 * pi)),
                dense = 4 * pi / 3 * static_cast<float>(1 - 2 * nu) * q / cell,
                whole = (1 + 3 / (4 * pi) * a * tool) * (1 + 3 * strain) * (1 + dense),
                expected = 3 * pi / (4 * a * a * a) * (1 - 1 / whole) * moment;
    return expected == 0 ? u[0].norm() : -u[0].dot(P[0]) / P[0].squaredNorm() / expected - 1;
  };
  const auto ball = [&](const V& x) { return V(x / R); };
  for (const auto& [nu, strain] : {std::pair(0.5, 0.f), {0.5, 0.04f}, {0.3, 0.f}, {0.3, 0.04f}})
    CHECK(std::abs(off(nu, strain, ball, 1 / R)) <= 1e-5f);  // rounding of float
  // Slopes of a rim alone do not count, nor do those of a hollow.
  CHECK(off(
            0.5, 0, [&](const V& x) { return V(x.norm() > 4e-3f ? ball(x) : V::Zero()); }, 0) == 0);
  CHECK(off(
            0.5, 0, [&](const V& x) { return V(-ball(x)); }, 0) == 0);
}

TEST_CASE("on a curved body, too, friction of 0.001 is felt as none, and the tool feels the loads") {
  // A box's face askew on an ellipsoid's flank is pushed aside by a quarter of its force. Measured: force
  // 0.30 % off, 1.4 % without the body's slope in the cones; torque 6e-6 m times the force.
  const auto face = Box<double>({.half = Vec3<double>(0.006, 0.003, 0.004)}).mesh(600);
  const Ellipsoid<double> body({.axes = Vec3<double>(0.06, 0.04, 0.04)});
  auto with =
      on_half_space(face, 0.0008, CoulombFriction<double>({.mu_static = 1e-3, .mu_dynamic = 1e-3}), body);
  auto without = on_half_space(face, 0.0008, Frictionless<double>{}, body);
  Wrench<double> felt, expected;
  for (int i = 0; i <= 300; ++i) {
    Pose<double> X;
    X.translation = Vec3<double>(0.02 + 1e-5 * i, 0.0395 - 1e-5 * (std::min)(i, 150), 0.003);
    X.rotation = Eigen::AngleAxisd(-0.2, Vec3<double>::UnitZ()).toRotationMatrix();
    felt = with.tick(X, 1e-3).wrench, expected = without.tick(X, 1e-3).wrench;
  }
  const double F = expected.force.norm();
  REQUIRE(F > 1);
  CHECK((felt.force - expected.force).norm() <= 0.005 * F);
  CHECK((felt.torque - expected.torque).norm() <= 1e-5 * F);
  FixedVector<SurfaceLoad<double>, 512> loads;
  with.state().loads(loads);
  Vec3<double> sum = felt.force;
  for (const auto& load : loads) sum += load.force;
  CHECK(sum.norm() <= 1e-6 * F);  // sums of floats
}
