// SPDX-License-Identifier: MIT
#include <palpate/law/force/duffing.hpp>
#include <palpate/law/friction/anchor.hpp>
#include <palpate/law/friction/coulomb.hpp>

#include <doctest/doctest.h>

#include <support/check.hpp>

#include <random>

using namespace palpate;
using V = Vec3<double>;

namespace {

const DuffingForce<double> law({.c1 = 400, .c3 = 3e8});
const CoulombFriction<double> dry({.mu_static = 0.6, .mu_dynamic = 0.4});

// A point pressed by a constant normal force on the plane y = 0.
struct Slider {
  Pose<double> X;
  double normal_force = 1.0;
  double depth = law.depth(1.0);
  Anchor<double> anchor = Anchor<double>::begin(X, V(0, -depth, 0), V::UnitY(), depth);

  AnchoredForce<double> move_to(const V& at) {
    X.translation = at;
    return advance(anchor, dry, law, X, V::UnitY(), V(X * anchor.point_T), depth, normal_force);
  }
};

}  // namespace

TEST_CASE("stiction: 10,000 small loops leave no drift and no force") {
  Slider slider;
  const double inside = 0.5 * law.depth(0.6);
  AnchoredForce<double> held{};
  for (int i = 0; i <= 10000 * 16; ++i) {
    const double phi = 2 * 3.14159265358979323846 * (i % 16) / 16;
    held = slider.move_to(inside * V(std::cos(phi) - 1, 0, std::sin(phi)));
  }
  CHECK_FALSE(slider.anchor.slip.sliding);
  CHECK(slider.anchor.origin == V(0, 0, 0));
  CHECK(held.stretch.norm() == 0);  // the loop ends exactly where it began
  CHECK(held.friction.norm() == 0);
}

TEST_CASE("sliding: friction is opposite to the motion and equals mu_D F_n") {
  Slider slider;
  AnchoredForce<double> held{};
  for (int i = 1; i <= 4000; ++i) held = slider.move_to(V(1e-5 * i, 0, 0));
  CHECK(slider.anchor.slip.sliding);
  CHECK_RELATIVE(held.friction.x(), -0.4, 1e-6);  // static excess has worn off over 40 mm
  CHECK(held.friction.y() == 0);
  CHECK(held.friction.z() == 0);
}

TEST_CASE("work: over random closed paths friction never gives energy to the user") {
  constexpr std::uint64_t seed = 20050611;
  std::mt19937_64 random(seed);
  INFO("seed ", seed);
  std::uniform_real_distribution<double> amplitude(-2e-3, 2e-3), phase(0, 6.28);
  double least = 1;
  for (int path = 0; path < 200; ++path) {
    Slider slider;
    double a[4], p[4];
    for (int k = 0; k < 4; ++k) a[k] = amplitude(random), p[k] = phase(random);
    const auto position = [&](double t) {
      return V(
          a[0] * std::sin(6.28318530717958648 * t + p[0]) + a[1] * std::sin(12.5663706143591730 * t + p[1]),
          0,
          a[2] * std::sin(6.28318530717958648 * t + p[2]) + a[3] * std::sin(18.8495559215387594 * t + p[3]));
    };
    constexpr int steps = 4000;
    V last = position(0);
    slider.X.translation = last;
    slider.anchor =
        Anchor<double>::begin(slider.X, V(last - V(0, slider.depth, 0)), V::UnitY(), slider.depth);
    V force = V::Zero();
    double work_on_user = 0, scale = 0;
    for (int i = 1; i <= steps; ++i) {
      const V now = position(double(i) / steps);
      const AnchoredForce<double> held = slider.move_to(now);
      work_on_user += 0.5 * (force + held.friction).dot(now - last);  // trapezoid
      scale += 0.5 * (force + held.friction).norm() * (now - last).norm();
      force = held.friction;
      last = now;
    }
    // The trapezoid rule errs by the square of the step; 1e-4 of the work done covers it with a margin of 10.
    least = (std::min)(least, (-work_on_user + 1e-4 * scale) / scale);
  }
  CHECK(least >= 0);
}

TEST_CASE(
    "a slip turns the anchor's normal towards the contact's and its point towards the pressure centre") {
  Slider slider;
  slider.move_to(V(0.01, 0, 0));
  const V normal = V(0.1, 1, 0).normalized();
  const V centre = slider.X * slider.anchor.point_T + V(0, 0, 5e-3);
  for (int i = 1; i <= 5000; ++i) {
    slider.X.translation.x() += 1e-5;
    (void)advance(slider.anchor, dry, law, slider.X, normal, V(centre + V(1e-5 * i, 0, 0)), slider.depth,
                  slider.normal_force);
  }
  CHECK((slider.anchor.normal - normal).norm() <=
        1e-9);  // 50 mm of slip, relaxed over a stretch of about 1 mm
  CHECK((slider.X * slider.anchor.point_T - centre - V(0.05, 0, 0)).norm() <= 1e-9);
}
