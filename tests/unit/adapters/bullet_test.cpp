// SPDX-License-Identifier: MIT
// First the header, so that it is seen to compile alone.
#include <palpate/adapters/bullet.hpp>

#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>

#include "contract/candidate_tree.hpp"

#include <cstdlib>
#include <memory>

using namespace palpate;

namespace {

template <bool quantized>
struct Host {
  template <Real S>
  explicit Host(const MeshData<S>& mesh) {
    for (const auto& t : mesh.triangles)
      for (const std::uint32_t v : t) indices.push_back(static_cast<int>(v));
    write(mesh.vertices);
    arrays = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles.size()), indices.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.vertices.size()), coordinates.data(), static_cast<int>(3 * sizeof(btScalar)));
    shape = std::make_unique<btBvhTriangleMeshShape>(arrays.get(), quantized, -corner, corner);
    shape->getOptimizedBvh()->setTraversalMode(btQuantizedBvh::TRAVERSAL_STACKLESS_CACHE_FRIENDLY);
    shape->setMargin(btScalar(0.01));  // Bullet's, for its own contacts: it must not matter
  }
  BulletTree tree() const { return BulletTree(*shape); }
  /// By turns the ways that BulletTree's docstring allows.
  template <Real S>
  void move(const std::vector<Vec3<S>>& positions) {
    write(positions);
    if (!quantized)
      shape->buildOptimizedBvh();
    else if (moves++ % 2 == 0)
      shape->refitTree(-corner, corner);
    else
      shape->partialRefitTree(-corner, corner);
  }
  template <Real S>
  void write(const std::vector<Vec3<S>>& positions) {
    coordinates.resize(3 * positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        coordinates[3 * i + k] = static_cast<btScalar>(positions[i][static_cast<int>(k)]);
  }

  const btVector3 corner{btScalar(0.2), btScalar(0.2),
                         btScalar(0.2)};  // of a box that the deformation stays in
  std::vector<int> indices;
  std::vector<btScalar> coordinates;
  std::unique_ptr<btTriangleIndexVertexArray> arrays;
  std::unique_ptr<btBvhTriangleMeshShape> shape;
  int moves = 0;
};

int bullet_allocations = 0;

}  // namespace

TEST_CASE("Bullet: no candidate missed, same forces") {
  test::CandidateTreeSuite<Host<true>, double>().run();
}

TEST_CASE("Bullet, tree not quantized, scene in float: no candidate missed, same forces") {
  test::CandidateTreeSuite<Host<false>, float>().run();
}

// The suite counts what the program and operator new allocate; Bullet allocates inside of its own library.
TEST_CASE("Bullet: questions and refits take no heap inside of Bullet") {
  btAlignedAllocSetCustom(
      [](std::size_t size) {
        ++bullet_allocations;
        return std::malloc(size);
      },
      [](void* block) { std::free(block); });
  {
    const MeshData<double> mesh = test::blob<double>(2000);
    Host<true> quantized(mesh);
    const Host<false> plain(mesh);
    CHECK(bullet_allocations > 0);
    const int before = bullet_allocations;
    quantized.move(mesh.vertices);
    quantized.move(mesh.vertices);
    for (const auto& v : mesh.vertices) {
      CHECK(quantized.tree().touches(v, 0.01));
      CHECK(plain.tree().touches(v, 0.01));
    }
    CHECK(bullet_allocations == before);
  }
  btAlignedAllocSetCustom(nullptr, nullptr);
}

TEST_CASE("Bullet: a shape without its tree is refused") {
  Host<true> host(test::blob<double>(200));
  btBvhTriangleMeshShape shape(host.arrays.get(), true, false);
  CHECK_THROWS_WITH_AS(BulletTree{shape}, "BulletTree: the shape must have its tree: buildOptimizedBvh()",
                       SetupError);
}
