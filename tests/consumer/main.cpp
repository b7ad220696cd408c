// SPDX-License-Identifier: MIT
// A project that uses palpate, in its smallest form.
#include <palpate/palpate.hpp>

int main() {
  using namespace palpate;
  ContactSolver<Sphere<double>, LinearForce<double>> touch(
      {.object = Sphere<double>({.radius = 0.05}), .tool = {}, .force = LinearForce<double>({.k = 500})});
  Pose<double> pose;
  pose.translation = {0, 0.049, 0};
  return touch.tick(pose).wrench.force.y() > 0 && PALPATE_VERSION_MAJOR >= 0 ? 0 : 1;
}
