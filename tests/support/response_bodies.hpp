// SPDX-License-Identifier: MIT
#pragma once

/// @file Bodies that no closed form knows, for the response field: concave, thin, in two pieces, with edges.
/// About 100 mm.

#include <palpate/response/response_field.hpp>

#include "support/joined.hpp"
#include "support/response_meshes.hpp"

#include <map>
#include <string>
#include <vector>

namespace palpate::test {

/// Surface of the cells of a grid that are filled; edge [m] of a cell.
template <class Filled>
[[nodiscard]] MeshData<double> cells_mesh(std::array<int, 3> n, double edge, const Filled& filled) {
  MeshData<double> mesh;
  std::map<std::array<int, 3>, std::uint32_t> number;
  const auto vertex = [&](std::array<int, 3> c) {
    const auto [at, is_new] = number.try_emplace(c, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(edge * Vec3<double>(c[0], c[1], c[2]));
    return at->second;
  };
  const auto full = [&](std::array<int, 3> c) {
    for (std::size_t i = 0; i < 3; ++i)
      if (c[i] < 0 || c[i] >= n[i]) return false;
    return bool(filled(c[0], c[1], c[2]));
  };
  for (int i = 0; i < n[0]; ++i)
    for (int j = 0; j < n[1]; ++j)
      for (int k = 0; k < n[2]; ++k) {
        const std::array<int, 3> c{i, j, k};
        if (!full(c)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            auto beside = c;
            beside[axis] += side == 1 ? 1 : -1;
            if (full(beside)) continue;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::uint32_t q[4];
            const int du[4] = {0, 1, 1, 0}, dv[4] = {0, 0, 1, 1};
            for (int m = 0; m < 4; ++m) {
              auto p = c;
              p[axis] += side;
              p[u] += du[m];
              p[v] += dv[m];
              q[m] = vertex(p);
            }
            mesh.triangles.push_back(side == 1 ? std::array{q[0], q[1], q[2]} : std::array{q[0], q[2], q[1]});
            mesh.triangles.push_back(side == 1 ? std::array{q[0], q[2], q[3]} : std::array{q[0], q[3], q[2]});
          }
      }
  return mesh;
}
/// About the y axis: R of its middle line, r of its section; n and m quadrilaterals around.
[[nodiscard]] inline MeshData<double> torus_mesh(double R, double r, int n, int m) {
  MeshData<double> mesh;
  const auto id = [&](int i, int j) { return static_cast<std::uint32_t>((i % n) * m + j % m); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      mesh.vertices.push_back(
          {(R + r * std::cos(b)) * std::cos(a), r * std::sin(b), (R + r * std::cos(b)) * std::sin(a)});
      mesh.triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i + 1, j)});
    }
  return mesh;
}
[[nodiscard]] inline MeshData<double> two_spheres_mesh() {
  MeshData<double> mesh = ellipsoid_mesh(Vec3<double>(0.03, 0.03, 0.03), 8);
  append<double>(mesh, ellipsoid_mesh(Vec3<double>(0.02, 0.03, 0.02), 8), Vec3<double>(0.06, 0, 0));
  return mesh;
}

/// A body, fixed where y [m] is at most `fixed_below`.
struct ResponseBody {
  const char* name;
  MeshData<double> mesh;
  double fixed_below;
  double nu;
};
[[nodiscard]] inline std::vector<ResponseBody> response_bodies() {
  const auto block = [](int, int, int) { return true; };
  const auto corner = [](int i, int j, int) { return i < 4 || j < 4; };
  const auto bowl = [](int i, int j, int k) { return j == 0 || i == 0 || i == 7 || k == 0 || k == 7; };
  const auto hole = [](int i, int j, int) { return i < 2 || i > 4 || j < 3 || j > 5; };
  return {{"torus", torus_mesh(0.05, 0.02, 36, 18), -0.012, 0.5},
          {"L", cells_mesh({8, 8, 4}, 0.0125, corner), 1e-6, 0.45},
          {"plate 1:20, lying", cells_mesh({20, 1, 20}, 0.005, block), 1e-6, 0.45},
          {"plate 1:20, standing", cells_mesh({20, 20, 1}, 0.005, block), 1e-6, 0.3},
          {"two spheres", two_spheres_mesh(), -0.02, 0.5},
          {"box", cells_mesh({8, 8, 8}, 0.0125, block), 1e-6, 0.3},
          {"bowl", cells_mesh({8, 8, 8}, 0.0125, bowl), 1e-6, 0.45},
          {"block with a hole", cells_mesh({7, 9, 4}, 0.0125, hole), 1e-6, 0.45}};
}

/// Of 100 kPa, with about so many vertices of the boundary element mesh.
[[nodiscard]] inline ResponseField body_field(const ResponseBody& body, double vertices) {
  return ResponseField(body.mesh, [&](const Vec3<double>& p) { return p.y() <= body.fixed_below; },
                       {.E = 1e5, .nu = body.nu, .mesh = {.vertices = vertices}});
}
/// The field of 200 vertices, set up once for all tests of a program.
[[nodiscard]] inline const ResponseField& body_field(const ResponseBody& body) {
  static std::map<std::string, ResponseField> made;
  const auto at = made.find(body.name);
  return at != made.end() ? at->second : made.emplace(body.name, body_field(body, 200)).first->second;
}

}  // namespace palpate::test
