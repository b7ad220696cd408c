// SPDX-License-Identifier: MIT

/// @file Triangle meshes as elastic objects, from 1,000 to 1,000,000 triangles: `bench_mesh OUTPUT.csv`. A
/// ball of 1,000 points and 20 mm radius glides 2 mm deep over a dented body of about 20 cm, 50 um a tick.
/// Columns: set-up, refit of the tree after 1 in 100 vertices moved and after all did, one closest point from
/// within 5 mm of the surface, the force tick on the mesh itself and on its samples, how many points touch,
/// the force of both, and the force tick on the mesh bulged out by 0.5 mm (DeformedSurface).

#include "mesh_scene.hpp"

#include <cstdio>
#include <random>
#include <vector>

namespace {

using namespace bench;

struct Ticks {
  double p50, p99, touching, force;
};

template <class Object>
Ticks glide(const Object& object, const MeshSurface<S>& body, int ticks) {
  auto solver = ball_solver(object);
  std::vector<double> times;
  double touching = 0, force = 0;
  for (const Pose<S>& X : glide_path(body, ticks)) {
    const auto start = Clock::now();
    const auto result = solver.tick(X);
    times.push_back(since(start));
    force += result.wrench.force.norm() / ticks;
    for (const auto& contact : solver.contacts()) touching += static_cast<double>(contact.points) / ticks;
  }
  return {quantile(times, 0.5), quantile(times, 0.99), touching, force};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: bench_mesh OUTPUT.csv\n");
    return 2;
  }
  std::FILE* out = std::fopen(argv[1], "w");
  if (!out) {
    std::perror(argv[1]);
    return 1;
  }
  const char* head =
      "triangles,build_ms,refit_part_us,refit_all_us,query_ns,tick_us_p50,tick_us_p99,samples_ms,sampled_"
      "tick_us_p50,"
      "sampled_tick_us_p99,touching,force_N,sampled_force_N,deformed_tick_us_p50,deformed_tick_us_p99,"
      "deformed_force_N";
  std::fprintf(out, "%s\n", head);
  std::printf("%s\n", head);
  for (const std::size_t size : {1000u, 4000u, 10000u, 40000u, 100000u, 400000u, 1000000u}) {
    const MeshData<S> mesh = body_mesh(size);
    const TriangleMesh<S> checked(mesh);
    auto start = Clock::now();
    const MeshSurface<S> body(checked);
    const double build = since(start);

    // One patch of vertices, as under a contact; then all.
    TriangleBvh<S> tree(mesh);
    std::vector<std::uint32_t> which;
    std::vector<V> positions, all = mesh.vertices;
    std::vector<std::pair<S, std::uint32_t>> nearest;
    for (std::uint32_t v = 0; v < all.size(); ++v) nearest.push_back({(all[v] - all[0]).squaredNorm(), v});
    std::sort(nearest.begin(), nearest.end());
    for (std::size_t i = 0; i < all.size() / 100; ++i) which.push_back(nearest[i].second);
    for (const std::uint32_t v : which) positions.push_back(all[v] * 0.99);
    for (V& v : all) v *= 0.99;
    std::vector<double> part, whole;
    for (int i = 0; i < 20; ++i) {
      start = Clock::now();
      tree.move(which, positions);
      part.push_back(since(start));
      start = Clock::now();
      tree.move_all(all);
      whole.push_back(since(start));
    }

    std::mt19937_64 random(1);
    std::uniform_real_distribution<S> unit(-1, 1);
    std::vector<V> queries;
    for (int i = 0; i < 20000; ++i) {
      const auto& t = mesh.triangles[random() % mesh.triangles.size()];
      queries.push_back(mesh.vertices[t[0]] + 5e-3 * V(unit(random), unit(random), unit(random)));
    }
    start = Clock::now();
    double sum = 0;
    for (const V& x : queries) sum += body.closest(x).distance;
    const double query = since(start) * 1000 / static_cast<double>(queries.size());

    const int ticks = 10000;
    const Ticks own = glide(body, body, ticks);
    start = Clock::now();
    const SampledSurface<MeshSurface<S>> samples(body, {.spacing = 2e-3});
    const double sampling = since(start);
    const Ticks sampled = glide(samples, body, ticks);
    DeformedSurface<MeshSurface<S>> bulged(body, checked);
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = mesh.vertices[v] * 1.005;
    bulged.update(all);
    const Ticks deformed = glide(bulged, body, ticks);
    for (std::FILE* file : {out, stdout}) {
      std::fprintf(file, "%zu,%.1f,%.2f,%.1f,%.0f,%.2f,%.2f,%.0f,%.2f,%.2f,%.1f,%.6g,%.6g,%.2f,%.2f,%.6g\n",
                   mesh.triangles.size(), build / 1000, quantile(part, 0.5), quantile(whole, 0.5), query,
                   own.p50, own.p99, sampling / 1000, sampled.p50, sampled.p99, own.touching, own.force,
                   sampled.force, deformed.p50, deformed.p99, deformed.force);
    }
    if (!std::isfinite(sum)) return 1;  // and so the queries are not optimised away
  }
  return std::fclose(out) == 0 ? 0 : 1;
}
