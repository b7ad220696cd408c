// SPDX-License-Identifier: MIT
#include <palpate/response/setup/make_element_mesh.hpp>

#include "support/check.hpp"
#include "support/response_bodies.hpp"
#include "support/response_meshes.hpp"

namespace {
using namespace palpate;
using V = Vec3<double>;

// Held where y <= 0.
ElementMesh element_mesh(const MeshData<double>& mesh, double vertices) {
  std::vector<std::uint8_t> fixed;
  for (const auto& t : mesh.triangles)
    fixed.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]).y() < 1e-9);
  return make_element_mesh(SmoothSurface(mesh), fixed, {.vertices = vertices});
}
// Mean edge length of the triangles whose centre is chosen.
template <class Chosen>
double mean_edge(const ElementMesh& m, const Chosen& chosen) {
  double sum = 0;
  int count = 0;
  for (const auto& t : m.triangles) {
    const V &a = m.vertices[t[0]], &b = m.vertices[t[1]], &c = m.vertices[t[2]];
    if (!chosen(V((a + b + c) / 3))) continue;
    sum += (a - b).norm() + (b - c).norm() + (c - a).norm();
    count += 3;
  }
  REQUIRE(count > 0);
  return sum / count;
}
}  // namespace

TEST_CASE("unresolved area: none of a sphere, a plate's two faces until an edge is the thickness") {
  MeshData<double> sphere = test::ellipsoid_mesh(V(0.03, 0.03, 0.03), 8);
  for (auto& p : sphere.vertices) p.y() += 0.02;
  CHECK(unresolved_area(element_mesh(sphere, 100)) == 0.0);
  // Plate 100 x 100 x 10 standing on a narrow face: its two faces are 20 of 23 parts of the free surface.
  const MeshData<double> plate = test::cells_mesh({10, 10, 1}, 0.01, [](int, int, int) { return true; });
  const ElementMesh coarse = element_mesh(plate, 100), fine = element_mesh(plate, 1200);
  CHECK_ABSOLUTE(unresolved_area(coarse), 20.0 / 23, 0.02);  // a triangle more or less at the faces' borders
  CHECK(unresolved_area(fine) == 0.0);
}

TEST_CASE("edges: short on a fin, along creases and at the rim; as many vertices as wanted") {
  // A block of 80 mm with a fin of 10 mm on its top.
  const MeshData<double> body =
      test::cells_mesh({8, 12, 8}, 0.01, [](int i, int j, int) { return j < 8 || i == 4; });
  const ElementMesh m = element_mesh(body, 300);
  const double fin = mean_edge(m, [](const V& x) { return x.y() > 0.09 && x.y() < 0.11; }),
               face = mean_edge(
                   m,
                   [](const V& x) { return std::abs(x.z()) < 1e-9 && (x - V(0.04, 0.04, 0)).norm() < 0.02; }),
               edge =
                   mean_edge(m,
                             [](const V& x) {
                               return std::abs(x.z()) < 1e-9 && x.x() < 0.005 && x.y() > 0.03 && x.y() < 0.07;
                             }),
               rim = mean_edge(m, [](const V& x) { return x.y() > 0 && x.y() < 0.005; });
  MESSAGE(m.vertices.size(), " vertices; mean edge [mm]: fin ", 1e3 * fin, ", face ", 1e3 * face, ", crease ",
          1e3 * edge, ", rim ", 1e3 * rim);
  CHECK(m.vertices.size() < 1.15 * 300);  // a tenth more is usual: remesh.hpp
  CHECK(m.vertices.size() > 0.85 * 300);
  CHECK(fin < 0.75 * face);
  CHECK(edge < face);
  CHECK(rim < 0.85 * face);
}
