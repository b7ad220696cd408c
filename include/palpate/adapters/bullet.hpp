// SPDX-License-Identifier: MIT
#pragma once

/// @file  Candidates from Bullet: the triangle mesh shape that a host has of the object.
/// Optional: not in palpate.hpp, and the host finds and links Bullet itself. Tested with Bullet 3.24.

#include <palpate/adapters/detail/near_triangle.hpp>
#include <palpate/core/error.hpp>
#include <palpate/detection/candidates_from.hpp>

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>

#include <algorithm>
#include <limits>

namespace palpate {

/// A host's btBvhTriangleMeshShape of the object as a CandidateTree, quantized or not. The shape is in object
/// coordinates [m], its local scaling included.
///
/// Real time: one btBvhTriangleMeshShape::processAllTriangles() for each question. Bullet 3.24 takes no heap,
/// lock, exception or I/O there, and visits every box at most once; but it cannot be stopped, so a large ball
/// near the surface costs every triangle in its box: a search takes about ten times palpate's own on a mesh
/// (docs/meshes.md). Older versions of Bullet keep a statistic in a global variable there: not from two
/// threads at once.
///
/// Deformed meshes: write the vertices of the btStridingMeshInterface, then refitTree(), between ticks; it
/// takes no heap. Only quantized trees are refitted: on others refitTree() of Bullet 3.24 does nothing,
/// rebuild them. Give the box that the deformation stays in. After partialRefitTree() the boxes above the
/// part are old: right only with setTraversalMode(btQuantizedBvh::TRAVERSAL_STACKLESS_CACHE_FRIENDLY), which
/// is not the default.
///
/// Precision: Bullet's btScalar is float unless BT_USE_DOUBLE_PRECISION is defined, for Bullet and the host
/// alike, and so are its vertices; questions are widened by 16 ulp of btScalar at the largest coordinate, so
/// that the rounding of the vertices loses no contact. The collision margin of the shape is not added to
/// anything.
class BulletTree {
 public:
  /// Keeps a reference. @throws SetupError where the shape has no tree.
  explicit BulletTree(btBvhTriangleMeshShape& shape) : shape_(&shape) {
    if (!shape.getOptimizedBvh()) fail("BulletTree", "the shape must have its tree: buildOptimizedBvh()");
  }

  template <Real S>
  [[nodiscard]] bool touches(const Vec3<S>& centre, S radius) const noexcept {
    constexpr S epsilon = (std::max)(std::numeric_limits<S>::epsilon(),
                                     static_cast<S>(std::numeric_limits<btScalar>::epsilon()));
    const btVector3 largest = shape_->getLocalAabbMin().absolute() + shape_->getLocalAabbMax().absolute();
    const S size = static_cast<S>(largest[largest.maxAxis()]) + centre.cwiseAbs().maxCoeff() + radius;
    const S r = radius + S(16) * epsilon * size;
    const auto corner = [&](S side) {
      return btVector3(static_cast<btScalar>(centre[0] + side), static_cast<btScalar>(centre[1] + side),
                       static_cast<btScalar>(centre[2] + side));
    };
    Near<S> near(centre, r);
    shape_->processAllTriangles(&near, corner(-r), corner(r));
    return near.found;
  }

 private:
  template <Real S>
  struct Near final : btTriangleCallback {
    Near(const Vec3<S>& at, S radius) : c(at), r(radius) {}
    void processTriangle(btVector3* triangle, int, int) override {
      const auto vertex = [triangle](int k) {
        return Vec3<S>(static_cast<S>(triangle[k].x()), static_cast<S>(triangle[k].y()),
                       static_cast<S>(triangle[k].z()));
      };
      if (!found) found = detail::is_near<S>(c, r, vertex(0), vertex(1), vertex(2));
    }
    Vec3<S> c;
    S r;
    bool found = false;
  };

  const btBvhTriangleMeshShape* shape_;
};

}  // namespace palpate
