// SPDX-License-Identifier: MIT

/// @file Random and mutated vertex buffers through inspect(): it never crashes, and what it passes is a
/// closed, oriented mesh with volume, by an independent check. 200,000 cases, up to a million within 15 s;
/// PALPATE_FUZZ_CASES sets the number, without a limit of time: PALPATE_FUZZ_CASES=1000000 in a build with
/// sanitizers.

#include <palpate/geometry/mesh_surface.hpp>

#include <support/check.hpp>
#include <support/meshes.hpp>

#include <doctest/doctest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace palpate;

namespace {

using Mesh = MeshData<float>;

Mesh random_buffer(std::mt19937_64& random) {
  Mesh mesh;
  const std::size_t vertices = random() % 12, triangles = random() % 20;
  for (std::size_t v = 0; v < vertices; ++v) {
    Vec3<float> p;
    for (int k = 0; k < 3; ++k) {
      const auto bits = static_cast<std::uint32_t>(random());
      if (random() % 8 == 0)
        std::memcpy(&p[k], &bits, sizeof bits);  // any float at all
      else
        p[k] = static_cast<float>(bits % 5) - 2.0f;
    }
    mesh.vertices.push_back(p);
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto corner = [&] {
      return random() % 64 == 0 ? static_cast<std::uint32_t>(random())
                                : static_cast<std::uint32_t>(random() % (vertices + 1));
    };
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

void mutate(Mesh& mesh, std::mt19937_64& random) {
  auto& t = mesh.triangles[random() % mesh.triangles.size()];
  auto& v = mesh.vertices[random() % mesh.vertices.size()];
  switch (random() % 10) {
    case 0:
      std::swap(t[0], t[1]);
      break;
    case 1:
      t[random() % 3] = static_cast<std::uint32_t>(random() % mesh.vertices.size());
      break;
    case 2:
      t = mesh.triangles.back();
      break;
    case 3:
      mesh.triangles.pop_back();
      break;
    case 4:
      mesh.triangles.push_back(t);
      break;
    case 5:
      v = mesh.vertices[random() % mesh.vertices.size()];
      break;
    case 6:
      v[static_cast<int>(random() % 3)] = std::numeric_limits<float>::quiet_NaN();
      break;
    case 7:
      v *= random() % 2 == 0 ? -1.0f : 1e3f;
      break;
    case 8:
      mesh.vertices.push_back(2.0f * v);
      break;
    default:  // the last vertex becomes one with another
      for (auto& u : mesh.triangles)
        for (auto& index : u)
          if (index + 1 == mesh.vertices.size())
            index = static_cast<std::uint32_t>(&v - mesh.vertices.data());
      if (mesh.vertices.size() > 1) mesh.vertices.pop_back();
  }
  if (mesh.triangles.empty()) mesh.triangles.push_back({0, 1, 2});
}

}  // namespace

TEST_CASE("stress: random and mutated vertex buffers never get through as valid") {
  constexpr std::uint64_t seed = 20240704;
  MESSAGE("seed ", seed);
  std::mt19937_64 random(seed);
  const std::vector<Mesh> good{Box<float>({}).mesh(8), Sphere<float>({}).mesh(26),
                               test::torus<float>(0.03f, 0.01f, 4, 4)};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(15);
  long cases = 0, passed = 0, unsound = 0, not_finite = 0;
  std::array<long, mesh_defect_count> named{};
  const char* asked = std::getenv("PALPATE_FUZZ_CASES");
  const long least = asked ? std::atol(asked) : 200000, most = asked ? least : 1000000;
  while (cases < least || (cases < most && std::chrono::steady_clock::now() < end)) {
    ++cases;
    Mesh mesh = cases % 2 == 0 ? random_buffer(random) : good[random() % good.size()];
    if (cases % 2 != 0)
      for (std::uint64_t n = 1 + random() % 3; n > 0; --n) mutate(mesh, random);
    const MeshReport report = inspect(mesh);
    for (std::size_t d = 0; d < mesh_defect_count; ++d) {
      named[d] += report.defects[d].count > 0;
      (void)describe(report, static_cast<MeshDefect>(d));
    }
    if (!report.valid()) continue;
    ++passed;
    unsound += !test::is_sound(mesh);
    // What passes can be used: every query gives a finite answer.
    if (passed % 16 != 0) continue;
    const MeshSurface<float> body{TriangleMesh<float>(mesh)};
    const Vec3<float> x = 0.02f * mesh.vertices[0];
    const auto in = body.penetration(x);
    not_finite += !is_finite(in.depth) || !is_finite(in.gradient) || !is_finite(body.closest(x).normal);
  }
  std::printf("%ld buffers, %ld valid; defects named:", cases, passed);
  for (const long n : named) std::printf(" %ld", n);
  std::printf("\n");
  CHECK(unsound == 0);
  CHECK(not_finite == 0);
  CHECK(passed > 0.005 * static_cast<double>(cases));
  for (std::size_t d = 0; d < mesh_defect_count; ++d)
    if (d != static_cast<std::size_t>(MeshDefect::too_large)) CHECK(named[d] > 0);
}
