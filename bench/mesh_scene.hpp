// SPDX-License-Identifier: MIT
#pragma once

/// @file A ball of 1,000 points and 20 mm radius that glides 2 mm deep over a dented body of about 20 cm: the
/// scene of bench/mesh and bench/adapters.

#include <palpate/palpate.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace bench {

using namespace palpate;
using S = double;
using V = Vec3<S>;
using Clock = std::chrono::steady_clock;

/// [us]
inline double since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

inline double quantile(std::vector<double>& times, double part) {
  const auto at = times.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), at, times.end());
  return *at;
}

inline MeshData<S> body_mesh(std::size_t triangles) {
  MeshData<S> mesh = Sphere<S>({.radius = 1}).mesh(triangles / 2);
  for (V& v : mesh.vertices) {
    const V n = v.normalized();
    v *= 0.1 * (1 + 0.33 * std::sin(4 * n.x()) * std::cos(3 * n.y() + 1) + 0.1 * n.z());
  }
  return mesh;
}

inline constexpr S ball = 0.02, pressed = 2e-3;

inline ToolPoints<S> ball_tool() {
  return {TriangleMesh<S>(Sphere<S>({.radius = ball}).mesh(1016)), {.contact_area = 1e-4}};
}
template <class Object>
using BallSolver = ContactSolver<Object, DuffingForce<S>, Frictionless<S>, SingleRegion<AreaSharing>>;
template <class Object>
BallSolver<Object> ball_solver(const Object& object) {
  return BallSolver<Object>({object, ball_tool(), DuffingForce<S>({.c1 = 40, .c3 = 3e8}), {}, {}, {}});
}

/// 20 pieces of path around the body; each glides by 50 um a tick.
inline std::vector<Pose<S>> glide_path(const MeshSurface<S>& body, int ticks) {
  std::vector<Pose<S>> poses;
  for (int i = 0; i < ticks; ++i) {
    const S t = 0.314 * (i / (ticks / 20)) + 5e-4 * (i % (ticks / 20));
    const V out = V(std::cos(t), 0.4 * std::sin(3 * t), std::sin(t)).normalized();
    Pose<S> X;
    X.translation = body.raycast(out, -out).position + (ball - pressed) * out;
    poses.push_back(X);
  }
  return poses;
}

}  // namespace bench
