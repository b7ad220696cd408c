// SPDX-License-Identifier: MIT
#pragma once

/// @file The bodies of tests/support/response_bodies.hpp, each pressed by one patch, as triangles to be
/// drawn. No reference.

#include "support/response_bodies.hpp"

#include <palpate/geometry/bvh.hpp>
#include <palpate/response/response_contact.hpp>
#include <palpate/response/response_display.hpp>

#include <array>
#include <cstdio>
#include <iterator>
#include <map>
#include <vector>

namespace bench {

/// Each triangle cut in four, until there are `least`.
inline palpate::MeshData<double> refined(palpate::MeshData<double> mesh, std::size_t least) {
  while (mesh.triangles.size() < least) {
    palpate::MeshData<double> fine{.vertices = mesh.vertices, .triangles = {}};
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> number;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = number.try_emplace({(std::min)(a, b), (std::max)(a, b)},
                                                   static_cast<std::uint32_t>(fine.vertices.size()));
      if (is_new) fine.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return at->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
        fine.triangles.push_back(t);
    }
    mesh = std::move(fine);
  }
  return mesh;
}

/// Per triangle its corners, the last twice (a quadrilateral of two rows, for gnuplot): number of the body,
/// rest position and displacement [mm], the displacement's length over that of the tool's.
inline void draw_bodies(std::FILE* to) {
  using V = palpate::Vec3<double>;
  struct Press {
    V near, normal;
    double radius, depth;  // [mm]
  };
  const Press presses[] = {{{35, 20, 35}, {0, 1, 0}, 8, 4},  {{50, 90, 25}, {1, 0, 0}, 8, 4},
                           {{50, 5, 50}, {0, 1, 0}, 10, 1},  {{50, 90, 5}, {0, 0, 1}, 6, 2},
                           {{0, 30, 0}, {0, 1, 0}, 8, 4},    {{100, 100, 50}, {1, 1, 0}, 8, 4},
                           {{100, 90, 50}, {1, 0, 0}, 6, 3}, {{43.75, 112.5, 25}, {0, 1, 0}, 8, 4}};
  const std::vector<palpate::test::ResponseBody> bodies = palpate::test::response_bodies();
  for (std::size_t b = 0; b < (std::min)(bodies.size(), std::size(presses)); ++b) {
    const auto& body = bodies[b];
    const palpate::ResponseField field(body.mesh, [&](const V& p) { return p.y() <= body.fixed_below; },
                                       {.E = 1e5, .nu = body.nu, .mesh = {.vertices = 300}, .threads = 2});
    const V normal = presses[b].normal.normalized();
    const palpate::ResponseContact<double> contact{
        .position = palpate::TriangleBvh<double>(body.mesh).closest(1e-3 * presses[b].near).position,
        .normal = normal,
        .radius = 1e-3 * presses[b].radius,
        .displacement = -1e-3 * presses[b].depth * normal};
    const palpate::MeshData<double> mesh = refined(body.mesh, 3100);
    palpate::ResponseTick<1> tick(field);
    V force;
    (void)tick.solve(&contact, 1, &force);
    std::vector<V> u(mesh.vertices.size());
    tick.displace(palpate::ResponseDisplay(field, mesh.vertices), u.front().data(), 3);
    const double size = contact.displacement.norm();
    for (const auto& t : mesh.triangles) {
      for (const std::size_t c : {0u, 1u, 2u, 2u}) {
        const V &x = mesh.vertices[t[c]], &v = u[t[c]];
        std::fprintf(to, "%zu %.2f %.2f %.2f %.3f %.3f %.3f %.3f\n%s", b, 1e3 * x.x(), 1e3 * x.y(),
                     1e3 * x.z(), 1e3 * v.x(), 1e3 * v.y(), 1e3 * v.z(), v.norm() / size, c == 1 ? "\n" : "");
      }
      std::fputs("\n\n", to);
    }
  }
}

}  // namespace bench
