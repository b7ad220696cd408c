// SPDX-License-Identifier: MIT
#include <palpate/response/setup/make_element_mesh.hpp>

#include "support/check.hpp"
#include "support/response_bodies.hpp"
#include "support/response_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

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

TEST_CASE("slender round part: six edges around it, by vertices on top of the wanted number") {
  // A pin 10 mm thick and 100 mm long out of a ball of 60 mm, turned about y.
  const double R = 0.03, r = 0.005, pi = std::numbers::pi, neck = std::asin(r / R);
  const auto turned = [&](double length) {
    std::vector<std::array<double, 2>> profile;  // radius, height
    for (int i = 1; i <= 24; ++i) {
      const double a = pi + (neck - pi) * i / 24;
      profile.push_back({R * std::sin(a), R * std::cos(a)});
    }
    for (int i = 1; i <= 40 && length > 0; ++i) profile.push_back({r, R * std::cos(neck) + length * i / 40});
    const double top = profile.back()[1];
    for (int i = 1; i < 6 && length > 0; ++i)
      profile.push_back({r * std::cos(pi / 2 * i / 6), top + r * std::sin(pi / 2 * i / 6)});
    MeshData<double> mesh;
    const std::uint32_t around = 24, rings = static_cast<std::uint32_t>(profile.size());
    for (const auto& [radius, height] : profile)
      for (std::uint32_t k = 0; k < around; ++k)
        mesh.vertices.push_back(
            {radius * std::sin(2 * pi * k / around), height, radius * std::cos(2 * pi * k / around)});
    mesh.vertices.push_back({0, -R, 0});
    mesh.vertices.push_back({0, length > 0 ? top + r : R, 0});
    for (std::uint32_t k = 0; k < around; ++k) {
      const std::uint32_t next = (k + 1) % around, last = (rings - 1) * around;
      mesh.triangles.push_back({rings * around, next, k});
      for (std::uint32_t a = 0; a < last; a += around) {
        mesh.triangles.push_back({a + k, a + next, a + around + next});
        mesh.triangles.push_back({a + k, a + around + next, a + around + k});
      }
      mesh.triangles.push_back({last + k, last + next, rings * around + 1});
    }
    return mesh;
  };
  const ElementMesh with = element_mesh(turned(0.1), 200), without = element_mesh(turned(0), 200);
  const auto on_ball = [](const V& x) { return x.y() > 0.005 && x.y() < 0.02; };
  const double pin = mean_edge(with, [](const V& x) { return x.y() > 0.06 && x.y() < 0.11; }),
               ball = mean_edge(with, on_ball), alone = mean_edge(without, on_ball),
               around = 2 * pi * r / pin;
  MESSAGE(with.vertices.size(), " vertices, ", without.vertices.size(), " without the pin; ", around,
          " edges around it; on the ball ", 1e3 * ball, " and ", 1e3 * alone, " mm");
  // 5.9, seven where its width is not taken too large; 4.5 with edges as long as it is thick.
  CHECK(around > 5.5);
  CHECK(with.vertices.size() < 2 * 200);  // 329; as many again at most
  CHECK(ball < 1.25 * alone);             // 1.15
}

TEST_CASE("noise of the given mesh makes no creases and no more vertices than wanted") {
  MeshData<double> mesh = test::ellipsoid_mesh(V(0.03, 0.03, 0.03), 24);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-5e-4, 5e-4);
  for (auto& p : mesh.vertices) p += noise(random) * p.normalized() + V(0, 0.02, 0);
  const SmoothSurface surface(mesh);
  std::size_t creases = 0, within = 0;
  for (std::size_t e = 0; e < surface.edges().size(); ++e) creases += surface.is_crease(e);
  const ElementMesh m = element_mesh(mesh, 300);
  for (const auto& n : m.nodes) within += n.crease && !m.fixed_vertex[n.vertex];
  MESSAGE(creases, " creases given; ", m.vertices.size(), " vertices, ", within, " nodes at creases");
  REQUIRE(creases > 300);
  CHECK(m.vertices.size() < 1.15 * 300);  // 326, a tenth more is usual; 924 with the noise's creases
  CHECK(within == 0);
}

TEST_CASE("smooth surface: flat faces of a CAD body with rounded edges stay flat") {
  const V half(0.02, 0.01, 0.015);
  const double r = 0.002;
  const SmoothSurface body(test::rounded_box_mesh(half, r, 1));
  double off = 0, tilt = 0;
  for (double x = -1; x <= 1; x += 0.25) {
    for (double z = -1; z <= 1; z += 0.25) {
      const V at(x * (half.x() - r), half.y(), z * (half.z() - r));
      off = (std::max)(off, std::abs(body.project(at).y() - half.y()));
      tilt = (std::max)(tilt, std::hypot(body.normal_at(at).x(), body.normal_at(at).z()));
    }
  }
  // 2.7 mm and 0.27 where normals are weighted by angles alone.
  CHECK(off < 2e-5);   // measured: 1e-5
  CHECK(tilt < 2e-3);  // measured: 1.2e-3
}
