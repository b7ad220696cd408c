// SPDX-License-Identifier: MIT
#pragma once

/// @file What looks for jumps: a contact that wanders over a body, and a closer look at a step in which much
/// changed.

#include <palpate/geometry/bvh.hpp>

#include <cstdlib>
#include <random>

namespace palpate::test {

/// Paths over each body: PALPATE_PATHS in the environment; without it `few` in every run of the tests, `many`
/// where PALPATE_STRESS is set (tests/run --stress).
[[nodiscard]] inline int wanted_paths(int few, int many) {
  if (const char* wanted = std::getenv("PALPATE_PATHS")) return std::atoi(wanted);
  return std::getenv("PALPATE_STRESS") != nullptr ? many : few;
}

/// A probe that is kept at a small distance outside; its nearest point of the surface and the direction from
/// there are continuous over convex edges.
class Walker {
 public:
  Walker(const TriangleBvh<double>& tree, const MeshData<double>& mesh, double distance, unsigned seed)
      : tree_(tree), random_(seed), distance_(distance) {
    const auto& t = mesh.triangles[random_() % mesh.triangles.size()];
    const Vec3<double>&a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    position = (a + b + c) / 3;
    normal = (b - a).cross(c - a).normalized();
    heading_ = perpendicular(normal);
  }
  Vec3<double> position, normal;
  void step(double length) {
    std::normal_distribution<double> turn(0, 0.1);
    heading_ =
        tangential(Vec3<double>(heading_ + Vec3<double>(turn(random_), turn(random_), turn(random_))), normal)
            .normalized();
    const Vec3<double> probe = position + distance_ * normal + length * heading_;
    const auto at = tree_.closest(probe);
    const Vec3<double> out = probe - at.position;
    if (out.dot(normal) > 0.3 * out.norm() && (at.position - position).norm() < 3 * length) {
      position = at.position;
      normal = out.normalized();
    } else {
      heading_ = -heading_;  // a hollow: the nearest point would jump
    }
  }

 private:
  const TriangleBvh<double>& tree_;
  std::mt19937 random_;
  double distance_;
  Vec3<double> heading_;
};

/// What is left of the change from l to r in the steepest 16,384th of the path: a jump keeps all of it.
template <class Contact, class Middle, class Apart>
[[nodiscard]] double left_over(Contact l, Contact r, const Middle& middle, const Apart& apart) {
  for (int i = 0; i < 14; ++i) {
    const Contact m = middle(l, r);
    (apart(l, m) > apart(m, r) ? r : l) = m;
  }
  return apart(l, r);
}

}  // namespace palpate::test
