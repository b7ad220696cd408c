// SPDX-License-Identifier: MIT
// [minimal]
#include <palpate/palpate.hpp>

#include <cstdio>
using namespace palpate;

int main() {
  using Touch = ContactSolver<Ellipsoid<double>, DuffingForce<double>, CoulombFriction<double>>;
  Touch touch({.object = Ellipsoid<double>({.axes = {0.06, 0.04, 0.04}}),  // m
               .tool = {.tip = {0, 0, 0}, .centre_of_mass = {0, 0.1, 0}},  // m, tool frame
               .force = DuffingForce<double>({.c1 = 40, .c3 = 3e8}),       // N/m, N/m^3
               .friction = CoulombFriction<double>({.mu_static = 0.5, .mu_dynamic = 0.3})});
  Pose<double> pose;                     // from your device, every servo tick
  pose.translation = {0.001, 0.038, 0};  // 2 mm below the top
  const auto felt = touch.tick(pose);    // noexcept, no heap, well below a microsecond
  std::printf("F = %.3f %.3f %.3f N\n", felt.wrench.force.x(), felt.wrench.force.y(), felt.wrench.force.z());
}
// [minimal]
