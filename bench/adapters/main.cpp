// SPDX-License-Identifier: MIT

/// @file Candidates from palpate's own search, from FCL's tree and from Bullet's: `bench_adapters OUTPUT.csv
/// [--quick]`. A ball of 1,000 points and 20 mm radius glides 2 mm deep over a dented body of 39,000
/// triangles, as in bench/mesh; depth from the mesh itself and from its samples. "fcl_collide" asks
/// fcl::collide() instead of walking FCL's tree. Columns: points that are candidates, the search alone, the
/// whole tick, heap allocations per tick; printed with them: the mean force, which all must agree in. Ratios
/// between rows of one run are what to read.

#include <palpate/adapters/bullet.hpp>
#include <palpate/adapters/fcl.hpp>

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <fcl/narrowphase/collision.h>

#include <support/no_heap.hpp>

#include "mesh_scene.hpp"
#include "scenes.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace bench;

/// FCL's own answer to the question.
struct Collide {
  const fcl::BVHModel<fcl::OBBRSS<S>>* model;
  bool touches(const V& c, S r) const noexcept {
    const fcl::Sphere<S> query(r);
    fcl::Transform3<S> position = fcl::Transform3<S>::Identity();
    position.translation() = c;
    fcl::CollisionResult<S> result;
    return fcl::collide<S>(&query, position, model, fcl::Transform3<S>::Identity(), {}, result) > 0;
  }
};

/// Returns the mean force.
template <class Object>
double row(const Output& out, const char* depth, const char* search, const Object& object,
           const std::vector<Pose<S>>& poses) {
  auto solver = ball_solver(object);
  const ToolPoints<S>& tool = solver.tool();
  std::vector<double> searches, ticks;
  searches.reserve(poses.size());
  ticks.reserve(poses.size());
  double candidates = 0, force = 0;
  std::size_t allocations = 0;
  const auto count = static_cast<double>(poses.size());
  for (const Pose<S>& X : poses) {
    auto start = Clock::now();
    for_each_candidate_leaf(
        tool, X, solver.object(),
        [&](std::uint32_t, std::uint32_t points, const PointBatch<S>&) noexcept { candidates += points; });
    searches.push_back(since(start));
    const test::HeapCount heap;
    start = Clock::now();
    force += solver.tick(X).wrench.force.norm();
    ticks.push_back(since(start));
    allocations += heap.allocations();
  }
  char text[160];
  std::snprintf(text, sizeof text, "%s,%s,%.1f,%.2f,%.2f,%.1f", depth, search, candidates / count,
                quantile(searches, 0.5), quantile(ticks, 0.5), static_cast<double>(allocations) / count);
  out.row(text, "force_N", force / count);
  return force / count;
}

}  // namespace

int main(int argc, char** argv) {
  const Output out(argc, argv, "depth,search,candidates,search_us_p50,tick_us_p50,allocations");
  const MeshData<S> data = body_mesh(40000);
  const MeshSurface<S> body{TriangleMesh<S>(data)};
  const SampledSurface<MeshSurface<S>> samples(body, {.spacing = 2e-3});
  const std::vector<Pose<S>> poses = glide_path(body, out.quick ? 200 : 2000);

  std::vector<fcl::Triangle> triangles;
  std::vector<int> indices;
  std::vector<btScalar> coordinates;
  for (const auto& t : data.triangles) {
    triangles.emplace_back(t[0], t[1], t[2]);
    for (const std::uint32_t v : t) indices.push_back(static_cast<int>(v));
  }
  for (const V& v : data.vertices)
    for (int k = 0; k < 3; ++k) coordinates.push_back(static_cast<btScalar>(v[k]));
  const auto build = [&](auto& model) {
    model.beginModel();
    model.addSubModel(data.vertices, triangles);
    model.endModel();
  };
  fcl::BVHModel<fcl::OBBRSS<S>> oriented;
  fcl::BVHModel<fcl::AABB<S>> parallel;
  build(oriented);
  build(parallel);
  btTriangleIndexVertexArray arrays(static_cast<int>(triangles.size()), indices.data(), 3 * sizeof(int),
                                    static_cast<int>(data.vertices.size()), coordinates.data(),
                                    3 * sizeof(btScalar));
  btBvhTriangleMeshShape shape(&arrays, true);

  const auto rows = [&](const char* depth, const auto& object, S margin) {
    const double own = row(out, depth, "palpate", object, poses);
    const auto other = [&](const char* search, const auto& tree) {
      const double force = row(out, depth, search, CandidatesFrom(object, tree, margin), poses);
      out.require_below(std::string("force with ") + search, std::abs(force - own) / own,
                        1e-9);  // sums in another order
    };
    other("fcl_obbrss", FclTree(oriented));
    other("fcl_aabb", FclTree(parallel));
    other("fcl_collide", Collide{&oriented});
    other("bullet", BulletTree(shape));
  };
  rows("mesh", body, 0);
  rows("samples", samples, 1.62 * samples.spacing());
  return out.failures == 0 ? 0 : 1;
}
