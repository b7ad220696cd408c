// SPDX-License-Identifier: MIT
// [readme]
#include <palpate/adapters/assimp.hpp>
#include <palpate/touch.hpp>

#include <cstdio>
#include <vector>

int main() {
  const auto mesh = palpate::read_mesh("liver.obj", {.scale = 0.03});  // metres per unit of the file
  const palpate::ElasticBody body(mesh, {.E = 20e3, .nu = 0.49, .fixed = palpate::below(0.05)});  // Pa, -, m
  palpate::Touch touch(body, palpate::ball(5e-3),                                                 // m
                       palpate::CoulombFriction<double>({.mu_static = 0.4, .mu_dynamic = 0.3}));
  std::vector<float> positions(3 * mesh.vertices.size()), normals(positions.size());
  const palpate::VertexBuffer<float> buffer{.positions = positions.data(), .normals = normals.data()};

  palpate::Pose<double> pose;  // of the ball's centre: from your device, at 1 kHz
  const double dt = 1e-3;
  pose.translation = {-0.01, 0.104, 0};
  const auto felt = touch.tick(pose, dt);  // servo thread: noexcept, no heap, some 20 us
  const auto moved = touch.draw(buffer);   // render thread: deformed vertices and normals
  std::printf("F = %.3f %.3f %.3f N; %zu vertices moved\n", felt.wrench.force.x(), felt.wrench.force.y(),
              felt.wrench.force.z(), moved.vertices);
}
// [readme]
